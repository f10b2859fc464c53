// The lights of a world: those of burning meshes as the device clustered them, with ids that stay,
// and those of volumetric fires and emitters, gathered to as many as the host wants.
#pragma once
#include "world/scene.h"

namespace fw::world {

class EmitterSystem;
class FlameSystem;

class LightSystem {
 public:
    LightSystem(const WorldContext& context, Scene& scene, const FlameSystem& flames,
                const EmitterSystem& emitters);

    uint32_t gather(std::span<FwLight> out);

    void commit(const HostFrame& frame);
    void onReadback(const gpu::Readback& readback) noexcept;
    void shiftOrigin(const double (&by)[3]) noexcept;
    [[nodiscard]] std::span<const FwLight> shown() const noexcept { return shown_; }
    void showSaved() noexcept;  // after a load, until a readback comes

 private:
    uint32_t nextId() noexcept;  // never 0
    const WorldContext& context_;
    Scene& scene_;
    const FlameSystem& flames_;
    const EmitterSystem& emitters_;
    std::pmr::vector<FwLight> lights_{context_.memory};   // of meshes, as of the last readback
    std::pmr::vector<FwLight> before_{context_.memory};   // and the one before
    std::pmr::vector<FwLight> shown_{context_.memory};    // `lights_`, smooth from frame to frame
    uint32_t next_ = 1;                                   // id
    bool due_ = false;                                    // a load: the next that come show at once
    std::pmr::vector<uint32_t> kept_{context_.memory};    // ids of those that the last frame chose
    std::pmr::vector<FwLight> sources_{context_.memory};  // scratch
    std::pmr::vector<uint8_t> taken_{context_.memory};    // scratch
};

}  // namespace fw::world
