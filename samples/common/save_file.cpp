#include "common/save_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace sample {
namespace {

bool writeAll(int file, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t wrote = write(file, bytes.data(), bytes.size());
        if (wrote <= 0) return false;
        bytes = bytes.subspan(size_t(wrote));
    }
    return true;
}

}  // namespace

bool replaceFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::filesystem::path fresh = path;
    fresh += ".new";
    const int file = open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file < 0) return false;
    const bool whole = writeAll(file, bytes) && fsync(file) == 0;
    const bool closed = close(file) == 0;
    std::error_code failed;
    if (whole && closed) {
        std::filesystem::rename(fresh, path, failed);
        if (!failed) return true;
    }
    std::filesystem::remove(fresh, failed);
    return false;
}

std::vector<std::byte> readWholeFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(file),
                                 std::istreambuf_iterator<char>()};
    std::vector<std::byte> bytes(text.size());
    for (size_t i = 0; i < text.size(); ++i) bytes[i] = std::byte(text[i]);
    return bytes;
}

}  // namespace sample
