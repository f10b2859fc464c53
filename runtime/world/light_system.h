// The lights of a world: those of burning meshes as the device clustered them, with ids that stay,
// and those of volumetric fires and emitters, gathered to as many as the host wants.
#pragma once
#include "world/scene.h"

namespace fw::world {

class EmitterSystem;
class FlameSystem;

struct LightState {
    explicit LightState(std::pmr::memory_resource* memory)
        : lights(memory), before(memory), shown(memory) {}
    std::pmr::vector<FwLight> lights, before;  // of burning meshes, as of the last readbacks
    std::pmr::vector<FwLight> shown;           // `lights`, smooth from frame to frame
    uint32_t next = 1;                         // id
    bool due = false;                          // a load: the next that come show at once
};

class LightSystem {
 public:
    LightSystem(const WorldContext& context, Scene& scene, const FlameSystem& flames,
                const EmitterSystem& emitters);

    uint32_t gather(std::span<FwLight> out);

    void commit(float seconds);
    void onReadback(const gpu::Readback& readback) noexcept;
    void shiftOrigin(const double (&by)[3]) noexcept;
    [[nodiscard]] std::span<const FwLight> shown() const noexcept { return state_.shown; }

 private:
    friend class PersistenceSystem;
    void showSaved() noexcept;  // after a load, until a readback comes

    const WorldContext& context_;
    Scene& scene_;
    const FlameSystem& flames_;
    const EmitterSystem& emitters_;
    LightState state_{context_.memory};
    std::pmr::vector<uint32_t> kept_{context_.memory};    // ids of those that the last frame chose
    std::pmr::vector<FwLight> sources_{context_.memory};  // scratch
    std::pmr::vector<uint8_t> taken_{context_.memory};    // scratch
};

}  // namespace fw::world
