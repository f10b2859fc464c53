// The fires of burning objects as bodies (shaders/shared/body.h): which objects have one, and their
// records. Cosmetic. What burns where is the device's to know; here is what stays from frame to
// frame: the size of a body's flames and how far their noise has risen.
#pragma once
#include "shared/body.h"
#include "shared/volume.h"
#include "volume/appearance.h"
#include "world/scene.h"

#include <array>

namespace fw::world {

class WindSystem;

class FireBodies {
 public:
    // Of the objects that burn, as far as `out` has room; returns their number. `seconds`: of the
    // frame.
    uint32_t write(const WorldContext& context, const Scene& scene, const WindSystem& wind,
                   float seconds, std::span<gpu::VolumeFlame> out) noexcept;
    [[nodiscard]] const gpu::FlameBody* records() const noexcept { return records_.data(); }

 private:
    struct Body {
        FwBurnableMeshId object{};
        volume::FlameScroll scroll;
        bool burns = false;
    };
    std::array<Body, gpu::kMaxBodies> bodies_;
    uint32_t count_ = 0;
    std::array<gpu::FlameBody, gpu::kMaxBodies> records_;
};

}  // namespace fw::world
