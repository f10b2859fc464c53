// The mesh that a sample burns: any mesh, placed on the studio's floor, with its colours, ray
// queries and a cached burn map.
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
    fwimport::ImportedModel model;  // m, on y = 0 and centred on the vertical axis unless loaded
                                    // with `asItStands`
    fwmodel::ModelSurfaces surfaces;
    float scale = 1.0f;    // applied to the file's units
    float size() const;    // m, largest side
    float height() const;  // m
    float radius() const;  // m, bounding sphere
};

// Loads `file`, or the wooden toy if it is empty. `asItStands`: keeps position and scale. Throws
// sample::Failure with the importer's message.
Subject loadSubject(const std::filesystem::path& file, float wantedSize, bool asItStands = false);

struct SurfacePoint {
    glm::vec3 position{0}, normal{0};
    bool hit = false;
};
// Returns the first hit of a ray.
SurfacePoint castRay(const Subject& subject, glm::vec3 origin, glm::vec3 direction);
// Returns a low point that faces the viewer, as the place to ignite.
SurfacePoint findIgnitionPoint(const Subject& subject, glm::vec3 eye);

// Returns a camera around the subject's centre that shows all of it with a margin. Angles in
// degrees.
sample::OrbitCamera orbitAround(const Subject& subject, float yaw, float pitch, VkExtent2D picture);

struct BurnMapRequest {
    uint32_t mapSize = 1024;  // texels
    float texelsPerMetre = 256.0f;
    std::filesystem::path cache;  // folder; empty: no cache
};
// Bakes the burn map, or reads it from the cache. `note` reports which.
FwMeshId createMesh(sample::FireHost& fire, const Subject& subject, const BurnMapRequest& request,
                    std::string& note);
