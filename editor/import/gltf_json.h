// Typed access to a glTF file's JSON, field by field. Errors name the field, its value and the
// allowed values. No knowledge of meshes.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace fwimport {

// The reason why a file is rejected, for the user: item, value and limit.
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

// Parses JSON. Rejects syntax errors with their position, and deep nesting. `repaired`: invalid
// UTF-8 bytes became question marks.
nlohmann::json parseJson(std::span<const uint8_t> bytes, bool& repaired);

// A JSON value with its path, such as "nodes[3].translation"; or a missing one.
class Field {
 public:
    Field() = default;
    Field(const nlohmann::json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[nodiscard]] bool present() const { return value_ != nullptr; }
    [[nodiscard]] const std::string& path() const { return path_; }
    // 0 for a missing list or object.
    [[nodiscard]] size_t size() const { return value_ ? value_->size() : 0; }
    // Returns the member names of an object.
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
    // Empty if missing. `count` 0: any length.
    [[nodiscard]] std::vector<double> numbers(const char* name, size_t count) const;
    // Returns an index below `count`, or -1 if missing. Larger values are an error.
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
