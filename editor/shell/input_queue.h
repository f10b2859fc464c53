// Mouse and keyboard events in order. A frame takes at most one change of each key and button, and
// no motion across a click, so short events survive slow frames. Dear ImGui 1.86 polls states once
// per frame.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <vector>

struct GLFWwindow;

namespace fwui {

struct InputEvent {
    enum class Type : uint32_t { kMove, kButton, kKey, kText, kWheel, kFocus } type{};
    int code = 0;        // button, or GLFW key code
    bool down = false;   // for buttons and keys; for kFocus: has focus
    float x = 0, y = 0;  // pixels; wheel notches
    uint32_t character = 0;
};

class InputQueue {
 public:
    // Installs the window's callbacks; the queue must outlive them. `scale`: framebuffer pixels per
    // GLFW unit.
    void listen(GLFWwindow* window);
    void push(const InputEvent& event) { events_.push_back(event); }
    // Passes this frame's events to ImGui. Returns true if there were any.
    bool deliver();
    [[nodiscard]] bool empty() const { return events_.empty() && dropped.empty(); }

    std::vector<std::filesystem::path> dropped;  // files; the owner takes and clears them
    double pointerX = 0, pointerY = 0;           // GLFW units, as of the last event
    bool exposed = false;                        // the window needs a redraw

 private:
    std::deque<InputEvent> events_;
};

// Sets ImGui's key map for GLFW and the clipboard. Call it once after creating the context;
// `window` may be null.
void mapKeys(GLFWwindow* window);

}  // namespace fwui
