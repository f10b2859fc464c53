// See progress.h.
#include "common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace sample {
namespace {

std::string clockText(double seconds) {
    const auto whole = static_cast<int>(std::lround(std::max(0.0, seconds)));
    char text[32];
    std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
    return text;
}

}  // namespace

Progress::Progress(std::string what, uint32_t total)
    : what_(std::move(what)),
      total_(std::max(1u, total)),
      terminal_(isatty(fileno(stderr)) != 0),
      begin_(std::chrono::steady_clock::now()),
      drawn_(begin_) {}

Progress::~Progress() {
    if (terminal_ && !finished_) std::fputc('\n', stderr);
}

double Progress::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

void Progress::draw(uint32_t done) {
    constexpr int kWidth = 32;
    const double part = std::min(1.0, double(done) / total_);
    const int filled = static_cast<int>(part * kWidth);
    std::string bar(static_cast<size_t>(filled), '#');
    bar.append(static_cast<size_t>(kWidth - filled), '.');
    const double elapsed = seconds();
    const std::string left = part > 0 ? clockText(elapsed * (1.0 - part) / part) : "?";
    std::fprintf(stderr, "%s%s [%s] %u/%u  %s elapsed, %s left%s", terminal_ ? "\r" : "",
                 what_.c_str(), bar.c_str(), done, total_, clockText(elapsed).c_str(), left.c_str(),
                 terminal_ ? "   " : "\n");
    std::fflush(stderr);
}

void Progress::update(uint32_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (terminal_) {
        if (done < total_ && now - drawn_ < std::chrono::milliseconds(100)) return;
        drawn_ = now;
        draw(done);
        return;
    }
    // In a log file: one line per fifth of the run.
    const uint32_t fifths = static_cast<uint32_t>(uint64_t{done} * 5 / total_);
    if (fifths == fifths_) return;
    fifths_ = fifths;
    draw(done);
}

void Progress::finish() {
    if (finished_) return;
    finished_ = true;
    if (terminal_) {
        draw(total_);
        std::fputc('\n', stderr);
    }
}

void printSummary(const Summary& summary) {
    std::printf("\n%s\n", summary.title.c_str());
    for (const auto& [name, value] : summary.rows) {
        std::printf("  %-14s %s\n", name.c_str(), value.c_str());
    }
    if (!summary.passes.empty()) {
        std::printf("  %-14s ms, mean over the frames it ran in\n", "GPU passes");
        double sum = 0;
        for (const PassCost& pass : summary.passes) {
            std::printf("    %-24s %8.3f  (%u frames)\n", pass.name.c_str(), pass.milliseconds,
                        pass.frames);
            sum += pass.milliseconds;
        }
        std::printf("    %-24s %8.3f\n", "sum", sum);
    }
    for (const std::string& file : summary.files) {
        std::printf("  %-14s %s\n", &file == summary.files.data() ? "pictures" : "", file.c_str());
    }
    std::fflush(stdout);
}

}  // namespace sample
