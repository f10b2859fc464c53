// Materials of a glTF file as ours: base colours, their pictures and how those lie on the surface.
// Other properties of a material go to the notes.
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

// glTF's numbers for what is beyond a picture's edge.
constexpr int64_t kRepeat = 10497, kClamp = 33071, kMirror = 33648;

// How a material's picture is laid on.
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

    // Into ImportedModel::materials, for one of the file's; -1: glTF's default. Decodes its picture
    // the first time.
    uint32_t indexOf(int material);
    [[nodiscard]] const TextureUse& use(uint32_t index) const { return uses_[index]; }
    // All pictures repeat here. Pictures that the file clamps or mirrors beyond their edge are laid
    // out as far as the surfaces reach, and the model's UVs with them.
    void unwrapPictures();
    // Notes what is wrong with pictures that nothing above used.
    void noteUnusedImages();

 private:
    void readMaterial(const Field& from, ImportedMaterial& material, TextureUse& use);
    void readSpecularGlossiness(const Field& from, ImportedMaterial& material, TextureUse& use);
    void readAlpha(const Field& from, ImportedMaterial& material);
    void noteChannels(const Field& from, bool glossy);
    void readTransform(const Field& info, TextureUse& use) const;
    void readSampler(const Field& texture, TextureUse& use);
    // The picture of a texture reference, or -1 with a note: no reason to refuse a mesh.
    int32_t textureImage(const Field& info, TextureUse& use);
    int32_t imageIndex(int image, std::string& error);
    bool decode(int image, DecodedImage& decoded, std::string& error);
    // False: all pictures together would be too large; `error` says so.
    bool reserveBytes(uint64_t bytes, std::string& error);

    GltfFile& file_;
    ImportedModel& model_;
    Notes& notes_;
    std::map<int, uint32_t> materials_;
    std::map<int, int32_t> images_;
    std::map<int, std::string> imageErrors_;
    std::set<int> reflections_;  // images that are read for the colour of metals alone
    std::vector<TextureUse> uses_;
    uint64_t pictureBytes_ = 0;
};

}  // namespace fwimport
