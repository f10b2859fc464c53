// glTF files of boards in a row, one per material, with PNG images, for tests of imported colours.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace fwtest {

using Pixel = std::array<uint8_t, 4>;  // sRGB, straight alpha

// RGBA8, uncompressed.
inline std::vector<uint8_t> pngOf(uint32_t width, uint32_t height,
                                  const std::function<Pixel(uint32_t x, uint32_t y)>& pixelAt) {
    std::vector<uint8_t> raw;
    for (uint32_t y = 0; y < height; ++y) {
        raw.push_back(0);  // no filter
        for (uint32_t x = 0; x < width; ++x)
            for (const uint8_t byte : pixelAt(x, y)) raw.push_back(byte);
    }
    const auto big = [](std::vector<uint8_t>& to, uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8)
            to.push_back(static_cast<uint8_t>(value >> shift));
    };
    std::vector<uint8_t> packed = {0x78, 0x01};
    uint32_t a = 1, b = 0;
    for (const uint8_t byte : raw) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    for (size_t at = 0; at < raw.size(); at += 65535) {
        const size_t count = std::min<size_t>(65535, raw.size() - at);
        const bool last = at + count == raw.size();
        for (const size_t value :
             {size_t{last}, count & 255, count >> 8, ~count & 255, (~count >> 8) & 255})
            packed.push_back(static_cast<uint8_t>(value));
        packed.insert(packed.end(), raw.begin() + static_cast<std::ptrdiff_t>(at),
                      raw.begin() + static_cast<std::ptrdiff_t>(at + count));
    }
    big(packed, b << 16 | a);
    std::vector<uint8_t> file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    const auto chunk = [&](const std::string& type, const std::vector<uint8_t>& data) {
        big(file, static_cast<uint32_t>(data.size()));
        const size_t from = file.size();
        file.insert(file.end(), type.begin(), type.end());
        file.insert(file.end(), data.begin(), data.end());
        uint32_t crc = 0xffffffffu;
        for (size_t i = from; i < file.size(); ++i) {
            crc ^= file[i];
            for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
        big(file, ~crc);
    };
    std::vector<uint8_t> header;
    big(header, width);
    big(header, height);
    header.insert(header.end(), {8, 6, 0, 0, 0});
    chunk("IHDR", header);
    chunk("IDAT", packed);
    chunk("IEND", {});
    return file;
}

struct BoardMaterial {
    std::array<float, 3> factor{1, 1, 1};
    std::vector<uint8_t> png;  // empty: no image
    std::string more;  // JSON added to the material, with its comma: ",\"alphaMode\":\"MASK\""
    std::string name;
};

