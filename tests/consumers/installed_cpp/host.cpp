// The smallest C++ host: a context and a world without a device, through the wrapper header.
#include <flamewright/flamewright.hpp>

#include <iostream>

int main() {
    auto def = fw::def<FwContextDef>();
    def.backend = FW_BACKEND_CPU;
    FwErrorInfo error{};
    const fw::Context context = fw::createContext(def, &error);
    if (!context) {
        std::cout << "createContext: " << error.message << '\n';
        return 1;
    }
    const fw::World world = fw::createWorld(context);
    if (!world) {
        std::cout << "createWorld: " << fw::lastMessage(context) << '\n';
        return 1;
    }
    std::cout << "flamewright " << (fwGetVersion() >> 22) << '\n';
}
