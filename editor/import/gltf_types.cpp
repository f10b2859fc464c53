#include "import/gltf_types.h"

#include <cstring>
#include <string_view>

namespace fwimport {
namespace {

enum class Kind { Integer, Number, Bool, String, Object, Array };

struct Field {
    const char* path;  // [] for any element, * for any member
    Kind kind;
    int count = 0;  // Array: elements; 0: any number
};
// An array's elements have a line of their own.
constexpr Field kFields[] = {
    {"asset", Kind::Object},
    {"asset.version", Kind::String},
    {"scene", Kind::Integer},
    {"extensionsRequired", Kind::Array},
    {"extensionsRequired[]", Kind::String},
    {"scenes", Kind::Array},
    {"scenes[]", Kind::Object},
    {"scenes[].nodes", Kind::Array},
    {"scenes[].nodes[]", Kind::Integer},
    {"nodes", Kind::Array},
    {"nodes[]", Kind::Object},
    {"nodes[].mesh", Kind::Integer},
    {"nodes[].children", Kind::Array},
    {"nodes[].children[]", Kind::Integer},
    {"nodes[].matrix", Kind::Array, 16},
    {"nodes[].matrix[]", Kind::Number},
    {"nodes[].translation", Kind::Array, 3},
    {"nodes[].translation[]", Kind::Number},
    {"nodes[].rotation", Kind::Array, 4},
    {"nodes[].rotation[]", Kind::Number},
    {"nodes[].scale", Kind::Array, 3},
    {"nodes[].scale[]", Kind::Number},
    {"meshes", Kind::Array},
    {"meshes[]", Kind::Object},
    {"meshes[].primitives", Kind::Array},
    {"meshes[].primitives[]", Kind::Object},
    {"meshes[].primitives[].attributes", Kind::Object},
    {"meshes[].primitives[].attributes.*", Kind::Integer},
    {"meshes[].primitives[].indices", Kind::Integer},
    {"meshes[].primitives[].material", Kind::Integer},
    {"meshes[].primitives[].mode", Kind::Integer},
    {"accessors", Kind::Array},
    {"accessors[]", Kind::Object},
    {"accessors[].bufferView", Kind::Integer},
    {"accessors[].byteOffset", Kind::Integer},
    {"accessors[].componentType", Kind::Integer},
    {"accessors[].count", Kind::Integer},
    {"accessors[].normalized", Kind::Bool},
    {"accessors[].type", Kind::String},
    {"accessors[].sparse", Kind::Object},
    {"accessors[].sparse.count", Kind::Integer},
    {"accessors[].sparse.indices", Kind::Object},
    {"accessors[].sparse.indices.*", Kind::Integer},
    {"accessors[].sparse.values", Kind::Object},
    {"accessors[].sparse.values.*", Kind::Integer},
    {"bufferViews", Kind::Array},
    {"bufferViews[]", Kind::Object},
    {"bufferViews[].buffer", Kind::Integer},
    {"bufferViews[].byteOffset", Kind::Integer},
    {"bufferViews[].byteLength", Kind::Integer},
    {"bufferViews[].byteStride", Kind::Integer},
    {"buffers", Kind::Array},
    {"buffers[]", Kind::Object},
    {"buffers[].byteLength", Kind::Integer},
    {"buffers[].uri", Kind::String},
    {"materials", Kind::Array},
    {"materials[]", Kind::Object},
    {"materials[].name", Kind::String},
    {"materials[].doubleSided", Kind::Bool},
    {"materials[].alphaMode", Kind::String},
    {"materials[].pbrMetallicRoughness", Kind::Object},
    {"materials[].pbrMetallicRoughness.baseColorFactor", Kind::Array, 4},
    {"materials[].pbrMetallicRoughness.baseColorFactor[]", Kind::Number},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Kind::Number},
    {"materials[].pbrMetallicRoughness.baseColorTexture", Kind::Object},
    {"materials[].pbrMetallicRoughness.baseColorTexture.index", Kind::Integer},
    {"materials[].pbrMetallicRoughness.baseColorTexture.texCoord", Kind::Integer},
#define FW_TRANSFORM \
    "materials[].pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform"
    {FW_TRANSFORM, Kind::Object},
    {FW_TRANSFORM ".offset", Kind::Array, 2},
    {FW_TRANSFORM ".offset[]", Kind::Number},
    {FW_TRANSFORM ".scale", Kind::Array, 2},
    {FW_TRANSFORM ".scale[]", Kind::Number},
    {FW_TRANSFORM ".rotation", Kind::Number},
    {FW_TRANSFORM ".texCoord", Kind::Integer},
#undef FW_TRANSFORM
    {"textures", Kind::Array},
    {"textures[]", Kind::Object},
    {"textures[].source", Kind::Integer},
    {"images", Kind::Array},
    {"images[]", Kind::Object},
    {"images[].uri", Kind::String},
    {"images[].bufferView", Kind::Integer},
};

struct Failure {
    std::string text;
};
struct Syntax {};  // not ours to tell

class Checker {
 public:
    explicit Checker(std::span<const uint8_t> json)
        : at_(reinterpret_cast<const char*>(json.data())), end_(at_ + json.size()) {}
    void run() { value(); }

