// The flames of a world's volumetric fires: creation, a frame's step of all of them together, and
// their records for drawing, lights and queries. Cosmetic, without a device.
#pragma once
#include "components/volumetric_fire.h"
#include "core/assert.h"
#include "core/owned.h"
#include "shared/volume.h"

namespace fw::components {

struct FireAir {  // of a world
    float up[3] = {0, 1, 0};
    std::span<const volume::Collider> colliders;
};

struct FireFlame {
    volume::Flame flame;
    VolumetricFire* fire = nullptr;
    uint32_t part = 0, split = 0;  // of its fire
    uint32_t trackVersion = 0;
    uint32_t key = 0;       // unique
    gpu::vec3 stood{0.0f};  // m, world: place of its fire at the last `place`
};

// A frame computes the next flames from the last ones; `commit` makes them current.
class FireFlames {
 public:
    explicit FireFlames(std::pmr::memory_resource* memory)
        : now_(memory), next_(memory), others_(memory), met_(memory) {}

    // Reserves memory for `more` further flames, so that frames need none. Throws. Returns
    // capacity.
    size_t reserveFlames(size_t more);
    void drop(const VolumetricFire& fire) noexcept;  // the flames of a destroyed fire
    void carry(gpu::vec3 by) noexcept;               // moves all flames, m

    // An estimate of the fire's state after its first frame.
    FireState predictAhead(VolumetricFire& fire, const FireAir& air) const noexcept;

    void begin() noexcept {
        FW_ASSERT(now_.size() <= next_.capacity(), "%zu of %zu flames", now_.size(),
                  next_.capacity());
        next_ = now_;
    }
    // Makes the fire's flames match its parts. Flames beyond the capacity are left out.
    void settle(VolumetricFire& fire, const FireAir& air) noexcept;
    // Advances all flames by `seconds`; fills nextState of their fires.
    void advance(const FireAir& air, float seconds) noexcept;
    // Writes the drawn flames; returns their count.
    uint32_t write(std::span<gpu::VolumeFlame> out) const noexcept;
    void commit() noexcept { now_.swap(next_); }

    [[nodiscard]] std::span<const FireFlame> now() const noexcept { return now_; }

 private:
    void place(FireFlame& flame, const FireAir& air) const noexcept;
    void sumStates() noexcept;

    uint32_t lastKey_ = 0;
    std::pmr::vector<FireFlame> now_, next_;
    std::pmr::vector<volume::NeighbourFlame> others_;
    std::pmr::vector<volume::Neighbourhood> met_;
};

// The effect of all flames at a point; `walls` stop radiation. fire: the one that heats most, or
// null.
struct FireAnswer {
    volume::FlameAnswer air;
    const VolumetricFire* fire = nullptr;
};
FireAnswer queryFires(std::span<const FireFlame> flames,
                      std::span<const core::Owned<volume::Profile>> profiles,
                      std::span<const volume::Collider> walls, gpu::vec3 point) noexcept;
volume::FlamePush pushOfFires(std::span<const FireFlame> flames,
                              std::span<const core::Owned<volume::Profile>> profiles,
                              std::span<const volume::Collider> walls, gpu::vec3 centre,
                              float radius) noexcept;

}  // namespace fw::components
