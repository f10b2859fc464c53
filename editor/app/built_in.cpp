// See built_in.h.
#include "app/built_in.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "shell/icons.h"

namespace fwapp {
namespace {

namespace icons = fwui::icons;

constexpr BuiltIn kScenes[] = {
    {"Burning crate", "Start here: a match and a crate", icons::crate},
    {"Campfire", "A flame of its own, by night", icons::firepit},
    {"Hand torch", "A small flame in the wind", icons::srcJet},
    {"Bonfire", "Tall, with smoke and sparks", icons::flame},
    {"Candle", "The smallest flame", icons::bolt},
    {"Rune fire", "Its own colours, not a real glow", icons::star},
};

// Commands that build each scene; see document/command.h.
constexpr const char* kLines[][6] = {
    {"set settings duration 40", "set settings pace 12",
     "add source match name=\"Match\" position 0.14 0.12 0.26 radius 0.03",
     "set camera target 0 0.24 0 distance 1.7 yaw 28 pitch 16", nullptr, nullptr},
    {"set settings daylight night", "add flame name=\"Campfire\" preset camp diameter 0.6 power 60",
     "set camera target 0 0.5 0 distance 2.8 yaw 20 pitch 8", nullptr, nullptr, nullptr},
    {"set settings daylight night wind 2 0 0",
     "add flame name=\"Torch\" preset torch position 0 0.5 0 diameter 0.12 power 8",
     "set camera target 0.08 0.63 0 distance 1.15 yaw 15 pitch 4", nullptr, nullptr, nullptr},
    {"set settings daylight night",
     "add flame name=\"Bonfire\" preset bonfire diameter 1.4 power 600",
     "add emitter disc name=\"Sparks\" radius 0.5 power 200 sparks 0.4 smoke 0.2",
     "set camera target 0 1.3 0 distance 7 yaw 20 pitch 6", nullptr, nullptr},
    {"set settings daylight night",
     "add flame name=\"Candle\" preset candle position 0 0.1 0 diameter 0.012 power 0.08",
     "set camera target 0 0.127 0 distance 0.2 yaw 10 pitch 4", nullptr, nullptr, nullptr},
    {"set settings daylight night",
     "add flame name=\"Rune fire\" preset magic_blue diameter 0.5 power 45",
     "set camera target 0 0.42 0 distance 2.3 yaw 20 pitch 7", nullptr, nullptr, nullptr},
};

struct Solid {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
};

// Counter-clockwise from outside; each face has its own corners.
void addBoard(Solid& solid, std::array<float, 3> low, std::array<float, 3> high) {
    for (uint32_t face = 0; face < 6; ++face) {
        const uint32_t x = face / 2, y = (x + 1) % 3, z = (x + 2) % 3;
        const bool front = face & 1;
        const auto first = uint32_t(solid.positions.size() / 3);
        for (uint32_t corner = 0; corner < 4; ++corner) {
            std::array<float, 3> p{}, n{};
            p[x] = front ? high[x] : low[x];
            p[y] = (corner == 1 || corner == 2) ? high[y] : low[y];
            p[z] = corner >= 2 ? high[z] : low[z];
            n[x] = front ? 1.0f : -1.0f;
            solid.positions.insert(solid.positions.end(), p.begin(), p.end());
            solid.normals.insert(solid.normals.end(), n.begin(), n.end());
        }
        for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u})
            solid.indices.push_back(first + (front ? k
                                                   : (k == 0   ? 0
                                                      : k == 1 ? 2
                                                      : k == 2 ? 1
                                                               : k)));
        if (!front) {  // flip the second triangle too
            const size_t end = solid.indices.size();
            solid.indices[end - 6] = first;
            solid.indices[end - 5] = first + 2;
            solid.indices[end - 4] = first + 1;
            solid.indices[end - 3] = first;
            solid.indices[end - 2] = first + 3;
            solid.indices[end - 1] = first + 2;
        }
    }
}