 private:
    void skip() {
        while (at_ != end_ && std::strchr(" \t\r\n\xef\xbb\xbf", *at_) && *at_) ++at_;
        if (at_ == end_) throw Syntax{};
    }
    bool take(char c) {
        skip();
        if (*at_ != c) return false;
        ++at_;
        return true;
    }
    std::string_view string() {
        if (!take('"')) throw Syntax{};
        const char* from = at_;
        while (at_ != end_ && *at_ != '"') at_ += *at_ == '\\' && end_ - at_ > 1 ? 2 : 1;
        if (at_ == end_) throw Syntax{};
        return {from, size_t(at_++ - from)};
    }
    const Field* field() const {
        for (const Field& known : kFields)
            if (pattern_ == known.path) return &known;
        const size_t dot = pattern_.rfind('.');
        if (dot == std::string::npos) return nullptr;
        const std::string any = pattern_.substr(0, dot) + ".*";
        for (const Field& known : kFields)
            if (any == known.path) return &known;
        return nullptr;
    }
    [[noreturn]] void fail(const Field& wanted, const std::string& is) const {
        static constexpr const char* kTakes[] = {"an integer", "a number",  "true or false",
                                                 "a string",   "an object", "an array"};
        std::string takes = kTakes[int(wanted.kind)];
        if (wanted.count) takes = std::to_string(wanted.count) + " numbers";
        throw Failure{path_ + " is " + is + "; it takes " + takes};
    }
    void expect(const Field* wanted, bool good, const char* is) const {
        if (wanted && !good) fail(*wanted, is);
    }

    void value() {
        skip();
        const Field* wanted = path_.empty() ? nullptr : field();
        const Kind kind = wanted ? wanted->kind : Kind::Object;
        if (*at_ == '{') {
            expect(wanted, kind == Kind::Object, "an object");
            object();
        } else if (*at_ == '[') {
            expect(wanted, kind == Kind::Array, "an array");
            const int count = array();
            if (wanted && wanted->count && wanted->count != count)
                fail(*wanted, "an array of " + std::to_string(count));
        } else if (*at_ == '"') {
            expect(wanted, kind == Kind::String, "a string");
            (void)string();
        } else {
            word(wanted, kind);
        }
    }
    void object() {
        (void)take('{');
        if (take('}')) return;
        do {
            const size_t path = path_.size(), pattern = pattern_.size();
            skip();
            const std::string_view name = string();
            if (!path_.empty()) path_ += '.', pattern_ += '.';
            path_ += name;
            pattern_ += name;
            if (!take(':')) throw Syntax{};
            value();
            path_.resize(path);
            pattern_.resize(pattern);
        } while (take(','));
        if (!take('}')) throw Syntax{};
    }
    int array() {
        (void)take('[');
        if (take(']')) return 0;
        int count = 0;
        do {
            const size_t path = path_.size(), pattern = pattern_.size();
            path_ += '[' + std::to_string(count++) + ']';
            pattern_ += "[]";
            value();
            path_.resize(path);
            pattern_.resize(pattern);
        } while (take(','));
        if (!take(']')) throw Syntax{};
        return count;
    }
    // A number, true, false or null.
    void word(const Field* wanted, Kind kind) {
        const char* from = at_;
        while (at_ != end_ && !std::strchr(",]} \t\r\n", *at_)) ++at_;
        const std::string_view text(from, size_t(at_ - from));
        if (text.empty()) throw Syntax{};
        if (text == "true" || text == "false")
            return expect(wanted, kind == Kind::Bool, "true or false");
        if (text == "null") return expect(wanted, false, "null");
        if (text.find_first_not_of("+-.0123456789eE") != std::string_view::npos) throw Syntax{};
        const bool whole = text.find_first_of(".eE") == std::string_view::npos;
        if (wanted && kind == Kind::Integer && !whole)
            fail(*wanted, std::string(text.substr(0, 40)));
        expect(wanted, kind == Kind::Number || kind == Kind::Integer, "a number");
    }

    const char* at_;
    const char* end_;
    std::string path_, pattern_;
};

}  // namespace

std::string findWrongType(std::span<const uint8_t> json) {
    try {
        Checker(json).run();
    } catch (const Failure& failure) {
        return failure.text;
    } catch (const Syntax&) {
    }
    return {};
}

}  // namespace fwimport
