// What mouse and keyboard did, in order. A frame takes at most one change of each key and button,
// and no motion across a click, so that nothing short is lost however slow frames are: Dear
// ImGui 1.86 looks at states once a frame.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <vector>

struct GLFWwindow;

namespace fwui {

struct InputEvent {
    enum class Type : uint32_t { kMove, kButton, kKey, kText, kWheel, kFocus } type{};
    int code = 0;        // button, or key as GLFW numbers it
    bool down = false;   // of a button, a key; of kFocus: there is focus
    float x = 0, y = 0;  // pixels; notches of the wheel
    uint32_t character = 0;
};

class InputQueue {
 public:
    // Takes the window's callbacks over; the queue must outlive them. `scale`: pixels of the
    // framebuffer per unit of GLFW's coordinates.
    void listen(GLFWwindow* window);
    void push(const InputEvent& event) { events_.push_back(event); }
    // Hands this frame's share to ImGui. True: there was some.
    bool deliver();
    [[nodiscard]] bool empty() const { return events_.empty() && dropped.empty(); }

    std::vector<std::filesystem::path> dropped;  // files, taken and cleared by the owner
    double pointerX = 0, pointerY = 0;           // GLFW's, as of the last event
    bool exposed = false;                        // the window wants to be drawn again

 private:
    std::deque<InputEvent> events_;
};

// ImGui's map from its keys to GLFW's, and the clipboard. Once, after its context is made; `window`
// may be null.
void mapKeys(GLFWwindow* window);

}  // namespace fwui
