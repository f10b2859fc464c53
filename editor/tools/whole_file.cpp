// See whole_file.h.
#include "whole_file.h"

#include <cstdio>
#include <fstream>
#include <iterator>

namespace fwtools {

std::string readWhole(const std::string& path, std::vector<std::byte>& bytes) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return path + " cannot be read";
    const std::vector<char> read((std::istreambuf_iterator<char>(file)), {});
    if (file.bad()) return path + " cannot be read";
    const auto whole = std::as_bytes(std::span(read));
    bytes.assign(whole.begin(), whole.end());
    return {};
}

std::string replaceFile(const std::string& path, std::span<const std::byte> bytes) {
    const std::string fresh = path + ".new";
    {
        std::ofstream file(fresh, std::ios::binary);
        file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        if (!file.flush()) {
            std::remove(fresh.c_str());
            return path + " cannot be written";
        }
    }
    if (std::rename(fresh.c_str(), path.c_str()) == 0) return {};
    std::remove(fresh.c_str());
    return path + " cannot be written";
}

}  // namespace fwtools
