// The JSON of a glTF file, field by field: each is read with the type that glTF gives it, and a
// refusal names the field, its value and what it takes. Knows nothing of meshes.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace fwimport {

// Why a file is not read, for the user: names the thing, its value and the limit.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream stream;
    (stream << ... << parts);
    return stream.str();
}

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
    throw Refusal(text(parts...));
}

// Parses; refuses broken syntax by its place, and deep nesting. `repaired`: it held bytes that are
// no UTF-8, which became question marks.
nlohmann::json parseJson(std::span<const uint8_t> bytes, bool& repaired);

// A value in the JSON and its path, "nodes[3].translation"; or the absence of one.
class Field {
 public:
    Field() = default;
    Field(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[nodiscard]] bool present() const { return value_ != nullptr; }
    [[nodiscard]] const std::string& path() const { return path_; }
    // 0 for an absent list or object.
    [[nodiscard]] size_t size() const { return value_ ? value_->size() : 0; }
    // The names of an object's members.
    [[nodiscard]] std::vector<std::string> names() const;

    [[nodiscard]] Field object(const char* name) const;
    [[nodiscard]] Field list(const char* name) const;
    [[nodiscard]] Field at(size_t index) const;  // of a list: below size()
    // extensions.NAME
    [[nodiscard]] Field extension(const char* name) const;

    [[nodiscard]] bool has(const char* name) const;
    [[nodiscard]] int64_t integer(const char* name, int64_t otherwise) const;
    [[nodiscard]] double number(const char* name, double otherwise) const;
    [[nodiscard]] bool flag(const char* name, bool otherwise) const;
    [[nodiscard]] std::string string(const char* name, const char* otherwise = "") const;
    // Empty where absent; `count` 0: any number of them.
    [[nodiscard]] std::vector<double> numbers(const char* name, size_t count) const;
    // Into a list of `count`, refused beyond it. -1: absent.
    [[nodiscard]] int index(const char* name, size_t count) const;
    [[nodiscard]] int64_t asInteger() const;
    [[nodiscard]] std::string asString() const;

 private:
    [[nodiscard]] const nlohmann::json* find(const char* name) const;
    [[nodiscard]] std::string pathOf(const char* name) const;

    const nlohmann::json* value_ = nullptr;
    std::string path_;
};

}  // namespace fwimport
