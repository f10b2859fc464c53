#include "import/gltf_access.h"

#include <algorithm>
#include <cstring>
#include <iomanip>

#include "import/gltf_import.h"
#include "import/gltf_uri.h"

namespace fwimport {
namespace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;

uint32_t little32(const uint8_t* at) {
    return uint32_t{at[0]} | uint32_t{at[1]} << 8 | uint32_t{at[2]} << 16 | uint32_t{at[3]} << 24;
}

uint64_t componentSize(int64_t type) {
    switch (type) {
        case kByte:
        case kUnsignedByte:
            return 1;
        case kShort:
        case kUnsignedShort:
            return 2;
        case kUnsignedInt:
        case kFloat:
            return 4;
        default:
            return 0;
    }
}

uint64_t componentCount(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    return type == "MAT4" ? 16 : 0;
}

// [0, most]
uint64_t sizeOf(const Field& field, const char* name, int64_t otherwise) {
    const int64_t value = field.integer(name, otherwise);
    if (value < 0) refuse(field.path(), ".", name, " is ", value, "; 0 is the least");
    return static_cast<uint64_t>(value);
}

// Returns `count` elements of `element` bytes from `offset`, validated against the view.
Bytes rangeBytes(const Bytes& view, uint64_t offset, uint64_t count, uint64_t element,
                 const std::string& who) {
    const uint64_t stride = view.stride ? view.stride : element;
    if (stride < element) {
        refuse(who, ": the view's byteStride is ", stride, "; one element has ", element, " bytes");
    }
    // count is at most 2^26 and stride below 2^8 here, so nothing overflows.
    const uint64_t needed = count ? stride * (count - 1) + element : 0;
    if (offset > view.size || needed > view.size - offset) {
        refuse(who, " reads ", needed, " bytes from ", offset, "; its buffer view has ", view.size);
    }
    return {view.data + offset, needed, stride};
}

double readComponent(const uint8_t* at, int64_t type, bool normalized) {
    switch (type) {
        case kByte: {
            int8_t v;
            std::memcpy(&v, at, 1);
            return normalized ? std::max(v / 127.0, -1.0) : v;
        }
        case kUnsignedByte:
            return normalized ? *at / 255.0 : *at;
        case kShort: {
            int16_t v;
            std::memcpy(&v, at, 2);
            return normalized ? std::max(v / 32767.0, -1.0) : v;
        }
        case kUnsignedShort: {
            uint16_t v;
            std::memcpy(&v, at, 2);
            return normalized ? v / 65535.0 : v;
        }
        case kUnsignedInt: {
            uint32_t v;
            std::memcpy(&v, at, 4);
            return v;
        }
        default: {
            float v;
            std::memcpy(&v, at, 4);
            return v;
        }
    }
}

}  // namespace

void Notes::add(const std::string& line) {
    constexpr size_t kMost = 200;
    if (std::find(lines_.begin(), lines_.end(), line) != lines_.end()) return;
    if (lines_.size() < kMost)
        lines_.push_back(line);
    else
        ++unlisted_;
}

void Notes::leaveOut(const std::string& what, const std::string& where, const std::string& how) {
    auto group = std::find_if(groups_.begin(), groups_.end(),
                              [&](const Group& one) { return one.what == what && one.how == how; });
    constexpr size_t kMost = 400;
    if (group == groups_.end() && groups_.size() >= kMost) {
        ++unlisted_;
        return;
    }
    if (group == groups_.end())
        group = groups_.insert(group, Group{what, how, where, where, 0});
    else if (group->last == where)
        return;
    group->last = where;
    ++group->count;
}

void Notes::finish() {
    for (const Group& group : groups_) {
        std::string where = group.first;
        if (group.count > 1) where += text(" and ", group.count - 1, " more");
        add(text(group.what, " ", group.how, where.empty() ? "" : " (" + where + ")"));
    }
    groups_.clear();
    if (unlisted_) lines_.push_back(text("and ", unlisted_, " more notes"));
    unlisted_ = 0;
}

