// What is going to burn: a mesh of any size brought onto the studio's floor, with its colours,
// the answers about its surface that the sample needs, and its burn map from the cache.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "common/fire_host.h"
#include "import/gltf_import.h"
#include "model/model_surfaces.h"

struct Subject {
    std::string name;
    fwimport::ImportedModel model;  // m, standing on y = 0, centred on the vertical axis unless it
                                    // was left as it stands
    fwmodel::ModelSurfaces surfaces;
    float scale = 1.0f;    // that was applied to the file's units
    float size() const;    // m, largest side
    float height() const;  // m
    float radius() const;  // m, of the ball around its middle
};

// `file` empty: the wooden toy. `asItStands`: neither moved nor scaled. Throws sample::Failure with
// the importer's message.
Subject loadSubject(const std::filesystem::path& file, float wantedSize, bool asItStands = false);

struct SurfacePoint {
    glm::vec3 position{0}, normal{0};
    bool hit = false;
};
// Where a ray meets it first.
SurfacePoint castRay(const Subject& subject, glm::vec3 origin, glm::vec3 direction);
// A low place that faces the viewer: where one would hold the match.
SurfacePoint matchPlace(const Subject& subject, glm::vec3 eye);

// Around its middle, as far off as shows all of it with a margin. Yaw and pitch in degrees.
sample::OrbitCamera orbitAround(const Subject& subject, float yaw, float pitch, VkExtent2D picture);

struct BurnMapRequest {
    uint32_t mapSize = 1024;  // texels
    float texelsPerMetre = 256.0f;
    std::filesystem::path cache;  // folder; empty: do not keep
};
// Bakes, or reads what an earlier run baked for the same arrays. `note` says which.
FwMeshId createMesh(sample::FireHost& fire, const Subject& subject, const BurnMapRequest& request,
                    std::string& note);
