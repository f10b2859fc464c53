// A file of finished frames beside the flipbook, from which an interrupted bake resumes.
#pragma once
#include "scene.h"

#include <cstdio>
#include <mutex>
#include <string>

namespace fwtools {

class FrameStore {
 public:
    // Opens or creates `path`; frames of other settings are discarded. error: empty if it is open.
    FrameStore(const std::string& path, uint64_t settings, uint32_t frames, uint32_t texels,
               bool motion, std::string& error);
    ~FrameStore();
    FrameStore(const FrameStore&) = delete;
    FrameStore& operator=(const FrameStore&) = delete;
    [[nodiscard]] bool has(uint32_t frame) const { return done_[frame]; }
    // returns false if reading or writing fails
    bool put(uint32_t frame, const Frame& data);  // any thread
    bool get(uint32_t frame, Frame& data);        // any thread
    void forget();                                // deletes the file with the store

 private:
    [[nodiscard]] uint64_t at(uint32_t frame) const;
    std::mutex mutex_;
    std::string path_;
    std::FILE* file_ = nullptr;
    uint32_t texels_ = 0;
    bool motion_ = false, forgotten_ = false;
    std::vector<bool> done_;
};

}  // namespace fwtools
