// The bunny as one burnable of a world on its own device, lit at its side, and pictures of it.
// Shared by deform_bench, surface_bench and selfcross_bench. Needs FLAMEWRIGHT_ASSETS.
#pragma once
#include "bench/bench_device.h"
#include "flamewright/flamewright.h"
#include "support/meshes.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cstring>
#include <string>
#include <vector>

namespace fw::test {

struct BunnyScene {
    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    FwBurnableMeshId object{};
    std::string error;

    BunnyScene() = default;
    BunnyScene(const BunnyScene&) = delete;
    BunnyScene& operator=(const BunnyScene&) = delete;
    ~BunnyScene() {
        fwDestroyWorld(world);
        fwDestroyContext(context);
    }

    // Returns null on success. `worldDef` without flames.
    const char* make(const char* file, uint32_t flags, FwWorldDef worldDef) {
        fw::test::Mesh mesh;
        if (!fw::test::loadGlb(file, mesh, error)) return error.c_str();
        const FwContextDef contextDef = fwDefaultContextDef();
        FwErrorInfo info{};
        if (fwCreateContext(&contextDef, &context, &info) != FW_OK) {
            error = info.message;
            return error.c_str();
        }
        worldDef.maxFlames = 0;
        FwMeshDef meshDef = fwDefaultMeshDef();
        meshDef.positions = mesh.positions.data();
        meshDef.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
        meshDef.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
        meshDef.indices = mesh.indices.data();
        meshDef.vertexCount = mesh.vertexCount();
        meshDef.indexCount = uint32_t(mesh.indices.size());
        FwBurnableMeshDef objectDef = fwDefaultBurnableMeshDef();
        objectDef.flags = flags;
        const FwPin pin = {{0, 0.9f, 0}, {0, 0.9f, 0}, 0.1f, 0};
        objectDef.pins = &pin;
        objectDef.pinCount = 1;
        const FwMaterialDef pine = fwDefaultMaterialDef();
        if (fwCreateWorld(context, &worldDef, &world) != FW_OK ||
            fwWorld_CreateMesh(world, &meshDef, &objectDef.mesh) != FW_OK ||
            fwWorld_CreateMaterial(world, &pine, &objectDef.materials[0]) != FW_OK ||
            fwWorld_CreateBurnableMesh(world, &objectDef, &object) != FW_OK)
            return "the scene cannot be made";
        return nullptr;
    }
    void light() const {
        FwIgnitionDef match = fwDefaultIgnitionDef();
        match.position[0] = -0.3f;
        match.position[1] = 0.3f;
        match.position[2] = 0.3f;
        match.radius = 0.2f;
        fwWorld_Ignite(world, &match, nullptr);
    }
    const char* burnUntil(float fraction) const {
        light();
        for (int i = 0; i < 200; ++i) {
            fwWorld_Step(world, 0.5f);
            FwObjectState state{};
            state.structSize = sizeof state;
            fwWorld_GetObjectState(world, object, &state);
            if (state.burntFraction >= fraction) return nullptr;
        }
        return "the bunny does not burn";
    }
};

// 1280 x 720, the bunny covers some 30 % of it.
struct BunnyPicture {
    static constexpr uint32_t kWidth = 1280, kHeight = 720;
    std::vector<uint8_t> pixels;
    FwOffscreenDef shot = fwDefaultOffscreenDef();

    BunnyPicture() : pixels(size_t{kWidth} * kHeight * 4) {
        shot.width = kWidth;
        shot.height = kHeight;
        shot.pixels = pixels.data();
        shot.view = fwDefaultView();
        const glm::mat4 look =
            glm::lookAt(glm::vec3(-0.5f, 0.7f, 1.85f), glm::vec3(0, 0.5f, 0), glm::vec3(0, 1, 0));
        glm::mat4 projection(0.0f);
        projection[0][0] = 3.4f * kHeight / kWidth;
        projection[1][1] = -3.4f;
        projection[2][2] = projection[2][3] = -1.0f;
        projection[3][2] = -0.05f;
        std::memcpy(shot.view.view, glm::value_ptr(look), sizeof shot.view.view);
        std::memcpy(shot.view.projection, glm::value_ptr(projection), sizeof shot.view.projection);
    }
    BunnyPicture(const BunnyPicture&) = delete;
    BunnyPicture& operator=(const BunnyPicture&) = delete;

    struct Cost {
        double wall = 0, cpu = 0;  // s
    };
    // Submits a step of `seconds` and a picture, and waits.
    Cost take(const BunnyScene& scene, bool hidden, float seconds = 0, bool stepCounts = false) {
        fwWorld_SetHidden(scene.world, scene.object, hidden);
        if (!stepCounts) fwWorld_Step(scene.world, seconds);
        const Clock::time_point start = Clock::now();
        const double cpu = cpuSeconds();
        if (stepCounts) fwWorld_Step(scene.world, seconds);
        fwWorld_RenderOffscreen(scene.world, &shot);
        return {secondsSince(start), cpuSeconds() - cpu};
    }
    [[nodiscard]] double covered() const {
        size_t sum = 0;
        for (size_t i = 0; i < pixels.size(); i += 4) sum += pixels[i] != 0;
        return double(sum) / (kWidth * kHeight);
    }
};

}  // namespace fw::test