GltfFile::GltfFile(std::span<const uint8_t> bytes, std::filesystem::path folder, Notes& notes)
    : folder_(std::move(folder)), notes_(notes), packedBytes_(bytes.size()) {
    if (bytes.empty()) refuse("it is empty");
    std::span<const uint8_t> words = bytes;
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0) {
        readContainer(bytes);
        words = bytes.subspan(20, little32(&bytes[12]));
    }
    bool repaired = false;
    json_ = parseJson(words, repaired);
    if (!json_.is_object()) refuse("it is not glTF: its JSON is no object");
    if (repaired) notes_.add("the JSON is not all UTF-8: bytes of names are read as ?");
    const Field asset = root().object("asset");
    // Some writers store it as a number.
    const bool number = asset.present() && json_["asset"].contains("version") &&
                        json_["asset"]["version"].is_number();
    const std::string version =
        number ? text(std::fixed, std::setprecision(1), asset.number("version", 0))
               : asset.string("version");
    if (version != "2" && !version.starts_with("2."))
        refuse("asset.version is \"", version.substr(0, 40),
               "\"; 2.x is read (Blender, for one, reads glTF 1.0 and writes 2.0)");
    const std::string least = asset.string("minVersion", "2.0");
    if (least != "2.0") refuse("asset.minVersion is \"", least.substr(0, 40), "\"; 2.0 is read");
}

// Header and chunks. Unknown chunk types are skipped, as the standard requires.
void GltfFile::readContainer(std::span<const uint8_t> bytes) {
    if (bytes.size() < 20) {
        refuse("the GLB is ", bytes.size(), " bytes; its header and first chunk need 20");
    }
    const uint32_t version = little32(&bytes[4]), length = little32(&bytes[8]);
    if (version != 2) refuse("the GLB's version is ", version, "; 2 is read");
    if (length > bytes.size()) {
        refuse("the GLB's header says ", length, " bytes; the file has ", bytes.size());
    }
    if (length < 20) refuse("the GLB's header says ", length, " bytes; 20 are the least");
    const uint64_t jsonSize = little32(&bytes[12]);
    if (little32(&bytes[16]) != 0x4e4f534au) refuse("the GLB's first chunk is not JSON");
    if (20 + jsonSize > length) {
        refuse("the GLB's JSON chunk is ", jsonSize, " bytes; ", length - 20, " are left");
    }
    constexpr uint32_t kBinary = 0x004e4942u;
    for (uint64_t next = 20 + jsonSize; next + 8 <= length;) {
        // Lengths are multiples of four. Some writers pad without counting, some do not pad.
        if (next % 4 != 0 && little32(&bytes[next + 4]) != kBinary) next = (next + 3) / 4 * 4;
        if (next + 8 > length) break;
        const uint64_t size = little32(&bytes[next]);
        const bool binary = little32(&bytes[next + 4]) == kBinary;
        next += 8;
        if (next + size > length) {
            if (!binary) break;
            refuse("the GLB's binary chunk is ", size, " bytes; ", length - next, " are left");
        }
        if (binary && !hasBinary_) {
            binary_ = bytes.subspan(next, size);
            hasBinary_ = true;
        }
        next += size;
    }
}

Field GltfFile::item(const char* name, int64_t index) const {
    return root().list(name).at(static_cast<size_t>(index));
}

std::vector<uint8_t> GltfFile::uri(const std::string& uri, const std::string& field) {
    UriBytes read = readUri(uri, folder_, field);
    if (read.outside)
        notes_.add(text(field, " \"", uri.substr(0, 80), "\" lies outside the file's folder"));
    if (!uri.starts_with("data:") && otherFiles_.insert(uri).second)
        packedBytes_ += read.bytes.size();
    return std::move(read.bytes);
}

void GltfFile::reserve(uint64_t bytes, const std::string& who) {
    if (!tryReserve(bytes))
        refuse(who, " brings the memory of the model to ", reserved_ + bytes,
               " bytes; the limit for ", packedBytes_, " bytes of file is ",
               mostUnpacked(packedBytes_), ". Import a part of it, or make it smaller");
}