std::string base64(const std::vector<uint8_t>& bytes) {
    constexpr const char* kLetters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = bytes.size() - i;
        const uint32_t three = uint32_t(bytes[i]) << 16 |
                               (left > 1 ? uint32_t(bytes[i + 1]) << 8 : 0) |
                               (left > 2 ? uint32_t(bytes[i + 2]) : 0);
        for (uint32_t k = 0; k < 4; ++k)
            text += k <= left ? kLetters[three >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace

std::span<const BuiltIn> builtIns() { return kScenes; }

std::string crateGltf() {
    constexpr float kHalf = 0.25f, kThick = 0.018f, kGap = 0.002f, kBatten = 0.055f;
    constexpr int kBoards = 5;
    Solid solid;
    const float board = 2 * kHalf / kBoards;
    for (int i = 0; i < kBoards; ++i) {  // boards of the walls, floor and lid
        const float a = -kHalf + board * float(i) + kGap, b = a + board - 2 * kGap;
        const float low = a + kHalf, high = b + kHalf;
        addBoard(solid, {-kHalf, low, kHalf - kThick}, {kHalf, high, kHalf});
        addBoard(solid, {-kHalf, low, -kHalf}, {kHalf, high, -kHalf + kThick});
        addBoard(solid, {-kHalf, low, -kHalf + kThick}, {-kHalf + kThick, high, kHalf - kThick});
        addBoard(solid, {kHalf - kThick, low, -kHalf + kThick}, {kHalf, high, kHalf - kThick});
        addBoard(solid, {a, 2 * kHalf, -kHalf}, {b, 2 * kHalf + kThick, kHalf});
    }
    const float out = kHalf + kThick;
    for (const float side : {-1.0f, 1.0f}) {  // battens around the edges of front and back
        const float z0 = side > 0 ? kHalf : -out, z1 = side > 0 ? out : -kHalf;
        addBoard(solid, {-kHalf, 0, z0}, {-kHalf + kBatten, 2 * kHalf, z1});
        addBoard(solid, {kHalf - kBatten, 0, z0}, {kHalf, 2 * kHalf, z1});
        addBoard(solid, {-kHalf + kBatten, 0, z0}, {kHalf - kBatten, kBatten, z1});
        addBoard(solid, {-kHalf + kBatten, 2 * kHalf - kBatten, z0},
                 {kHalf - kBatten, 2 * kHalf, z1});
        const float x0 = side > 0 ? kHalf : -out, x1 = side > 0 ? out : -kHalf;
        addBoard(solid, {x0, 0, -out}, {x1, 2 * kHalf, -out + kBatten});
        addBoard(solid, {x0, 0, out - kBatten}, {x1, 2 * kHalf, out});
    }
    std::vector<uint8_t> bytes;
    auto append = [&](const auto& values) {
        const size_t at = bytes.size(), size = values.size() * sizeof values[0];
        bytes.resize(at + size);
        std::memcpy(bytes.data() + at, values.data(), size);
        return size;
    };
    const size_t positions = append(solid.positions), normals = append(solid.normals);
    const size_t indices = append(solid.indices), vertices = solid.positions.size() / 3;
    std::array<float, 3> low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
    for (size_t i = 0; i < solid.positions.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], solid.positions[i]);
        high[i % 3] = std::max(high[i % 3], solid.positions[i]);
    }
    std::ostringstream text;
    text << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
         << R"("nodes":[{"name":"Crate","mesh":0}],"meshes":[{"name":"Crate","primitives":[)"
         << R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"material":0}]}],)"
         << R"("materials":[{"name":"Pine","pbrMetallicRoughness":{"metallicFactor":0}}],)"
         << R"("buffers":[{"byteLength":)" << bytes.size()
         << R"(,"uri":"data:application/octet-stream;base64,)" << base64(bytes) << R"("}],)"
         << R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << positions
         << R"(},{"buffer":0,"byteOffset":)" << positions << R"(,"byteLength":)" << normals
         << R"(},{"buffer":0,"byteOffset":)" << positions + normals << R"(,"byteLength":)"
         << indices
         << R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)"
         << vertices << R"(,"min":[)" << low[0] << "," << low[1] << "," << low[2] << R"(],"max":[)"
         << high[0] << "," << high[1] << "," << high[2]
         << R"(]},{"bufferView":1,"componentType":5126,"type":"VEC3","count":)" << vertices
         << R"(},{"bufferView":2,"componentType":5125,"type":"SCALAR","count":)"
         << solid.indices.size() << "}]}\n";
    return text.str();
}

bool makeBuiltIn(int which, const std::filesystem::path& folder, fwedit::Document& document,
                 std::string& error) {
    if (which < 0 || size_t(which) >= std::size(kScenes)) {
        error = "There is no such scene.";
        return false;
    }
    document = fwedit::newDocument();
    if (which == 0) {
        const std::filesystem::path file = folder / "crate.gltf";
        std::ofstream out(file);
        out << crateGltf();
        out.close();
        if (!out.good()) {
            error = file.string() + " cannot be written.";
            return false;
        }
        if (!fwedit::runLine(document, "import \"" + file.string() + "\" name=\"Crate\"", error))
            return false;
    }
    for (const char* line : kLines[which])
        if (line && !fwedit::runLine(document, line, error)) return false;
    fwedit::resetHistory(document);  // the history starts here
    return true;
}

}  // namespace fwapp
