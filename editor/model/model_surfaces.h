// Appearance of an imported model, and of which material slot each triangle is: a burnable mesh has
// eight slots, eight pictures, and a colour for each vertex; a file has as many as it likes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flamewright/flamewright.h"
#include "import/gltf_import.h"

namespace fwmodel {

constexpr size_t kSlots = 8;  // of FwBurnableMeshDef::materials and baseColors

struct SlotPicture {
    int32_t image = -1;     // into ImportedModel::images; -1: none
    float alphaCutoff = 0;  // as FwImageDef's, [0, 1]; 0: the picture is opaque
    bool operator==(const SlotPicture&) const = default;
};

struct ModelSurfaces {
    std::vector<uint8_t> slots;              // by ImportedModel::materials
    std::vector<uint8_t> triangleMaterials;  // slot by triangle
    std::array<SlotPicture, kSlots> pictures;
    uint32_t slotCount = 1;          // slots that triangles use: [0, slotCount)
    std::vector<uint32_t> colors;    // RGBA8 linear by vertex; empty: the file says no colour, and
                                     // the material's own base colour shows
    bool twoSided = false;           // cut-outs or open sheets are to be seen from both sides
    std::vector<std::string> notes;  // what is shown otherwise than the file says, and why

    [[nodiscard]] bool ownColors() const { return !colors.empty(); }
};

// Up to eight materials have a slot each. Of more, those that look alike share one, then those that
// share a picture; pictures for which no slot is left show their mean colour, and a note names
// them.
ModelSurfaces surfacesOf(const fwimport::ImportedModel& model);

// Points into both. Its burn map's size and density are the defaults.
FwMeshDef meshDefOf(const fwimport::ImportedModel& model, const ModelSurfaces& surfaces);
// A preset. Where the file has colours the base colour is 1: unburnt, the file's colours show.
FwMaterialDef materialDefOf(uint32_t preset, bool ownColors);
// Geometry that casts a shadow: the model's triangles, and of those with cut-outs parts that are
// there, as fine as a soft shadow shows them.
struct SolidTriangles {
    std::vector<float> positions;   // 3 per vertex, m
    std::vector<uint32_t> indices;  // 3 per triangle
};
SolidTriangles solidTrianglesOf(const fwimport::ImportedModel& model,
                                const ModelSurfaces& surfaces);
// Of a slot with a picture; points into `model`.
FwImageDef imageDefOf(const fwimport::ImportedModel& model, const SlotPicture& picture);

}  // namespace fwmodel
