// Files read and written whole: a tool that is cut off leaves the old file.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace fwtools {

// Empty, or what went wrong, with the file's name.
[[nodiscard]] std::string readWhole(const std::string& path, std::vector<std::byte>& bytes);
[[nodiscard]] std::string writeWhole(const std::string& path, std::span<const std::byte> bytes);

}  // namespace fwtools
