// See mesh_codecs.h. FW_IMPORT_DRACO and FW_IMPORT_MESHOPT say what the build has.
#include "import/mesh_codecs.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "import/gltf_import.h"
#include "import/gltf_json.h"

#if FW_IMPORT_DRACO
#include <draco/compression/decode.h>
#endif
#if FW_IMPORT_MESHOPT
#include <meshoptimizer.h>
#endif

namespace fwimport {

bool readsDraco() { return FW_IMPORT_DRACO; }
bool readsMeshopt() { return FW_IMPORT_MESHOPT; }

#if FW_IMPORT_DRACO

namespace {

double rangeOf(draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return 127;
        case draco::DT_UINT8:
            return 255;
        case draco::DT_INT16:
            return 32767;
        case draco::DT_UINT16:
            return 65535;
        default:
            return 1;
    }
}

}  // namespace

DracoMesh readDraco(std::span<const uint8_t> bytes,
                    const std::map<std::string, DracoAttribute>& attributes,
                    const std::string& name) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) refuse(name, ": its Draco data cannot be decoded");
    const draco::Mesh& mesh = *decoded.value();
    if (mesh.num_points() > kMaxVertices || mesh.num_faces() > kMaxTriangles)
        refuse(name, ": its Draco data holds ", mesh.num_points(), " vertices and ",
               mesh.num_faces(), " triangles; the limits are ", kMaxVertices, " and ",
               kMaxTriangles);
    DracoMesh result;
    result.points = mesh.num_points();
    for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
        for (const draco::PointIndex& corner : mesh.face(i))
            result.indices.push_back(corner.value());
    for (const auto& [key, wanted] : attributes) {
        const draco::PointAttribute* from =
            wanted.id < 0 || wanted.id > UINT32_MAX
                ? nullptr
                : mesh.GetAttributeByUniqueId(static_cast<uint32_t>(wanted.id));
        if (!from) refuse(name, ".", key, " is attribute ", wanted.id, ", which its data lacks");
        Values values;
        values.count = result.points;
        values.components = static_cast<uint64_t>(from->num_components());
        if (values.components < 1 || values.components > 16)
            refuse(name, ".", key, " has ", values.components, " components");
        values.data.resize(values.count * values.components);
        const bool scaled = wanted.normalized && !from->normalized();
        const double range = scaled ? rangeOf(from->data_type()) : 1;
        for (uint32_t i = 0; i < mesh.num_points(); ++i) {
            double* to = &values.data[i * values.components];
            if (!from->ConvertValue<double>(from->mapped_index(draco::PointIndex(i)),
                                            static_cast<int8_t>(values.components), to))
                refuse(name, ".", key, " cannot be read from its Draco data");
            if (!scaled) continue;
            for (uint64_t c = 0; c < values.components; ++c) to[c] = std::max(to[c] / range, -1.0);
        }
        result.attributes[key] = std::move(values);
    }
    return result;
}

#else

DracoMesh readDraco(std::span<const uint8_t>, const std::map<std::string, DracoAttribute>&,
                    const std::string& name) {
    refuse(name,
           " is compressed with Draco (KHR_draco_mesh_compression), which this build does "
           "not read",
           kConvertMesh);
}

#endif

#if FW_IMPORT_MESHOPT

namespace {

// The COLOR filter of KHR_meshopt_compression, which the library lacks before version 0.23: luma
// and two chroma differences, scaled by the alpha's highest bit.
template <typename Signed, typename Unsigned>
void decodeColor(Unsigned* data, uint64_t count) {
    const auto most = static_cast<float>(static_cast<Unsigned>(~Unsigned{0}));
    for (uint64_t i = 0; i < count; ++i, data += 4) {
        int scale = data[3];
        for (const int shift : {1, 2, 4, 8}) scale |= scale >> shift;
        const int luma = data[0], orange = static_cast<Signed>(data[1]);
        const int green = static_cast<Signed>(data[2]);
        const int alpha = (data[3] << 1 & scale) | (data[3] & 1);
        const int values[4] = {luma + orange - green, luma + green, luma - orange - green, alpha};
        for (int c = 0; c < 4; ++c) {
            const float value =
                static_cast<float>(values[c]) * most / static_cast<float>(std::max(scale, 1));
            data[c] = static_cast<Unsigned>(std::lround(std::clamp(value, 0.0f, most)));
        }
    }
}

}  // namespace

std::vector<uint8_t> readMeshopt(std::span<const uint8_t> bytes, const MeshoptView& view,
                                 const std::string& name) {
    const uint64_t count = view.count, stride = view.stride;
    if (count > 4 * kMaxVertices)
        refuse(name, ".count is ", count, "; the limit is ", 4 * kMaxVertices);
    const bool attributes = view.mode == "ATTRIBUTES";
    if (attributes ? stride < 4 || stride > 256 || stride % 4 != 0 : stride != 2 && stride != 4)
        refuse(name, ".byteStride is ", stride, "; ", view.mode, " takes ",
               attributes ? "a multiple of 4 up to 256" : "2 or 4");
    // The decoder reads whole blocks. Compression is at most 1000:1.
    if (count * stride / 4096 > bytes.size() + 1)
        refuse(name, " makes ", count * stride, " bytes of ", bytes.size(), ", which is absurd");
    std::vector<uint8_t> out(count * stride);
    int failure = 0;
    if (attributes) {
        failure = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    } else if (view.mode == "TRIANGLES") {
        if (count % 3 != 0) refuse(name, ".count is ", count, "; TRIANGLES takes a multiple of 3");
        failure = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    } else if (view.mode == "INDICES") {
        failure =
            meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(), bytes.size());
    } else {
        refuse(name, ".mode is \"", view.mode.substr(0, 40),
               "\"; ATTRIBUTES, TRIANGLES and INDICES exist");
    }
    if (failure)
        refuse(name,
               ": its meshopt data cannot be decoded (it is damaged, or of a later version "
               "than the library reads)",
               kConvertMesh);
    const std::string& filter = view.filter;
    const auto needs = [&](bool good, const char* takes) {
        if (!attributes || !good)
            refuse(name, ".filter ", filter, " takes ATTRIBUTES and a byteStride of ", takes);
    };
    if (filter == "OCTAHEDRAL") {
        needs(stride == 4 || stride == 8, "4 or 8");
        meshopt_decodeFilterOct(out.data(), count, stride);
    } else if (filter == "QUATERNION") {
        needs(stride == 8, "8");
        meshopt_decodeFilterQuat(out.data(), count, stride);
    } else if (filter == "EXPONENTIAL") {
        needs(true, "4 to 256");
        meshopt_decodeFilterExp(out.data(), count, stride);
    } else if (filter == "COLOR") {
        needs(stride == 4 || stride == 8, "4 or 8");
        if (stride == 4) decodeColor<int8_t>(out.data(), count);
        if (stride == 8) {
            std::vector<uint16_t> wide(count * 4);
            std::memcpy(wide.data(), out.data(), out.size());
            decodeColor<int16_t>(wide.data(), count);
            std::memcpy(out.data(), wide.data(), out.size());
        }
    } else if (filter != "NONE") {
        refuse(name, ".filter is \"", filter.substr(0, 40),
               "\"; NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL and COLOR exist");
    }
    return out;
}

#else

std::vector<uint8_t> readMeshopt(std::span<const uint8_t>, const MeshoptView&,
                                 const std::string& name) {
    refuse(name, " is compressed with meshoptimizer, which this build does not read", kConvertMesh);
}

#endif

}  // namespace fwimport
