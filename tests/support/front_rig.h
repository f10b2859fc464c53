// A burn domain, one object on it and a cpu backend, driven step by step, for the front tests.
// Speeds in m/s, times in s; ticks where a name says so.
#pragma once
#include "fire/spread_law.h"
#include "gpu/cpu/cpu_backend.h"
#include "mesh/burn_domain.h"
#include "mesh/front/arrivals.h"
#include "support/meshes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>

namespace fw::test {

struct Vec3 {
    double x = 0, y = 0, z = 0;
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline Vec3 normalised(Vec3 a) { return a * (1 / length(a)); }

inline Vec3 texelPosition(const mesh::BurnDomain& domain, uint32_t texel) {
    const mesh::TexelPosition& t = domain.texels[texel];
    const double q = double(domain.quantum);
    return {double(domain.origin[0]) + q * t.x, double(domain.origin[1]) + q * t.y,
            double(domain.origin[2]) + q * t.z};
}
inline uint32_t texelNear(const mesh::BurnDomain& domain, Vec3 point) {
    uint32_t best = mesh::kNone;
    double least = 1e30;
    for (uint32_t i = 0; i < domain.texelCount(); ++i) {
        if (!domain.real(i)) continue;
        const double d = length(texelPosition(domain, i) - point);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
}

constexpr uint32_t kStartTick = 4096;

// One object on its own backend. The material is plain numbers, not a preset.
class FrontRig {
 public:
    struct Material {
        double rate = 0.02;  // m/s
        double headGain = 0, backGain = 0;
        double lengthToBreadth = 0;  // 0: no cap
        double burnTime = -1;        // s; < 0: for ever
        double driveMax = 60;
    };

    FrontRig(const mesh::BurnDomain& domain, const Material& material, Vec3 drive = {},
             std::span<const uint16_t> slowness = {})
        : FrontRig(domain, material, nullptr, drive, slowness, 0) {}
    // A material record of the spread law, unchanged. Its drive stays; flags are BurnObject's.
    FrontRig(const mesh::BurnDomain& domain, const gpu::BurnMaterial& record,
             std::span<const uint16_t> slowness = {}, uint32_t flags = 0)
        : FrontRig(domain, {}, &record, {}, slowness, flags) {}
    // Window in ticks; substeps per step. Both take effect at the next latch, like the drive.
    void setTiming(uint32_t window, uint32_t substepShift = 0, uint32_t windowMax = 1u << 20) {
        window_ = window;
        windowMax_ = windowMax;
        shift_ = substepShift;
        latchPending_ = true;
    }
    void setDrive(Vec3 drive) {
        drive_ = drive;
        latchPending_ = true;
    }
    void setSwitches(uint32_t switches) { switches_ = switches; }
    void push(uint32_t texel, uint32_t kind, uint32_t tick = 0) {
        events_.push_back({0, texel, kind, tick});
    }

    // Ignitions at their ticks, any time ahead; sorted here as a world does.
    void ignite(const std::function<double(uint32_t)>& secondsOf) {
        for (uint32_t i = 0; i < domain_.texelCount(); ++i) {
            if (!domain_.real(i)) continue;
            const double t = secondsOf(i);
            if (t >= 0)
                later_.push_back(
                    {0, i, gpu::kEventIgnite, kStartTick + uint32_t(std::lround(t * 4096))});
        }
        std::stable_sort(
            later_.begin(), later_.end(),
            [](const gpu::TexelEvent& a, const gpu::TexelEvent& b) { return a.tick < b.tick; });
    }

    void step() {
        while (nextLater_ < later_.size() && later_[nextLater_].tick <= now + gpu::kStepTicks)
            events_.push_back(later_[nextLater_++]);
        std::stable_sort(
            events_.begin(), events_.end(),
            [](const gpu::TexelEvent& a, const gpu::TexelEvent& b) { return a.texel < b.texel; });
        gpu::MaterialUpdate update{};
        gpu::StepPlan plan;
        plan.now = now;
        plan.substepShift = shift_;
        plan.reduce = reduceEvery != 0 && steps % reduceEvery == 0;
        plan.events = events_;
        if (latchPending_) {
            makeRecords(drive_, update.materials);
            update.window = window_;
            update.substepShift = shift_;
            plan.materials = {&update, 1};
            latchPending_ = false;
        }
        gpu::FramePlan frame;
        frame.frameIndex = ++frames_;
        frame.steps = {&plan, 1};
        frame.switches = switches_;
        frame.endTick = now + gpu::kStepTicks;
        backend_->run(frame);
        events_.clear();
        now += gpu::kStepTicks;
        ++steps;
        while (const gpu::Readback* readback = backend_->nextReadback()) {
            frontTiles = readback->frontTiles;
            runTiles = readback->runTiles;
            totalRunTiles += readback->runTiles;
        }
    }
    [[nodiscard]] bool idle() const {
        return frontTiles == 0 && events_.empty() && nextLater_ == later_.size() && steps > 0;
    }
    void runUntil(double seconds) {
        const double end = kStartTick + seconds * 4096;
        while (now < end && !idle()) step();
    }
    void runAll(double most = 1e5) { runUntil(most); }

    [[nodiscard]] std::span<const uint32_t> ticks() const { return backend_->state(0); }
    // Input of the arrival prediction from the current front. Lives as long as the rig.
    [[nodiscard]] mesh::ArrivalInput arrivalInput() {
        makeRecords(drive_, records_);
        mesh::ArrivalInput input;
        input.domain = &domain_;
        input.materials = records_;
        input.window = window_;
        input.state = ticks();
        input.now = now;
        return input;
    }
    [[nodiscard]] const gpu::ObjectCounters& counters() const { return backend_->counters(0); }
    [[nodiscard]] gpu::cpu::CpuBackend& backend() { return *backend_; }
    // Arrival, s after the start tick; < 0: none.
    [[nodiscard]] double arrival(uint32_t texel) const {
        const uint32_t t = ticks()[texel];
        return gpu::isSource(t) ? (double(t) - kStartTick) / 4096 : -1;
    }

    uint32_t now = kStartTick, steps = 0, frontTiles = 0, runTiles = 0, reduceEvery = 0;
    uint64_t totalRunTiles = 0;

 private:
    FrontRig(const mesh::BurnDomain& domain, const Material& material,
             const gpu::BurnMaterial* record, Vec3 drive, std::span<const uint16_t> slowness,
             uint32_t flags)
        : domain_(domain),
          backend_(std::make_unique<gpu::cpu::CpuBackend>(std::pmr::get_default_resource(), 16u)),
          material_(material),
          drive_(drive) {
        if (record) given_ = *record;
        isGiven_ = record != nullptr;
        backend_->createMesh(0, domain);
        gpu::ObjectInit init{};
        init.record.flags = gpu::kObjectLive | flags;
        init.record.window = window_;
        init.record.originQuantum = {domain.origin[0], domain.origin[1], domain.origin[2],
                                     domain.quantum};
        init.record.worldRow0 = {1, 0, 0, 0};
        init.record.worldRow1 = {0, 1, 0, 0};
        init.record.worldRow2 = {0, 0, 1, 0};
        init.record.tint = {1, 1, 1, domain.texelSide * domain.texelSide};
        makeRecords(drive, records_);
        init.materials = records_;
        init.slowness = slowness;
        backend_->createObject(0, init);
    }

    void makeRecords(Vec3 drive, gpu::BurnMaterial* records) const {
        gpu::BurnMaterial m = given_;
        if (!isGiven_) fillRecord(drive, m);
        for (uint32_t i = 0; i < gpu::kMaterialsPerObject; ++i) records[i] = m;
    }

    void fillRecord(Vec3 drive, gpu::BurnMaterial& m) const {
        m.sigma0 =
            uint32_t(std::lround(4096 / material_.rate * double(domain_.quantum) / 8 * 4194304));
        m.headGain = uint32_t(std::lround(material_.headGain * 256));
        m.backGain = uint32_t(std::lround(material_.backGain * 256));
        m.driveMax = uint32_t(std::lround(material_.driveMax * 1024));
        const double lb = material_.lengthToBreadth;
        m.breadthMax =
            lb > 0 ? uint32_t(std::lround(std::pow(lb + std::sqrt(lb * lb - 1), 2) * 256)) : 65280u;
        m.burnTicks = material_.burnTime < 0 ? gpu::kNoneTexel
                                             : uint32_t(std::lround(material_.burnTime * 4096));
        m.flameTicks = m.burnTicks;
        m.driveX = int(std::lround(drive.x * 1024));
        m.driveY = int(std::lround(drive.y * 1024));
        m.driveZ = int(std::lround(drive.z * 1024));
        m.flags = 1;
        m.windowMax = windowMax_;
        m.powerPerArea = 1e5f;
    }

    const mesh::BurnDomain& domain_;
    std::unique_ptr<gpu::cpu::CpuBackend> backend_;
    Material material_;
    gpu::BurnMaterial given_{};
    bool isGiven_ = false;
    gpu::BurnMaterial records_[gpu::kMaterialsPerObject] = {};
    std::vector<gpu::TexelEvent> events_, later_;
    size_t nextLater_ = 0;
    Vec3 drive_;
    uint32_t window_ = 512, windowMax_ = 1u << 20, shift_ = 0, switches_ = 0;
    uint64_t frames_ = 0;
    bool latchPending_ = false;
};

}  // namespace fw::test
