// The flames that a world's volumetric fires burn as: which there are, how a frame moves them
// together, and what they give to drawing, lights and questions. Looks alone, no device.
#pragma once
#include "components/volumetric_fire.h"
#include "core/owned.h"
#include "shared/volume_flame.h"

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
    uint32_t key = 0;       // no other flame's
    bool leaving = false;   // its fire burns as others now
    gpu::vec3 stood{0.0f};  // m, world: where its fire was when it was placed last
};

// A frame makes the next flames of the last ones, and they count once it is recorded.
class FireFlames {
 public:
    explicit FireFlames(std::pmr::memory_resource* memory)
        : now_(memory), next_(memory), others_(memory), met_(memory) {}

    // So that frames need no memory: for so many flames beside those that burn. Throws. How many.
    size_t findRoom(size_t more);
    void drop(const VolumetricFire& fire) noexcept;  // of a fire that goes
    void carry(gpu::vec3 by) noexcept;               // all of them, m

    // What its first frame will nearly say of a fire that has not been through one.
    FireState foresee(VolumetricFire& fire, const FireAir& air) const noexcept;

    void begin() noexcept { next_ = now_; }  // room was found
    // Which flames the fire has from now on; those without room are left out.
    void settle(VolumetricFire& fire, const FireAir& air) noexcept;
    // All of them `seconds` on; fills nextState of their fires.
    void advance(const FireAir& air, float seconds) noexcept;
    // Those that are drawn; how many.
    uint32_t write(std::span<gpu::VolumeFlame> out) const noexcept;
    void commit() noexcept { now_.swap(next_); }

    [[nodiscard]] std::span<const FireFlame> now() const noexcept { return now_; }

 private:
    void place(FireFlame& flame, const FireAir& air) const noexcept;
    void tell() noexcept;

    uint32_t lastKey_ = 0;
    std::pmr::vector<FireFlame> now_, next_;
    std::pmr::vector<volume::NeighbourFlame> others_;
    std::pmr::vector<volume::Neighbourhood> met_;
};

// Together, at a point; `walls` shade what radiates. fire: who heats it most, or null.
struct FireAnswer {
    volume::FlameAnswer air;
    const VolumetricFire* fire = nullptr;
};
FireAnswer askFires(std::span<const FireFlame> flames,
                    std::span<const core::Owned<volume::Profile>> profiles,
                    std::span<const volume::Collider> walls, gpu::vec3 point) noexcept;
volume::FlamePush pushOfFires(std::span<const FireFlame> flames,
                              std::span<const core::Owned<volume::Profile>> profiles,
                              std::span<const volume::Collider> walls, gpu::vec3 centre,
                              float radius) noexcept;

}  // namespace fw::components