bool GltfFile::tryReserve(uint64_t bytes) {
    if (bytes > memoryLeft()) return false;
    reserved_ += bytes;
    return true;
}

std::span<const uint8_t> GltfFile::buffer(int index) {
    const Field buffer = item("buffers", index);
    const uint64_t wanted = sizeOf(buffer, "byteLength", INT32_MAX);
    std::span<const uint8_t> bytes;
    if (buffer.has("uri")) {
        auto found = buffers_.find(index);
        if (found == buffers_.end())
            found =
                buffers_.emplace(index, uri(buffer.string("uri"), buffer.path() + ".uri")).first;
        bytes = found->second;
    } else if (index == 0 && hasBinary_) {
        bytes = binary_;
    } else {
        refuse(buffer.path(), " has no uri",
               index == 0 ? ", and the file has no binary chunk" : "");
    }
    return bytes.first(std::min<uint64_t>(bytes.size(), wanted));
}

Bytes GltfFile::range(const Field& field, const char* name) {
    const int index = field.index("buffer", count("buffers"));
    if (index < 0) refuse(field.path(), ".buffer is missing");
    const std::span<const uint8_t> bytes = buffer(index);
    const uint64_t offset = sizeOf(field, "byteOffset", 0), size = sizeOf(field, "byteLength", 0);
    if (offset > bytes.size() || size > bytes.size() - offset) {
        refuse(name, " is ", size, " bytes from ", offset, "; buffers[", index, "] has ",
               bytes.size());
    }
    return {bytes.data() + offset, size, 0};
}

Bytes GltfFile::view(int64_t index, const std::string& who) {
    if (index < 0 || static_cast<size_t>(index) >= count("bufferViews"))
        refuse(who, ".bufferView is ", index, "; there are ", count("bufferViews"));
    const Field view = item("bufferViews", index);
    const uint64_t stride = sizeOf(view, "byteStride", 0);
    if (stride > 252) refuse(view.path(), ".byteStride is ", stride, "; 252 is the most");
    Field packed;
    for (const char* name : {"KHR_meshopt_compression", "EXT_meshopt_compression"})
        if (!packed.present()) packed = view.extension(name);
    if (packed.present()) {
        // A fallback buffer for readers without the codec may contain the plain bytes.
        const int plain = view.index("buffer", count("buffers"));
        const bool usable = plain >= 0 &&
                            (item("buffers", plain).has("uri") || (plain == 0 && hasBinary_)) &&
                            plain != packed.index("buffer", count("buffers"));
        if (readsMeshopt() || !usable) {
            auto found = unpacked_.find(index);
            if (found == unpacked_.end()) {
                MeshoptView wanted;
                wanted.count = sizeOf(packed, "count", 0);
                wanted.stride = sizeOf(packed, "byteStride", 0);
                wanted.mode = packed.string("mode");
                wanted.filter = packed.string("filter", "NONE");
                const Bytes from = range(packed, packed.path().c_str());
                if (wanted.stride <= 256 && wanted.count <= 4 * kMaxVertices)
                    reserve(wanted.count * wanted.stride, packed.path());
                found =
                    unpacked_.emplace(index, readMeshopt(from.span(), wanted, packed.path())).first;
            }
            return {found->second.data(), found->second.size(), stride};
        }
    }
    Bytes bytes = range(view, view.path().c_str());
    bytes.stride = stride;
    return bytes;
}

bool GltfFile::accessorHasData(int index) const {
    const Field accessor = item("accessors", index);
    return accessor.has("bufferView") || accessor.has("sparse");
}

bool GltfFile::isEmpty(int64_t index) const {
    return index >= 0 && static_cast<size_t>(index) < count("accessors") &&
           item("accessors", index).integer("count", 0) == 0;
}

