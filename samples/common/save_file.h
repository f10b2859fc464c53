// A file that is replaced as a whole or not at all: bytes go to a new file beside it, which takes
// its name once they are on the disk. Whatever ends the process in between leaves the old one as it
// was.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace sample {

// False, and the old file is as it was: a folder that is not there, a full disk.
[[nodiscard]] bool replaceFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
// Empty where there is none.
[[nodiscard]] std::vector<std::byte> readWholeFile(const std::filesystem::path& path);

}  // namespace sample
