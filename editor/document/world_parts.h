// The objects of a scene as definitions of the plugin, kind by kind; burn.cpp puts them together.
#pragma once

#include "document/burn.h"

namespace fwedit {

constexpr double kWateringStep = 0.125;  // s, between what rain and water add
constexpr float kMostPower = 100000;     // kW, of a flame, an emitter
constexpr float kMostWind = 120;         // m/s, of each of its parts

// Empty if the result is fine, else the plugin's own words.
std::string worldProblem(const Burn& burn, FwResult result);

// The scenes here are placed ones, see scene.h.
FwWorldDef worldDefOf(const Scene& scene);
// Jets and emitters have room for the most that their keys ask for.
FwFireEmitterDef jetDefOf(const Scene& scene, const HeatSource& source);
FwFireEmitterDef emitterDefOf(const Scene& scene, const Emitter& emitter);
FwVolumetricFireDef fireDefOf(const Scene& scene, const Flame& flame);
// The flames of a source: one, or for a line as many as it is long.
std::vector<FwVolumetricFireDef> sourceFiresOf(const Scene& scene, const HeatSource& source);
FwBurnableMeshDef burnableDefOf(const Mesh& mesh);
FwFireColliderDef colliderDefOf(const Scene& scene, const Collider& collider);
// Of a wind that has a zone, as strong as `factor` says.
FwWindZoneDef windZoneDefOf(const Scene& scene, const Wind& wind, float factor);
FwBlockerDef blockerDefOf(const Scene& scene, const Collider& collider);
// The texels of a cooked burn map; `slots`: material by triangle of the model.
bool surfaceOfBake(FwContext* context, const std::vector<char>& bake,
                   const fwimport::ImportedModel& model, const std::vector<uint8_t>& slots,
                   PaintSurface& surface, std::string& error);

}  // namespace fwedit
