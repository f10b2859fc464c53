// See soak.h.
#include "soak.h"

#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <fstream>

#include "common/options.h"

namespace tower {
namespace {

constexpr double kMostGrowth = 1.1;

uint64_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    uint64_t all = 0, resident = 0;
    file >> all >> resident;
    return resident * uint64_t(sysconf(_SC_PAGESIZE));
}

}  // namespace

void Soak::beginFrame() {
    if (frame_ <= frames_) return;
    endRound();
    siege_.restore(first_);
    frame_ = 1;
    began_ = std::clock();
}

void Soak::afterAdvance() {
    ++frame_;
    if (saved_) return;
    if (!pending_) {
        first_ = siege_.snapshot();
        checkFire(world_, fwWorld_RequestSave(world_), "fwWorld_RequestSave");
        pending_ = true;
        return;
    }
    uint64_t size = 0;
    const FwResult result = fwWorld_FetchSave(world_, nullptr, &size);
    if (result == FW_NOT_READY) return;
    checkFire(world_, result, "fwWorld_FetchSave");
    first_.world.resize(size);
    checkFire(world_, fwWorld_FetchSave(world_, first_.world.data(), &size), "fwWorld_FetchSave");
    saved_ = true;
}

void Soak::endRound() {
    if (!saved_)
        throw sample::Failure("--soak is too short: the first snapshot was not saved in time");
    FwContextInfo info{};
    info.structSize = sizeof info;
    if (fwContext_GetInfo(context_, &info) != FW_OK)
        throw sample::Failure("fwContext_GetInfo failed");
    const std::clock_t now = std::clock();
    rounds_.push_back({1e3 * double(now - began_) / CLOCKS_PER_SEC / frames_, info.gpuMemoryUsed,
                       info.cpuMemoryUsed, residentBytes(), game::hashOf(siege_.state())});
}

int Soak::report() {
    endRound();
    if (rounds_.size() != kRounds + 1) throw sample::Failure("--soak was cut short");
    // Round 0 warms up: pipelines compile at their first use, and buffers grow.
    const Round &first = rounds_[1], &last = rounds_.back();
    for (size_t i = 0; i < rounds_.size(); ++i) {
        const Round& round = rounds_[i];
        std::printf(
            "round %zu: %.2f ms per frame, device %.1f MB, library %.1f MB, process %.1f MB, "
            "hash %016" PRIx64 "\n",
            i, round.milliseconds, 1e-6 * double(round.device), 1e-6 * double(round.host),
            1e-6 * double(round.process), round.hash);
    }
    const auto compare = [](const char* what, double a, double b) {
        std::printf("%s: the last is %.3f of the first\n", what, b / a);
        return b <= kMostGrowth * a;
    };
    // Other load on the machine changes the time, so the caller judges it.
    (void)compare("processor time", first.milliseconds, last.milliseconds);
    const bool flat[] = {compare("device memory", double(first.device), double(last.device)),
                         compare("library memory", double(first.host), double(last.host)),
                         compare("process memory", double(first.process), double(last.process))};
    for (size_t i = 1; i < rounds_.size(); ++i)
        if (rounds_[i].hash != first.hash) {
            std::printf("a round had another result\n");
            return 1;
        }
    return flat[0] && flat[1] && flat[2] ? 0 : 1;
}

}  // namespace tower
