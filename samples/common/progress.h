// Progress bar on stderr while a sample runs, summary on stdout at its end.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sample {

class Progress {
 public:
    Progress(std::string what, uint32_t total);
    ~Progress();
    void update(uint32_t done);  // redraws at most ten times a second
    void finish();
    double seconds() const;  // since the start

 private:
    void draw(uint32_t done);
    std::string what_;
    uint32_t total_;
    bool terminal_, finished_ = false;
    uint32_t fifths_ = 0;
    std::chrono::steady_clock::time_point begin_, drawn_;
};

struct PassCost {
    std::string name;
    double milliseconds = 0;  // mean over the frames in which the pass ran
    uint32_t frames = 0;
};

struct Summary {
    std::string title;
    std::vector<std::pair<std::string, std::string>> rows;  // name, value
    std::vector<PassCost> passes;
    std::vector<std::string> files;
};
void printSummary(const Summary& summary);

}  // namespace sample
