// Layout: a header (magic, settings, frames), then per frame a marker and its texels as half
// floats. The marker is written last.
#include "store.h"

#include <cstdio>
#include <glm/gtc/packing.hpp>

namespace fwtools {
namespace {

constexpr uint64_t kMagic = 0x3154524150574246ull;  // "FBWPART1"
constexpr uint64_t kHeader = 24, kMark = 8, kDone = 0x454E4F44ull;

bool putAt(std::FILE* file, uint64_t at, const void* data, size_t bytes) {
    return std::fseek(file, long(at), SEEK_SET) == 0 &&
           std::fwrite(data, 1, bytes, file) == bytes && std::fflush(file) == 0;
}
bool getAt(std::FILE* file, uint64_t at, void* data, size_t bytes) {
    return std::fseek(file, long(at), SEEK_SET) == 0 && std::fread(data, 1, bytes, file) == bytes;
}

}  // namespace

FrameStore::FrameStore(const std::string& path, uint64_t settings, uint32_t frames, uint32_t texels,
                       bool motion, std::string& error)
    : path_(path), texels_(texels), motion_(motion), done_(frames) {
    const uint64_t header[3] = {kMagic, settings, frames};
    uint64_t found[3] = {};
    file_ = std::fopen(path.c_str(), "r+b");
    if (file_ && getAt(file_, 0, found, sizeof found) && found[0] == header[0] &&
        found[1] == header[1] && found[2] == header[2]) {
        for (uint32_t i = 0; i < frames; ++i) {
            uint64_t mark = 0;
            done_[i] = getAt(file_, at(i), &mark, kMark) && mark == kDone;
        }
        return;
    }
    if (file_) std::fclose(file_);
    file_ = std::fopen(path.c_str(), "w+b");
    if (!file_ || !putAt(file_, 0, header, sizeof header)) error = path + " cannot be written";
}

FrameStore::~FrameStore() {
    if (file_) std::fclose(file_);
    if (forgotten_) std::remove(path_.c_str());
}

uint64_t FrameStore::at(uint32_t frame) const {
    return kHeader + frame * (kMark + uint64_t(texels_) * (motion_ ? 16 : 8));
}

bool FrameStore::put(uint32_t frame, const Frame& data) {
    std::vector<uint64_t> halfs;
    for (const vec4& t : data.texels) halfs.push_back(glm::packHalf4x16(t));
    for (size_t i = 0; motion_ && i < data.motion.size(); ++i) {
        const vec2& m = data.motion[i];
        halfs.push_back(glm::packHalf4x16(vec4(m * 1024.0f, 0, 0)));
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool whole = putAt(file_, at(frame) + kMark, halfs.data(), halfs.size() * 8) &&
                       putAt(file_, at(frame), &kDone, kMark);
    done_[frame] = whole;
    return whole;
}

bool FrameStore::get(uint32_t frame, Frame& data) {
    std::vector<uint64_t> halfs(size_t(texels_) * (motion_ ? 2 : 1));
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!getAt(file_, at(frame) + kMark, halfs.data(), halfs.size() * 8)) return false;
    }
    data = {};
    for (size_t i = 0; i < texels_; ++i) data.texels.push_back(glm::unpackHalf4x16(halfs[i]));
    for (size_t i = texels_; i < halfs.size(); ++i)
        data.motion.push_back(vec2(glm::unpackHalf4x16(halfs[i])) / 1024.0f);
    return true;
}

void FrameStore::forget() { forgotten_ = true; }

}  // namespace fwtools
