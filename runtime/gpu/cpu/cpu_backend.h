// The burn simulation on the CPU: the same integers as on a device, at once, on one thread. It
// draws nothing, so it predicts nothing; BurnTiles and lights are kept for queries.
#pragma once
#include "core/owned.h"
#include "gpu/backend.h"

namespace fw::field {
struct Field;
}

namespace fw::gpu::cpu {

class CpuBackend final : public Backend {
 public:
    CpuBackend(std::pmr::memory_resource* memory, uint32_t maxLights);
    ~CpuBackend() override;
    CpuBackend(const CpuBackend&) = delete;
    CpuBackend& operator=(const CpuBackend&) = delete;

    void createMesh(uint32_t slot, const mesh::BurnDomain& domain) override;
    void destroyMesh(uint32_t slot) noexcept override;
    void createObject(uint32_t slot, const ObjectInit& init) override;
    void destroyObject(uint32_t slot) noexcept override;
    void setVertices(uint32_t, std::span<const float>, std::span<const float>) noexcept override {}
    void setRoom(uint32_t slot, const Room& room) noexcept override;
    void setObjectPose(uint32_t slot, const vec4 rows[3], const vec4& tint,
                       uint32_t flags) override;
    void createImage(uint32_t, uint32_t, uint32_t, std::span<const std::byte>, float) override {}
    void destroyImage(uint32_t) override {}

    void createField(uint32_t slot, const FieldRules& rules,
                     std::span<const uint8_t> masks) override;
    void destroyField(uint32_t slot) noexcept override;
    void setFieldRules(uint32_t slot, const FieldRules& rules) noexcept override;
    void setFieldMasks(uint32_t slot, std::span<const uint8_t> masks) override;
    [[nodiscard]] uint64_t fieldBytes(uint32_t slot) const noexcept override;
    void moveWorld(const double (&by)[3]) noexcept override;

    void restore(std::span<const RestoredObject> objects, uint32_t tick) override;
    void run(const FramePlan& plan) override;
    const Readback* nextReadback() override;
    std::span<const PassTime> passTimes() override;
    void memoryRows(std::pmr::vector<MemoryRow>& out) const override;

    // For tests and benches: the whole state of an object, one word per texel.
    [[nodiscard]] std::span<const uint32_t> state(uint32_t slot) const;
    [[nodiscard]] const ObjectCounters& counters(uint32_t slot) const;
    [[nodiscard]] std::span<const uvec2> heat(uint32_t slot) const;  // packed HeatTexel
    [[nodiscard]] const field::Field& field(uint32_t slot) const;
    // What comes to a tile (local number) from elsewhere, until it is set again.
    void setTileHeat(uint32_t slot, uint32_t tile, const TileHeat& heat);

    struct State;

 private:
    core::Owned<State> state_;
};

}  // namespace fw::gpu::cpu
