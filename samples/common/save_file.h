// Replaces a file atomically: writes a new file beside it, flushes it to disk, then renames it. If
// the process ends in between, the old file stays intact.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace sample {

// Returns false and keeps the old file on failure, for example a missing folder or a full disk.
[[nodiscard]] bool replaceFile(const std::filesystem::path& path, std::span<const std::byte> bytes);
// Returns an empty vector if there is no such file.
[[nodiscard]] std::vector<std::byte> readWholeFile(const std::filesystem::path& path);

}  // namespace sample
