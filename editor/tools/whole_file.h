// Reads and writes whole files atomically, so an interrupted tool keeps the old file.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fwtools {

// Returns an empty string, or the problem with the file's name.
[[nodiscard]] std::string readWhole(const std::string& path, std::vector<std::byte>& bytes);
[[nodiscard]] std::string replaceFile(const std::string& path, std::span<const std::byte> bytes);

}  // namespace fwtools
