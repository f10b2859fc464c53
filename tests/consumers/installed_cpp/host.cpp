// The smallest C++ host: makes and destroys a context without a device.
#include <flamewright/flamewright.h>

#include <iostream>

int main() {
    FwContextDef def = fwDefaultContextDef();
    def.backend = FW_BACKEND_CPU;
    FwContext* context = nullptr;
    FwErrorInfo error{};
    if (fwCreateContext(&def, &context, &error) != FW_OK) {
        std::cout << "fwCreateContext: " << error.message << '\n';
        return 1;
    }
    fwDestroyContext(context);
    std::cout << "flamewright " << (fwGetVersion() >> 22) << '\n';
}
