// The live picture and what a hand does in it: look around, pick, place, move.
#pragma once

#include "app/app.h"

namespace fwapp {

inline glm::vec3 asVec(fwedit::Vec3 v) { return {v[0], v[1], v[2]}; }

// A picture of the live scene on the screen.
struct Picture {
    fwui::Rect rect;
    const FwView& view;
    bool at(glm::vec3 position, ImVec2& pixel) const;  // false: behind the eye
    glm::vec2 share(ImVec2 pixel) const;               // [0, 1] from the top left
    fwview::Ray ray(ImVec2 pixel) const;
};

// Three axes as they lie to the eye; a click on one looks along it. True: the mouse is over it.
bool navigationBall(App& app, ImDrawList* list, const Picture& picture);
void orbit(App& app, ImVec2 by);
void pan(App& app, const Picture& picture, ImVec2 by);
void zoom(App& app, float notches);

void showViewport(App& app, const fwui::Rect& rect);
// The picture of the live scene alone, whole and sharp.
void showPicture(App& app, const fwui::Rect& rect);
}  // namespace fwapp
