// See gltf_json.h.
#include "import/gltf_json.h"

#include <algorithm>
#include <cmath>

namespace fwimport {
namespace {

using nlohmann::json;

constexpr int kDeepest = 64;

// Parsing and destruction recurse per level.
void checkNesting(std::span<const uint8_t> bytes) {
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < bytes.size(); ++i) {
        const uint8_t c = bytes[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kDeepest) refuse("the JSON nests deeper than ", kDeepest, " levels");
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

// Returns the byte count of the character at `at`; 0: invalid UTF-8.
size_t utf8Length(std::span<const uint8_t> bytes, size_t at) {
    const uint8_t c = bytes[at];
    if (c < 0x80) return 1;
    const size_t length = c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : c < 0xf5 ? 4 : 0;
    if (c < 0xc2 || length == 0 || at + length > bytes.size()) return 0;
    for (size_t i = 1; i < length; ++i)
        if ((bytes[at + i] & 0xc0) != 0x80) return 0;
    const uint8_t second = bytes[at + 1];
    const bool overlong = (c == 0xe0 && second < 0xa0) || (c == 0xf0 && second < 0x90);
    const bool outside = (c == 0xed && second >= 0xa0) || (c == 0xf4 && second >= 0x90);
    return overlong || outside ? 0 : length;
}

const char* kindOf(const json& value) {
    if (value.is_string()) return "a string";
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array";
    if (value.is_boolean()) return "true or false";
    return value.is_null() ? "null" : "a number";
}

[[noreturn]] void refuseKind(const json& value, const std::string& path, const char* takes) {
    refuse(path, " is ", kindOf(value), "; it takes ", takes);
}

// Integers may be written as 3.0 or 3e0.
int64_t integerOf(const json& value, const std::string& path) {
    constexpr double kMost = 9007199254740992.0;  // doubles are exact below this
    if (value.is_number_integer()) {
        const auto number = value.get<double>();
        if (std::abs(number) > kMost) refuse(path, " is ", number, "; 2^53 is the most");
        return value.get<int64_t>();
    }
    if (!value.is_number()) refuseKind(value, path, "an integer");
    const auto number = value.get<double>();
    if (number != std::floor(number) || std::abs(number) > kMost)
        refuse(path, " is ", number, "; it takes an integer");
    return static_cast<int64_t>(number);
}

}  // namespace

json parseJson(std::span<const uint8_t> bytes, bool& repaired) {
    repaired = false;
    // Some writers pad a GLB's JSON with zeros.
    while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
    checkNesting(bytes);
    std::vector<uint8_t> cleaned;
    for (size_t at = 0; at < bytes.size();) {
        const size_t length = utf8Length(bytes, at);
        if (length == 0) {
            if (cleaned.empty()) cleaned.assign(bytes.begin(), bytes.end());
            cleaned[at] = '?';
        }
        at += std::max<size_t>(length, 1);
    }
    repaired = !cleaned.empty();
    if (repaired) bytes = cleaned;
    try {
        return json::parse(bytes.begin(), bytes.end());
    } catch (const json::parse_error& failure) {
        const size_t at = std::min<size_t>(failure.byte, bytes.size());
        const size_t line = 1 + size_t(std::count(bytes.begin(), bytes.begin() + long(at), '\n'));
        refuse("it is not glTF: its JSON ends or goes wrong at byte ", at, ", in line ", line);
    } catch (const json::exception&) {
        refuse("its JSON holds a number beyond 1.8e308");
    }
}

std::string Field::pathOf(const char* name) const {
    return path_.empty() ? name : path_ + "." + name;
}

const json* Field::find(const char* name) const {
    if (!value_) return nullptr;
    if (!value_->is_object()) refuseKind(*value_, path_.empty() ? "the JSON" : path_, "an object");
    const auto found = value_->find(name);
    return found == value_->end() ? nullptr : &*found;
}

std::vector<std::string> Field::names() const {
    std::vector<std::string> result;
    if (!value_) return result;
    if (!value_->is_object()) refuseKind(*value_, path_, "an object");
    for (auto item = value_->begin(); item != value_->end(); ++item) result.push_back(item.key());
    return result;
}

bool Field::has(const char* name) const { return find(name) != nullptr; }

Field Field::object(const char* name) const {
    const json* value = find(name);
    if (!value) return {};
    if (!value->is_object()) refuseKind(*value, pathOf(name), "an object");
    return {*value, pathOf(name)};
}

Field Field::list(const char* name) const {
    const json* value = find(name);
    if (!value) return {};
    if (!value->is_array()) refuseKind(*value, pathOf(name), "an array");
    return {*value, pathOf(name)};
}

Field Field::at(size_t index) const { return {(*value_)[index], text(path_, "[", index, "]")}; }

Field Field::extension(const char* name) const {
    return present() && has("extensions") ? object("extensions").object(name) : Field();
}

int64_t Field::integer(const char* name, int64_t otherwise) const {
    const json* value = find(name);
    return value ? integerOf(*value, pathOf(name)) : otherwise;
}

int64_t Field::asInteger() const { return integerOf(*value_, path_); }

double Field::number(const char* name, double otherwise) const {
    const json* value = find(name);
    if (!value) return otherwise;
    if (!value->is_number()) refuseKind(*value, pathOf(name), "a number");
    return value->get<double>();
}

bool Field::flag(const char* name, bool otherwise) const {
    const json* value = find(name);
    if (!value) return otherwise;
    if (!value->is_boolean()) refuseKind(*value, pathOf(name), "true or false");
    return value->get<bool>();
}

std::string Field::string(const char* name, const char* otherwise) const {
    const json* value = find(name);
    if (!value) return otherwise;
    if (!value->is_string()) refuseKind(*value, pathOf(name), "a string");
    return value->get<std::string>();
}

std::string Field::asString() const {
    if (!value_->is_string()) refuseKind(*value_, path_, "a string");
    return value_->get<std::string>();
}

std::vector<double> Field::numbers(const char* name, size_t count) const {
    const json* value = find(name);
    if (!value) return {};
    const std::string takes = count ? text(count, " numbers") : "an array of numbers";
    if (!value->is_array()) refuseKind(*value, pathOf(name), takes.c_str());
    if (count && value->size() != count)
        refuse(pathOf(name), " is an array of ", value->size(), "; it takes ", takes);
    std::vector<double> result;
    for (size_t i = 0; i < value->size(); ++i) {
        const json& one = (*value)[i];
        if (!one.is_number()) refuseKind(one, text(pathOf(name), "[", i, "]"), "a number");
        result.push_back(one.get<double>());
    }
    return result;
}

int Field::index(const char* name, size_t count) const {
    const json* value = find(name);
    if (!value) return -1;
    const int64_t number = integerOf(*value, pathOf(name));
    if (number == -1) return -1;  // some writers encode "none" like this
    if (number < 0 || static_cast<uint64_t>(number) >= count)
        refuse(pathOf(name), " is ", number, "; there are ", count);
    return static_cast<int>(number);
}

}  // namespace fwimport
