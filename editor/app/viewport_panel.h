// The live picture and its interaction: navigate, pick, place, move.
#pragma once

#include "app/app.h"

namespace fwapp {

inline glm::vec3 asVec(fwedit::Vec3 v) { return {v[0], v[1], v[2]}; }

// A picture of the live scene on the screen.
struct Picture {
    fwui::Rect rect;
    const FwView& view;
    bool at(glm::vec3 position, ImVec2& pixel) const;  // Projects a point. Returns false behind the
                                                       // camera.
    glm::vec2 share(ImVec2 pixel) const;               // [0, 1] from the top left
    fwview::Ray ray(ImVec2 pixel) const;
};

// Three axes in view orientation; a click looks along one. Returns true if the mouse is over it.
bool showNavigationBall(App& app, ImDrawList* list, const Picture& picture);
void orbit(App& app, ImVec2 by);
void pan(App& app, const Picture& picture, ImVec2 by);
void zoom(App& app, float notches);

void showViewport(App& app, const fwui::Rect& rect);
// The live picture alone, at full size and resolution.
void showPicture(App& app, const fwui::Rect& rect);
}  // namespace fwapp
