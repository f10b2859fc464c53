// See gltf_access.h.
#include "import/gltf_access.h"

#include <algorithm>
#include <cstring>

#include "import/gltf_import.h"

namespace fwimport {
namespace {

uint32_t little32(const uint8_t* at) {
    return uint32_t{at[0]} | uint32_t{at[1]} << 8 | uint32_t{at[2]} << 16 | uint32_t{at[3]} << 24;
}

uint64_t componentSize(int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

uint64_t componentCount(int type) {
    switch (type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        default:
            return 0;
    }
}

// `count` elements of `element` bytes from `offset`, proved to lie within the view.
Bytes rangeBytes(const Bytes& view, uint64_t offset, uint64_t count, uint64_t element,
                 const std::string& who) {
    const uint64_t stride = view.stride ? view.stride : element;
    if (stride < element) {
        refuse(who, ": the view's byteStride is ", stride, "; one element has ", element, " bytes");
    }
    // count is below 2^25 and stride below 2^8 here, so nothing overflows.
    const uint64_t needed = count ? stride * (count - 1) + element : 0;
    if (offset > view.size || needed > view.size - offset) {
        refuse(who, " reads ", needed, " bytes from ", offset, "; its buffer view has ", view.size);
    }
    return {view.data + offset, needed, stride};
}

double readComponent(const uint8_t* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            int8_t v;
            std::memcpy(&v, at, 1);
            return normalized ? std::max(v / 127.0, -1.0) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? *at / 255.0 : *at;
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            int16_t v;
            std::memcpy(&v, at, 2);
            return normalized ? std::max(v / 32767.0, -1.0) : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
            uint16_t v;
            std::memcpy(&v, at, 2);
            return normalized ? v / 65535.0 : v;
        }
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
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

void checkNesting(std::span<const uint8_t> json) {
    constexpr int kDeepest = 64;
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const uint8_t c = json[i];
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

std::span<const uint8_t> checkGlb(std::span<const uint8_t> bytes) {
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
    const uint64_t next = 20 + (jsonSize + 3) / 4 * 4;
    if (next + 8 <= length) {
        const uint64_t binarySize = little32(&bytes[next]);
        if (next + 8 + binarySize > length) {
            refuse("the GLB's binary chunk is ", binarySize, " bytes; ", length - next - 8,
                   " are left");
        }
    }
    return bytes.subspan(20, jsonSize);
}

Bytes viewBytes(const tinygltf::Model& model, int index, const std::string& who) {
    if (index < 0 || static_cast<size_t>(index) >= model.bufferViews.size()) {
        refuse(who, ".bufferView is ", index, "; there are ", model.bufferViews.size());
    }
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(index)];
    const std::string name = text("bufferViews[", index, "]");
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model.buffers.size()) {
        refuse(name, ".buffer is ", view.buffer, "; there are ", model.buffers.size());
    }
    const std::vector<unsigned char>& buffer = model.buffers[static_cast<size_t>(view.buffer)].data;
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
        refuse(name, " is ", view.byteLength, " bytes from ", view.byteOffset, "; buffers[",
               view.buffer, "] has ", buffer.size());
    }
    if (view.byteStride > 255)
        refuse(name, ".byteStride is ", view.byteStride, "; 252 is the most");
    return {buffer.data() + view.byteOffset, view.byteLength, view.byteStride};
}

Values readAccessor(const tinygltf::Model& model, int index, const std::string& who) {
    if (index < 0 || static_cast<size_t>(index) >= model.accessors.size()) {
        refuse(who, " is accessor ", index, "; there are ", model.accessors.size());
    }
    const tinygltf::Accessor& accessor = model.accessors[static_cast<size_t>(index)];
    const std::string name = text("accessors[", index, "] (", who, ")");
    const uint64_t size = componentSize(accessor.componentType);
    if (size == 0) refuse(name, ".componentType is ", accessor.componentType, ", which is unknown");
    Values values;
    values.count = accessor.count;
    values.components = componentCount(accessor.type);
    if (values.components == 0) refuse(name, ".type is neither SCALAR nor VEC2 to VEC4");
    if (values.count == 0) refuse(name, ".count is 0; 1 is the least");
    if (values.count > 4 * kMaxVertices) {
        refuse(name, ".count is ", values.count, "; the limit is ", 4 * kMaxVertices);
    }
    const uint64_t element = size * values.components;
    values.data.assign(values.count * values.components, 0.0);
    auto readInto = [&](double* to, const uint8_t* from) {
        for (uint64_t c = 0; c < values.components; ++c) {
            to[c] = readComponent(from + c * size, accessor.componentType, accessor.normalized);
        }
    };
    if (accessor.bufferView >= 0) {
        const Bytes bytes = rangeBytes(viewBytes(model, accessor.bufferView, name),
                                       accessor.byteOffset, values.count, element, name);
        for (uint64_t i = 0; i < values.count; ++i) {
            readInto(&values.data[i * values.components], bytes.data + i * bytes.stride);
        }
    } else if (!accessor.sparse.isSparse) {
        refuse(name, " has neither a bufferView nor sparse values");
    }
    if (!accessor.sparse.isSparse) return values;

    const auto& sparse = accessor.sparse;
    if (sparse.count < 1 || static_cast<uint64_t>(sparse.count) > values.count) {
        refuse(name, ".sparse.count is ", sparse.count, "; it goes from 1 to ", values.count);
    }
    const int indexType = sparse.indices.componentType;
    if (indexType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        indexType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        indexType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        refuse(name, ".sparse.indices.componentType is ", indexType, "; 5121, 5123, 5125 are read");
    }
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
        refuse(name, ".sparse has a negative byteOffset");
    }
    const auto count = static_cast<uint64_t>(sparse.count);
    const Bytes places =
        rangeBytes(viewBytes(model, sparse.indices.bufferView, name + ".sparse.indices"),
                   static_cast<uint64_t>(sparse.indices.byteOffset), count,
                   componentSize(indexType), name + ".sparse.indices");
    const Bytes replacements = rangeBytes(
        viewBytes(model, sparse.values.bufferView, name + ".sparse.values"),
        static_cast<uint64_t>(sparse.values.byteOffset), count, element, name + ".sparse.values");
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