Values GltfFile::accessor(int64_t index, const std::string& who) {
    if (index < 0 || static_cast<size_t>(index) >= count("accessors")) {
        refuse(who, " is accessor ", index, "; there are ", count("accessors"));
    }
    const Field accessor = item("accessors", index);
    const std::string name = text(accessor.path(), " (", who, ")");
    const int64_t type = accessor.integer("componentType", 0);
    const uint64_t size = componentSize(type);
    if (size == 0) refuse(name, ".componentType is ", type, ", which is unknown");
    Values values;
    values.count = sizeOf(accessor, "count", 0);
    values.components = componentCount(accessor.string("type"));
    if (values.components == 0) refuse(name, ".type is none of SCALAR, VEC2 to VEC4 and MAT4");
    if (values.count == 0) refuse(name, ".count is 0; 1 is the least");
    if (values.count > 4 * kMaxVertices) {
        refuse(name, ".count is ", values.count, "; the limit is ", 4 * kMaxVertices);
    }
    // A file may reference the same numbers many times, which takes time.
    const uint64_t mostRead = std::max(uint64_t{1} << 28, 100 * packedBytes_);
    if ((valuesRead_ += values.count * values.components) > mostRead)
        refuse(name, " raises the total to ", valuesRead_, " numbers; the limit for ", packedBytes_,
               " bytes of file is ", mostRead);
    // Up to four accessors of a primitive are in memory at a time.
    if (values.count * values.components * sizeof(double) > memoryLeft() / 4)
        refuse(name, " has ", values.count, " x ", values.components,
               " numbers; the memory left for ", packedBytes_, " bytes of file is for ",
               memoryLeft() / 4 / sizeof(double), ". Import a part of it, or make it smaller");
    const uint64_t element = size * values.components;
    const bool normalized = accessor.flag("normalized", false);
    const Field sparse = accessor.object("sparse");
    auto readInto = [&](double* to, const uint8_t* from) {
        for (uint64_t c = 0; c < values.components; ++c)
            to[c] = readComponent(from + c * size, type, normalized);
    };
    if (accessor.has("bufferView")) {
        const Bytes bytes =
            rangeBytes(view(accessor.integer("bufferView", -1), name),
                       sizeOf(accessor, "byteOffset", 0), values.count, element, name);
        values.data.resize(values.count * values.components);
        for (uint64_t i = 0; i < values.count; ++i) {
            readInto(&values.data[i * values.components], bytes.data + i * bytes.stride);
        }
    } else {
        if (values.count > kMaxVertices)
            refuse(name, ".count is ", values.count, "; without a bufferView the limit is ",
                   kMaxVertices);
        values.data.assign(values.count * values.components, 0.0);
    }
    if (!sparse.present()) return values;

    const uint64_t count = sizeOf(sparse, "count", 0);
    if (count < 1 || count > values.count) {
        refuse(name, ".sparse.count is ", count, "; it goes from 1 to ", values.count);
    }
    const Field indices = sparse.object("indices"), replaced = sparse.object("values");
    const int64_t indexType = indices.integer("componentType", 0);
    if (indexType != kUnsignedByte && indexType != kUnsignedShort && indexType != kUnsignedInt) {
        refuse(name, ".sparse.indices.componentType is ", indexType, "; 5121, 5123, 5125 are read");
    }
    const auto part = [&](const Field& field, uint64_t each) {
        const std::string whole = text(name, ".sparse.", &field == &indices ? "indices" : "values");
        return rangeBytes(view(field.integer("bufferView", -1), whole),
                          sizeOf(field, "byteOffset", 0), count, each, whole);
    };
    const Bytes places = part(indices, componentSize(indexType));
    const Bytes replacements = part(replaced, element);
    for (uint64_t i = 0; i < count; ++i) {
        const auto place =
            static_cast<uint64_t>(readComponent(places.data + i * places.stride, indexType, false));
        if (place >= values.count) {
            refuse(name, ".sparse.indices[", i, "] is ", place, "; the accessor has ",
                   values.count);
        }
        readInto(&values.data[place * values.components],
                 replacements.data + i * replacements.stride);
    }
    return values;
}

}  // namespace fwimport
