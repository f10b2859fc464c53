// Converts the objects of a scene to definitions of the plugin, kind by kind; burn.cpp combines
// them.
#pragma once

#include "document/burn.h"

namespace fwedit {

constexpr double kWateringStep = 0.125;  // s, between two amounts of rain and water
constexpr float kMaxPower = 100000;      // kW, limit of a flame or emitter
constexpr float kMaxWind = 120;          // m/s, limit per component

// Returns an empty string on success, otherwise the plugin's message.
std::string worldProblem(const Burn& burn, FwResult result);

// All scenes here are placed scenes, see scene.h.
FwWorldDef worldDefOf(const Scene& scene);
// Jets and emitters have capacity for the peak of their keys.
FwFireEmitterDef jetDefOf(const Scene& scene, const HeatSource& source);
FwFireEmitterDef emitterDefOf(const Scene& scene, const Emitter& emitter);
FwVolumetricFireDef fireDefOf(const Scene& scene, const Flame& flame);
// Returns the flames of a source: one, or several along a line.
std::vector<FwVolumetricFireDef> sourceFiresOf(const Scene& scene, const HeatSource& source);
FwBurnableMeshDef burnableDefOf(const Mesh& mesh);
FwFireColliderDef colliderDefOf(const Scene& scene, const Collider& collider);
// Returns the zone of a wind, scaled by `factor`.
FwWindZoneDef windZoneDefOf(const Scene& scene, const Wind& wind, float factor);
FwHeatOccluderDef heatOccluderDefOf(const Scene& scene, const Collider& collider);
// Reads the texels of a cooked burn map. `slots`: material per triangle of the model.
bool surfaceOfBake(FwContext* context, const std::vector<char>& bake,
                   const fwimport::ImportedModel& model, const std::vector<uint8_t>& slots,
                   PaintSurface& surface, std::string& error);

}  // namespace fwedit
