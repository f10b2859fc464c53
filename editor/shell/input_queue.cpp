// See input_queue.h.
#include "shell/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <bitset>

#include "common/window.h"

namespace fwui {
namespace {

using Type = InputEvent::Type;

InputQueue& queueOf(GLFWwindow* window) {
    auto* owner = static_cast<sample::Window*>(glfwGetWindowUserPointer(window));
    return *static_cast<InputQueue*>(owner->guest);
}

// Framebuffer pixels per GLFW unit.
float pixelsPerUnit(GLFWwindow* window) {
    int width = 0, height = 0, pixels = 0;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &pixels, &height);
    return width > 0 ? float(pixels) / float(width) : 1.0f;
}

bool isModifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

InputEvent pointerEvent(GLFWwindow* window, Type type, double x, double y) {
    const float scale = pixelsPerUnit(window);
    InputEvent event;
    event.type = type;
    event.x = float(x) * scale;
    event.y = float(y) * scale;
    return event;
}

}  // namespace

void InputQueue::listen(GLFWwindow* window) {
    static_cast<sample::Window*>(glfwGetWindowUserPointer(window))->guest = this;
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_FALSE);
    glfwSetInputMode(window, GLFW_STICKY_MOUSE_BUTTONS, GLFW_FALSE);
    glfwGetCursorPos(window, &pointerX, &pointerY);
    glfwSetCursorPosCallback(window, [](GLFWwindow* at, double x, double y) {
        queueOf(at).pointerX = x;
        queueOf(at).pointerY = y;
        queueOf(at).push(pointerEvent(at, Type::kMove, x, y));
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* at, int button, int action, int) {
        if (button < 0 || button > 2) return;
        // Use the position at the click, not the position when a slow frame processes it.
        InputEvent event =
            pointerEvent(at, Type::kButton, queueOf(at).pointerX, queueOf(at).pointerY);
        event.code = button;
        event.down = action == GLFW_PRESS;
        queueOf(at).push(event);
    });
    glfwSetScrollCallback(window, [](GLFWwindow* at, double x, double y) {
        InputEvent event;
        event.type = Type::kWheel;
        event.x = float(x);
        event.y = float(y);
        queueOf(at).push(event);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* at, int key, int, int action, int) {
        if (action == GLFW_REPEAT || key < 0 || key >= 512) return;
        InputEvent event;
        event.type = Type::kKey;
        event.code = key;
        event.down = action == GLFW_PRESS;
        queueOf(at).push(event);
    });
    glfwSetCharCallback(window, [](GLFWwindow* at, unsigned character) {
        InputEvent event;
        event.type = Type::kText;
        event.character = character;
        queueOf(at).push(event);
    });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* at, int focused) {
        InputEvent event;
        event.type = Type::kFocus;
        event.down = focused != 0;
        queueOf(at).push(event);
    });
    glfwSetDropCallback(window, [](GLFWwindow* at, int count, const char** paths) {
        for (int i = 0; i < count; ++i) queueOf(at).dropped.emplace_back(paths[i]);
    });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* at) { queueOf(at).exposed = true; });
}

bool InputQueue::deliver() {
    ImGuiIO& io = ImGui::GetIO();
    std::bitset<512> keys;
    std::bitset<8> buttons;
    bool wheel = false, any = false, pressed = false;
    while (!events_.empty()) {
        const InputEvent& event = events_.front();
        const auto code = size_t(event.code);
        // Clicks and wheel events refer to the current mouse position, so a move ends the batch.
        if (event.type == Type::kMove && (buttons.any() || wheel)) break;
        if (event.type == Type::kButton && (buttons.test(code) || wheel)) break;
        if (event.type == Type::kKey && keys.test(code)) break;
        // Modifiers qualify the keys and clicks pressed with them, even if they are released
        // earlier.
        if (event.type == Type::kKey && isModifier(event.code) && (pressed || wheel)) break;
        if (event.type == Type::kWheel && buttons.any()) break;
        any = true;
        switch (event.type) {
            case Type::kMove:
                io.MousePos = {event.x, event.y};
                break;
            case Type::kButton:
                io.MousePos = {event.x, event.y};
                io.MouseDown[event.code] = event.down;
                buttons.set(code);
                pressed = true;
                break;
            case Type::kKey:
                io.KeysDown[event.code] = event.down;
                keys.set(code);
                pressed = pressed || !isModifier(event.code);
                break;
            case Type::kText:
                io.AddInputCharacter(event.character);
                break;
            case Type::kWheel:
                io.MouseWheelH += event.x;
                io.MouseWheel += event.y;
                wheel = true;
                break;
            case Type::kFocus:
                if (!event.down) std::fill_n(io.KeysDown, IM_ARRAYSIZE(io.KeysDown), false);
                break;
        }
        events_.pop_front();
    }
    auto held = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
    io.KeyCtrl = held(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = held(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = held(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    io.KeySuper = held(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
    return any;
}

void mapKeys(GLFWwindow* window) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyMap[ImGuiKey_Tab] = GLFW_KEY_TAB;
    io.KeyMap[ImGuiKey_LeftArrow] = GLFW_KEY_LEFT;
    io.KeyMap[ImGuiKey_RightArrow] = GLFW_KEY_RIGHT;
    io.KeyMap[ImGuiKey_UpArrow] = GLFW_KEY_UP;
    io.KeyMap[ImGuiKey_DownArrow] = GLFW_KEY_DOWN;
    io.KeyMap[ImGuiKey_PageUp] = GLFW_KEY_PAGE_UP;
    io.KeyMap[ImGuiKey_PageDown] = GLFW_KEY_PAGE_DOWN;
    io.KeyMap[ImGuiKey_Home] = GLFW_KEY_HOME;
    io.KeyMap[ImGuiKey_End] = GLFW_KEY_END;
    io.KeyMap[ImGuiKey_Insert] = GLFW_KEY_INSERT;
    io.KeyMap[ImGuiKey_Delete] = GLFW_KEY_DELETE;
    io.KeyMap[ImGuiKey_Backspace] = GLFW_KEY_BACKSPACE;
    io.KeyMap[ImGuiKey_Space] = GLFW_KEY_SPACE;
    io.KeyMap[ImGuiKey_Enter] = GLFW_KEY_ENTER;
    io.KeyMap[ImGuiKey_KeyPadEnter] = GLFW_KEY_KP_ENTER;
    io.KeyMap[ImGuiKey_Escape] = GLFW_KEY_ESCAPE;
    io.KeyMap[ImGuiKey_A] = GLFW_KEY_A;
    io.KeyMap[ImGuiKey_C] = GLFW_KEY_C;
    io.KeyMap[ImGuiKey_V] = GLFW_KEY_V;
    io.KeyMap[ImGuiKey_X] = GLFW_KEY_X;
    io.KeyMap[ImGuiKey_Y] = GLFW_KEY_Y;
    io.KeyMap[ImGuiKey_Z] = GLFW_KEY_Z;
    if (!window) return;
    io.ClipboardUserData = window;
    io.GetClipboardTextFn = [](void* at) {
        return glfwGetClipboardString(static_cast<GLFWwindow*>(at));
    };
    io.SetClipboardTextFn = [](void* at, const char* text) {
        glfwSetClipboardString(static_cast<GLFWwindow*>(at), text);
    };
}

}  // namespace fwui
