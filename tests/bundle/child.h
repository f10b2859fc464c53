// Programs that flamewright-check runs beside itself: one that crashes or hangs costs only its
// part.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace fw::bundle {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// A child process with its output in a file. Its destructor ends it.
class Child {
 public:
    using Environment = std::map<std::string, std::string>;  // on top of ours
    // Throws std::runtime_error if it cannot start. `folder`: where it runs.
    Child(const std::vector<std::string>& words, const std::string& log,
          const Environment& environment, const std::string& folder);
    ~Child() { stop(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    // True once it has ended.
    bool ended();
    bool waitFor(double seconds);
    // Ends it and its children. Does not wait for one that the driver holds.
    void stop();
    // "" after a clean end; else "status 3", "signal 11 (Segmentation fault)" or "stopped".
    [[nodiscard]] std::string fault() const { return fault_; }

 private:
    pid_t pid_ = -1;
    bool running_ = false, stopped_ = false;
    std::string fault_;
};

std::string textOf(const std::string& path);  // "" without the file
// The last lines of a text, at most `count`.
std::string lastLines(const std::string& text, size_t count);

}  // namespace fw::bundle
