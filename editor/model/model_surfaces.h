// Appearance of an imported model, and the material slot of each triangle. A burnable mesh has
// eight slots, eight images and vertex colours; a file may have any number of materials.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flamewright/flamewright.h"
#include "import/gltf_import.h"

namespace fwmodel {

constexpr size_t kSlots = 8;  // size of FwBurnableMeshDef::materials and baseColors

struct SlotPicture {
    int32_t image = -1;     // into ImportedModel::images; -1: none
    float alphaCutoff = 0;  // as in FwImageDef, [0, 1]; 0: opaque image
    bool operator==(const SlotPicture&) const = default;
};

struct ModelSurfaces {
    std::vector<uint8_t> slots;              // by ImportedModel::materials
    std::vector<uint8_t> triangleMaterials;  // slot by triangle
    std::array<SlotPicture, kSlots> pictures;
    uint32_t slotCount = 1;        // number of used slots: [0, slotCount)
    std::vector<uint32_t> colors;  // RGBA8 linear per vertex; empty: the file has no colour, so the
                                   // material's base colour shows
    bool twoSided = false;         // cut-outs or open sheets are visible from both sides
    std::vector<std::string> notes;  // approximations, with reasons

    [[nodiscard]] bool ownColors() const { return !colors.empty(); }
};

// Assigns up to eight materials a slot each. Beyond that, equal appearances share a slot, then
// equal images. Images without a slot become their mean colour, with a note.
ModelSurfaces surfacesOf(const fwimport::ImportedModel& model);

// Points into both arguments. Size and density of the burn map keep their defaults.
FwMeshDef meshDefOf(const fwimport::ImportedModel& model, const ModelSurfaces& surfaces);
// Returns a preset. `ownColors`: base colour 1, so that the file's colours show while unburnt.
FwMaterialDef materialDefOf(uint32_t preset, bool ownColors);
// Geometry for shadows: the model's triangles. Triangles with cut-outs contribute their opaque
// parts, at the resolution of a soft shadow.
struct SolidTriangles {
    std::vector<float> positions;   // 3 per vertex, m
    std::vector<uint32_t> indices;  // 3 per triangle
};
SolidTriangles solidTrianglesOf(const fwimport::ImportedModel& model,
                                const ModelSurfaces& surfaces);
// For a slot with an image; points into `model`.
FwImageDef imageDefOf(const fwimport::ImportedModel& model, const SlotPicture& picture);

}  // namespace fwmodel