// Upright boards of 0.2 x 0.6 m, 0.25 m apart along x, facing +z. `grid`: quads along each side of
// the last one. `ofNode`: JSON added to the node, with its comma. `leans`: two joints carry each
// board, and the upper one leans left by 40 degrees, in an armature of twice the size. Writes
// NAME.gltf, NAME.bin and its images.
inline void writeBoardRow(const std::filesystem::path& folder, const std::string& name,
                          const std::vector<BoardMaterial>& materials, uint32_t grid = 1,
                          const std::string& ofNode = "", bool leans = false) {
    std::vector<float> data;
    std::vector<uint32_t> indices;
    std::string views, accessors, primitives, texts, images, textures;
    const auto comma = [](std::string& text) -> std::string& {
        if (!text.empty()) text += ",";
        return text;
    };
    size_t bytes = 0, count = 0, pictures = 0;
    std::ofstream bin(folder / (name + ".bin"), std::ios::binary);
    const auto add = [&](const void* from, size_t size, const std::string& accessor) {
        bin.write(static_cast<const char*>(from), static_cast<std::streamsize>(size));
        comma(views) += "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes) +
                        ",\"byteLength\":" + std::to_string(size) + "}";
        comma(accessors) += "{\"bufferView\":" + std::to_string(count) + "," + accessor + "}";
        bytes += size;
        return count++;
    };
    for (size_t k = 0; k < materials.size(); ++k) {
        const uint32_t n = (k + 1 == materials.size() ? grid : 1) + 1;
        std::vector<float> places, uvs;
        indices.clear();
        for (uint32_t y = 0; y < n; ++y)
            for (uint32_t x = 0; x < n; ++x) {
                const float u = static_cast<float>(x) / static_cast<float>(n - 1);
                const float v = static_cast<float>(y) / static_cast<float>(n - 1);
                places.insert(places.end(),
                              {0.25f * static_cast<float>(k) + 0.2f * u, 0.6f * v, 0});
                uvs.insert(uvs.end(), {u, 1 - v});
                if (x + 1 == n || y + 1 == n) continue;
                const uint32_t at = y * n + x;
                for (const uint32_t i : {at, at + 1, at + n + 1, at, at + n + 1, at + n})
                    indices.push_back(i);
            }
        const float left = places[0], right = places[places.size() - 3];
        const std::string many = "\"count\":" + std::to_string(size_t{n} * n);
        const size_t position =
            add(places.data(), places.size() * 4,
                "\"componentType\":5126,\"type\":\"VEC3\"," + many + ",\"min\":[" +
                    std::to_string(left) + ",0,0],\"max\":[" + std::to_string(right) + ",0.6,0]");
        const size_t uv =
            add(uvs.data(), uvs.size() * 4, "\"componentType\":5126,\"type\":\"VEC2\"," + many);
        const size_t index = add(indices.data(), indices.size() * 4,
                                 "\"componentType\":5125,\"type\":\"SCALAR\",\"count\":" +
                                     std::to_string(indices.size()));
        std::string attributes;
        if (leans) {
            std::vector<uint8_t> joints;
            std::vector<float> weights;
            for (size_t i = 0; i < places.size(); i += 3) {
                const float upper = places[i + 1] / 0.6f;
                joints.insert(joints.end(), {0, 1, 0, 0});
                weights.insert(weights.end(), {1 - upper, upper, 0, 0});
            }
            const size_t joint = add(joints.data(), joints.size(),
                                     "\"componentType\":5121,\"type\":\"VEC4\"," + many);
            const size_t weight = add(weights.data(), weights.size() * 4,
                                      "\"componentType\":5126,\"type\":\"VEC4\"," + many);
            attributes = ",\"JOINTS_0\":" + std::to_string(joint) +
                         ",\"WEIGHTS_0\":" + std::to_string(weight);
        }
        comma(primitives) += "{\"attributes\":{\"POSITION\":" + std::to_string(position) +
                             ",\"TEXCOORD_0\":" + std::to_string(uv) + attributes +
                             "},\"indices\":" + std::to_string(index) +
                             ",\"material\":" + std::to_string(k) + "}";
        const BoardMaterial& material = materials[k];
        std::string text = "\"metallicFactor\":0,\"baseColorFactor\":[";
        for (const float channel : material.factor) text += std::to_string(channel) + ",";
        text += "1]";
        if (!material.png.empty()) {
            const std::string file = name + std::to_string(k) + ".png";
            std::ofstream(folder / file, std::ios::binary)
                .write(reinterpret_cast<const char*>(material.png.data()),
                       static_cast<std::streamsize>(material.png.size()));
            text += ",\"baseColorTexture\":{\"index\":" + std::to_string(pictures) + "}";
            comma(images) += "{\"uri\":\"" + file + "\"}";
            comma(textures) += "{\"source\":" + std::to_string(pictures++) + "}";
        }
        comma(texts) += "{\"name\":\"" + material.name + "\",\"pbrMetallicRoughness\":{" + text +
                        "}" + material.more + "}";
    }
    std::ofstream file(folder / (name + ".gltf"));
    // A skinned mesh follows its joints and ignores its own node's transform.
    const std::string ofMesh = leans ? ",\"skin\":0,\"translation\":[7,7,7]" : "";
    const std::string joints = leans ? ",{\"scale\":[2,2,2],\"children\":[2]},{\"children\":[3]},"
                                       "{\"rotation\":[0,0,0.342020,0.939693]}"
                                     : "";
    file << "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":["
         << (leans ? "0,1" : "0") << "]}],\"nodes\":[{\"mesh\":0" << ofMesh << ofNode << "}"
         << joints << "],\"meshes\":[{\"primitives\":[" << primitives << "]}],\"accessors\":["
         << accessors << "],\"bufferViews\":[" << views << "],\"buffers\":[{\"uri\":\"" << name
         << ".bin\",\"byteLength\":" << bytes << "}]";
    if (!images.empty()) file << ",\"images\":[" << images << "],\"textures\":[" << textures << "]";
    if (leans) file << ",\"skins\":[{\"joints\":[2,3]}]";
    file << ",\"materials\":[" << texts << "]}";
}

inline std::vector<uint8_t> plainPng(uint8_t r, uint8_t g, uint8_t b, uint8_t alpha = 255) {
    return pngOf(8, 8, [=](uint32_t, uint32_t) { return Pixel{r, g, b, alpha}; });
}

// Nine leaves (green discs) of 64 x 64 pixels in three rows; transparent pixels are black.
inline std::vector<uint8_t> leavesPng() {
    return pngOf(192, 192, [](uint32_t x, uint32_t y) {
        const float dx = static_cast<float>(x % 64) - 31.5f,
                    dy = static_cast<float>(y % 64) - 31.5f;
        const bool there = dx * dx + dy * dy < 24 * 24;
        return there ? Pixel{40, 150, 30, 255} : Pixel{0, 0, 0, 0};
    });
}

}  // namespace fwtest
