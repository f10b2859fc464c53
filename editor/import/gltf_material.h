// Converts glTF materials: base colours, their images and texture transforms. Unsupported
// properties become notes.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "import/gltf_access.h"
#include "import/gltf_import.h"

namespace fwimport {

// glTF's constants for wrap modes.
constexpr int64_t kRepeat = 10497, kClamp = 33071, kMirror = 33648;

// Texture transform and sampling of a material's image.
struct TextureUse {
    int64_t texCoord = 0;
    glm::dvec2 offset{0}, scale{1};
    double rotation = 0;  // rad
    bool transformed = false;
    std::array<int64_t, 2> wrap{kRepeat, kRepeat};
    std::string sampler;  // "samplers[0]", for notes

    [[nodiscard]] glm::dvec2 apply(glm::dvec2 uv) const;
};

class Materials {
 public:
    Materials(GltfFile& file, ImportedModel& model, Notes& notes)
        : file_(file), model_(model), notes_(notes) {}

    // Returns the index in ImportedModel::materials for a file material; -1: glTF's default.
    // Decodes its image on first use.
    uint32_t indexOf(int material);
    [[nodiscard]] const TextureUse& use(uint32_t index) const { return uses_[index]; }
    // Makes all images tile. Clamped or mirrored images are extended as far as the UVs reach, and
    // the UVs are adjusted.
    void unwrapPictures();
    // Adds notes about broken images that no material used.
    void noteUnusedImages();

 private:
    void readMaterial(const Field& from, ImportedMaterial& material, TextureUse& use);
    void readSpecularGlossiness(const Field& from, ImportedMaterial& material, TextureUse& use);
    void readAlpha(const Field& from, ImportedMaterial& material);
    void noteChannels(const Field& from, bool glossy);
    void readTransform(const Field& info, TextureUse& use) const;
    void readSampler(const Field& texture, TextureUse& use);
    // Returns the image of a texture reference, or -1 with a note. The mesh still loads without it.
    int32_t textureImage(const Field& info, TextureUse& use);
    int32_t imageIndex(int image, std::string& error);
    bool decode(int image, DecodedImage& decoded, std::string& error);

    GltfFile& file_;
    ImportedModel& model_;
    Notes& notes_;
    std::map<int, uint32_t> materials_;
    std::map<int, int32_t> images_;
    std::map<int, std::string> imageErrors_;
    std::map<int32_t, bool> holes_;  // of images of the model
    std::set<int> reflections_;      // images used only for metal colours
    std::vector<TextureUse> uses_;
};

}  // namespace fwimport
