// A folder, a script host in it and a burnable file: the fixture of the editor tests.
#pragma once

#include "script/script.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace fwtest {

using namespace fwedit;
namespace fs = std::filesystem;

// A folder with "board.glb": an upright board, 1 m wide, 0.4 m tall, 2 cm thick, lower edge at y =
// 0, and a second, separate board behind it. On its front a node "hook" that looks along x, and a
// "wick" 0.1 m above it.
struct Yard {
    fs::path folder;
    std::vector<std::string> said;
    std::unique_ptr<ScriptHost> host;

    Yard() {
        static int number = 0;
        folder = fs::temp_directory_path() /
                 ("fw_yard_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
        fs::create_directories(folder);
        writeBoards();
        host = std::make_unique<ScriptHost>(folder);
        host->say = [this](const std::string& line) { said.push_back(line); };
    }
    ~Yard() {
        host = nullptr;
        fs::remove_all(folder);
    }
    void run(const std::string& lines) {
        std::istringstream stream(lines);
        std::string line, error;
        while (std::getline(stream, line))
            ASSERT_TRUE(runScriptLine(*host, line, error)) << line << "\n  " << error;
    }
    // The message of a line that must fail.
    std::string fails(const std::string& line) {
        std::string error;
        EXPECT_FALSE(runScriptLine(*host, line, error)) << line;
        return error;
    }
    std::string why(const std::string& line) {
        said.clear();
        run(line);
        return said.empty() ? "" : said[0];
    }

 private:
    void writeBoards() const {
        std::vector<float> positions;
        std::vector<uint16_t> indices;
        for (int board = 0; board < 2; ++board)
            for (int face = 0; face < 6; ++face) {
                const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
                const float half[3] = {0.5f, 0.2f, 0.01f}, middle[3] = {0, 0.2f, board * -0.5f};
                const float side = face & 1 ? 1.0f : -1.0f;
                const auto base = static_cast<uint16_t>(positions.size() / 3);
                for (int c = 0; c < 4; ++c) {
                    float p[3];
                    p[axis] = middle[axis] + side * half[axis];
                    p[u] = middle[u] + ((c == 1 || c == 2) ? side : -side) * half[u];
                    p[v] = middle[v] + (c >= 2 ? 1.0f : -1.0f) * half[v];
                    positions.insert(positions.end(), p, p + 3);
                }
                for (const int i : {0, 1, 2, 0, 2, 3})
                    indices.push_back(static_cast<uint16_t>(base + i));
            }
        const size_t bytes = positions.size() * 4;
        std::string json =
            R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)"
            R"({"mesh":0,"name":"boards","children":[1]},{"name":"hook","translation":[0.4,0.2,0.02],)"
            R"("rotation":[0,0.70710678,0,0.70710678],"children":[2]},)"
            R"({"name":"wick","translation":[0,0.1,0],"scale":[2,2,2]}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
            R"("buffers":[{"byteLength":)" +
            std::to_string(bytes + indices.size() * 2) + R"(}],"bufferViews":[{"buffer":0,)" +
            R"("byteOffset":0,"byteLength":)" + std::to_string(bytes) +
            R"(},{"buffer":0,"byteOffset":)" + std::to_string(bytes) + R"(,"byteLength":)" +
            std::to_string(indices.size() * 2) +
            R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":)" +
            std::to_string(positions.size() / 3) +
            R"(,"type":"VEC3","min":[-0.5,0,-0.51],"max":[0.5,0.4,0.01]},)" +
            R"({"bufferView":1,"componentType":5123,"count":)" + std::to_string(indices.size()) +
            R"(,"type":"SCALAR"}]})";
        while (json.size() % 4) json += ' ';
        std::ofstream file(folder / "board.glb", std::ios::binary);
        const auto word = [&](size_t value) {
            const auto v = static_cast<uint32_t>(value);
            file.write(reinterpret_cast<const char*>(&v), 4);
        };
        const size_t body = bytes + indices.size() * 2;
        word(0x46546c67);
        word(2);
        word(28 + json.size() + body);
        word(json.size());
        word(0x4e4f534a);
        file.write(json.data(), static_cast<std::streamsize>(json.size()));
        word(body);
        word(0x004e4942);
        file.write(reinterpret_cast<const char*>(positions.data()),
                   static_cast<std::streamsize>(bytes));
        file.write(reinterpret_cast<const char*>(indices.data()),
                   static_cast<std::streamsize>(indices.size() * 2));
    }
};

// The paper board, lit at its left end.
inline constexpr const char* kBoard =
    "import board.glb name=Board materials paper map_size 128 texels_per_metre 64\n"
    "set settings pace 20 duration 20 frames_per_second 8 radiation no plume no contact no "
    "embers no\n"
    "add source match name=Match position -0.5 0.2 0 radius 0.04\n";

}  // namespace fwtest
