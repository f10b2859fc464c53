// How long a packet and its answer are under way, measured one packet at a time, and how long to
// wait for an answer before it counts as lost: the estimator of RFC 6298.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fw::net {

class RoundTrip {
 public:
    void sent(uint32_t sequence, double now) noexcept {
        if (probe_ != 0) return;
        probe_ = sequence;
        probeAt_ = now;
    }
    // `sequence`: of the newest packet that the other side has got.
    void answered(uint32_t sequence, double now) noexcept {
        if (probe_ == 0 || sequence < probe_) return;
        const double sample = now - probeAt_;
        probe_ = 0;
        if (mean_ == 0) {
            mean_ = sample;
            deviation_ = sample / 2;
            return;
        }
        deviation_ += (std::abs(sample - mean_) - deviation_) / 4;
        mean_ += (sample - mean_) / 8;
    }
    [[nodiscard]] double seconds() const noexcept { return mean_; }
    [[nodiscard]] double timeout() const noexcept {
        if (mean_ == 0) return 0.5;
        return std::clamp(mean_ + 4 * deviation_, 0.1, 15.0);
    }

 private:
    double mean_ = 0, deviation_ = 0;  // s
    uint32_t probe_ = 0;               // sequence of the packet that is measured; 0: none is
    double probeAt_ = 0;               // s
};

}  // namespace fw::net
