// See model_surfaces.h.
#include "model/model_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>

namespace fwmodel {
namespace {

using fwimport::ImportedMaterial;
using fwimport::ImportedModel;

struct Appearance {
    SlotPicture picture;
    glm::vec3 factor{1};
    bool operator==(const Appearance&) const = default;
};

Appearance appearanceOf(const ImportedMaterial& material) {
    Appearance result;
    result.factor = {material.baseColor[0], material.baseColor[1], material.baseColor[2]};
    result.picture.image = material.image;
    // The file's cut-off applies to the product of image and factor alpha.
    if (material.image >= 0 && material.alphaMode == fwimport::AlphaMode::Mask)
        result.picture.alphaCutoff =
            std::clamp(material.alphaCutoff / std::max(material.baseColor[3], 1e-3f), 0.0f, 1.0f);
    return result;
}

std::string nameOf(const ImportedModel& model, size_t material) {
    const std::string& name = model.materials[material].name;
    return name.empty() ? "material " + std::to_string(material + 1) : "\"" + name + "\"";
}

// Linear mean of up to 65,536 pixels spread over the image, without holes.
glm::vec3 meanColor(const fwimport::DecodedImage& image, float alphaCutoff) {
    std::array<double, 256> linear{};
    for (size_t i = 0; i < linear.size(); ++i) linear[i] = fwimport::toLinear(double(i) / 255);
    const size_t count = image.rgba.size() / 4;
    size_t step = std::max<size_t>(1, count / 65536);
    // Coprime to the width, so that every column is sampled.
    while (step > 1 && std::gcd(step, size_t{image.width}) != 1) ++step;
    glm::dvec3 sum(0);
    size_t taken = 0;
    for (size_t i = 0; i < count; i += step) {
        const uint8_t* pixel = &image.rgba[i * 4];
        if (static_cast<float>(pixel[3]) < alphaCutoff * 255) continue;
        for (int c = 0; c < 3; ++c) sum[c] += linear[pixel[c]];
        ++taken;
    }
    return taken == 0 ? glm::vec3(1) : glm::vec3(sum / static_cast<double>(taken));
}

// Assigns each material the first slot that `share` accepts, otherwise a new one. Returns the
// number of slots.
template <typename Share>
size_t groupMaterials(const std::vector<Appearance>& appearances, std::vector<size_t>& groups,
                      Share&& share) {
    std::vector<size_t> first;  // first material of each slot
    groups.resize(appearances.size());
    for (size_t i = 0; i < appearances.size(); ++i) {
        const auto same = std::find_if(first.begin(), first.end(), [&](size_t other) {
            return share(appearances[i], appearances[other]);
        });
        groups[i] = static_cast<size_t>(same - first.begin());
        if (same == first.end()) first.push_back(i);
    }
    return first.size();
}

// Seven images keep a slot, cut-outs first; everything else shares the last slot.
void foldPictures(const ImportedModel& model, std::vector<Appearance>& appearances,
                  std::vector<size_t>& groups, size_t count, std::vector<std::string>& notes) {
    std::vector<SlotPicture> pictures(count);
    for (size_t i = 0; i < appearances.size(); ++i) pictures[groups[i]] = appearances[i].picture;
    std::vector<size_t> order(count), slots(count, kSlots - 1);
    std::iota(order.begin(), order.end(), size_t{0});
    const auto rank = [&](size_t group) {
        return pictures[group].image < 0 ? 2 : pictures[group].alphaCutoff > 0 ? 0 : 1;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return rank(a) < rank(b); });
    for (size_t i = 0; i + 1 < kSlots; ++i)
        if (pictures[order[i]].image >= 0) slots[order[i]] = i;

    constexpr size_t kNamed = 8;
    std::string names;
    size_t lost = 0;
    bool holes = false;
    std::vector<std::pair<SlotPicture, glm::vec3>> means;
    for (size_t i = 0; i < appearances.size(); ++i) {
        groups[i] = slots[groups[i]];
        SlotPicture& picture = appearances[i].picture;
        if (groups[i] != kSlots - 1 || picture.image < 0) continue;
        auto mean = std::find_if(means.begin(), means.end(),
                                 [&](const auto& known) { return known.first == picture; });
        if (mean == means.end())
            mean = means.insert(
                means.end(), {picture, meanColor(model.images[static_cast<size_t>(picture.image)],
                                                 picture.alphaCutoff)});
        appearances[i].factor *= mean->second;
        holes = holes || picture.alphaCutoff > 0;
        picture = {};
        if (++lost <= kNamed) names += (lost > 1 ? ", " : "") + nameOf(model, i);
    }
    if (lost > kNamed) names += " and " + std::to_string(lost - kNamed) + " more";
    notes.push_back(
        "a burnable mesh shows at most 8 pictures, or 7 beside plain colours; the file has " +
        std::to_string(model.images.size()) +
        ". Each of these materials shows its picture's mean colour instead" +
        (holes ? ", without cut-outs: " : ": ") + names +
        ". To keep them, split the file or put pictures together");
}

// Returns vertex colours multiplied by their material's colour.
std::vector<uint32_t> colorsOf(const ImportedModel& model,
                               const std::vector<Appearance>& appearances) {
    std::vector<uint32_t> colors = model.colors;
    colors.resize(model.vertexCount(), 0xffffffffu);
    std::vector<bool> done(model.vertexCount(), false);
    for (size_t i = 0; i < model.indices.size(); ++i) {
        const uint32_t vertex = model.indices[i];
        if (done[vertex]) continue;
        done[vertex] = true;
        const glm::vec3& factor = appearances[model.triangleMaterials[i / 3]].factor;
        uint32_t packed = 0xff000000u;
        for (int c = 0; c < 3; ++c) {
            const auto own = static_cast<float>(colors[vertex] >> (8 * c) & 255);
            packed |= static_cast<uint32_t>(std::lround(std::clamp(factor[c] * own, 0.0f, 255.0f)))
                      << (8 * c);
        }
        colors[vertex] = packed;
    }
    return colors;
}

// Returns true if the double-sided surfaces are open sheets instead of parts of a closed surface:
// their rims are long relative to their area. A rim is an edge of one triangle only; equal
// positions count as one corner.
bool areOpenSheets(const ImportedModel& model) {
    const auto isDoubleSided = [&](uint32_t i) { return model.materials[i].doubleSided; };
    if (std::ranges::none_of(model.triangleMaterials, isDoubleSided)) return false;
    const auto at = [&](uint32_t vertex) {
        const float* place = &model.positions[size_t{vertex} * 3];
        return glm::dvec3(place[0], place[1], place[2]);
    };
    std::vector<uint32_t> order(model.vertexCount()), corners(order.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](uint32_t vertex) {
        const glm::dvec3 place = at(vertex);
        return std::array{place.x, place.y, place.z};
    });
    for (size_t i = 0; i < order.size(); ++i)
        corners[order[i]] =
            i > 0 && at(order[i]) == at(order[i - 1]) ? corners[order[i - 1]] : order[i];
    std::vector<uint64_t> edges;
    double area = 0, rim = 0;
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        if (!isDoubleSided(model.triangleMaterials[i / 3])) continue;
        const uint32_t* triangle = &model.indices[i];
        const glm::dvec3 first = at(triangle[0]);
        area += 0.5 * glm::length(glm::cross(at(triangle[1]) - first, at(triangle[2]) - first));
        for (size_t k = 0; k < 3; ++k) {
            const uint64_t a = corners[triangle[k]], b = corners[triangle[(k + 1) % 3]];
            edges.push_back(std::min(a, b) << 32 | std::max(a, b));
        }
    }
    std::ranges::sort(edges);
    for (size_t i = 0; i < edges.size(); ++i)
        if ((i == 0 || edges[i - 1] != edges[i]) &&
            (i + 1 == edges.size() || edges[i + 1] != edges[i]))
            rim += glm::distance(at(uint32_t(edges[i] >> 32)), at(uint32_t(edges[i])));
    return rim * rim > area;
}

}  // namespace

ModelSurfaces surfacesOf(const ImportedModel& model) {
    ModelSurfaces result;
    std::vector<Appearance> appearances;
    bool gray = true;
    result.twoSided = areOpenSheets(model);
    for (size_t i = 0; i < model.materials.size(); ++i) {
        const ImportedMaterial& material = model.materials[i];
        appearances.push_back(appearanceOf(material));
        const bool cutOut = appearances.back().picture.alphaCutoff > 0;
        result.twoSided = result.twoSided || (cutOut && material.doubleSided);
        const glm::vec3& factor = appearances.back().factor;
        gray = gray && factor[0] == factor[1] && factor[1] == factor[2];
    }
    const bool colored = !gray || model.hasColors || !model.images.empty();

    std::vector<size_t> groups(appearances.size());
    std::iota(groups.begin(), groups.end(), size_t{0});
    size_t count = appearances.size();
    if (count > kSlots) count = groupMaterials(appearances, groups, std::equal_to<>());
    if (count > kSlots)
        count = groupMaterials(appearances, groups, [](const Appearance& a, const Appearance& b) {
            return a.picture == b.picture;
        });
    if (count > kSlots) {
        foldPictures(model, appearances, groups, count, result.notes);
        count = kSlots;
    } else if (appearances.size() > kSlots) {
        result.notes.push_back("a burnable mesh has 8 material slots; the file's " +
                               std::to_string(appearances.size()) + " materials share " +
                               std::to_string(count) + ", by appearance");
    }
    result.slotCount = static_cast<uint32_t>(std::max<size_t>(1, count));
    for (size_t i = 0; i < groups.size(); ++i) {
        result.slots.push_back(static_cast<uint8_t>(groups[i]));
        result.pictures[groups[i]] = appearances[i].picture;
    }
    result.triangleMaterials.reserve(model.triangleCount());
    for (const uint32_t material : model.triangleMaterials)
        result.triangleMaterials.push_back(result.slots[material]);
    if (colored) result.colors = colorsOf(model, appearances);
    return result;
}

FwMeshDef meshDefOf(const ImportedModel& model, const ModelSurfaces& surfaces) {
    FwMeshDef def = fwDefaultMeshDef();
    def.positions = model.positions.data();
    def.normals = model.hasNormals ? model.normals.data() : nullptr;
    // Parts without UVs need none for an image.
    def.uvs = model.hasUvs || !model.images.empty() ? model.uvs.data() : nullptr;
    def.colors = surfaces.ownColors() ? surfaces.colors.data() : nullptr;
    def.indices = model.indices.data();
    def.triangleMaterials = surfaces.triangleMaterials.data();
    def.vertexCount = static_cast<uint32_t>(model.vertexCount());
    def.indexCount = static_cast<uint32_t>(model.indices.size());
    return def;
}

FwMaterialDef materialDefOf(uint32_t preset, bool ownColors) {
    FwMaterialDef def = fwDefaultMaterialDef();
    fwInitMaterialPreset(&def, preset);
    if (ownColors)
        for (float& channel : def.baseColor) channel = 1;
    return def;
}

namespace {

// Samples whether the image is opaque at a point. UVs repeat.
bool isThere(const fwimport::DecodedImage& image, float alphaCutoff, glm::vec2 uv) {
    const glm::vec2 turn = uv - glm::floor(uv);
    const auto pixel = [](float share, uint32_t side) {
        return std::min(static_cast<size_t>(share * static_cast<float>(side)), size_t{side} - 1);
    };
    const size_t at = pixel(turn.y, image.height) * image.width + pixel(turn.x, image.width);
    return static_cast<float>(image.rgba[at * 4 + 3]) >= alphaCutoff * 255;
}

// Splits each side of a triangle into `parts` and adds the opaque sub-triangles.
void addParts(const ImportedModel& model, const SlotPicture& picture, size_t triangle, int parts,
              SolidTriangles& result) {
    const auto& image = model.images[static_cast<size_t>(picture.image)];
    glm::vec3 places[3];
    glm::vec2 uvs[3];
    for (size_t k = 0; k < 3; ++k) {
        const size_t vertex = model.indices[triangle * 3 + k];
        for (int c = 0; c < 3; ++c)
            places[k][c] = model.positions[vertex * 3 + static_cast<size_t>(c)];
        uvs[k] = {model.uvs[vertex * 2], model.uvs[vertex * 2 + 1]};
    }
    const auto add = [&](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        const auto mix = [&](const auto(&of)[3], glm::vec2 at) {
            return of[0] + (of[1] - of[0]) * at.x + (of[2] - of[0]) * at.y;
        };
        const auto steps = static_cast<float>(parts);
        const glm::vec2 corners[3] = {glm::vec2(a) / steps, glm::vec2(b) / steps,
                                      glm::vec2(c) / steps};
        const glm::vec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
        if (!isThere(image, picture.alphaCutoff, mix(uvs, middle))) return;
        for (const glm::vec2& corner : corners) {
            const glm::vec3 p = mix(places, corner);
            result.indices.push_back(static_cast<uint32_t>(result.positions.size() / 3));
            result.positions.insert(result.positions.end(), {p.x, p.y, p.z});
        }
    };
    for (int i = 0; i < parts; ++i)
        for (int j = 0; i + j < parts; ++j) {
            add({i, j}, {i + 1, j}, {i, j + 1});
            if (i + j + 1 < parts) add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
        }
}

}  // namespace

SolidTriangles solidTrianglesOf(const ImportedModel& model, const ModelSurfaces& surfaces) {
    constexpr size_t kMostParts = 1u << 20;
    const auto pictureOf = [&](size_t triangle) {
        return surfaces.pictures[surfaces.triangleMaterials[triangle]];
    };
    size_t cutOut = 0;
    for (size_t t = 0; t < model.triangleCount(); ++t) cutOut += pictureOf(t).alphaCutoff > 0;
    int parts = 24;
    while (parts > 1 && cutOut * static_cast<size_t>(parts * parts) > kMostParts) --parts;
    SolidTriangles result{model.positions, {}};
    for (size_t t = 0; t < model.triangleCount(); ++t) {
        if (pictureOf(t).alphaCutoff > 0) {
            addParts(model, pictureOf(t), t, parts, result);
            continue;
        }
        const auto from = model.indices.begin() + static_cast<std::ptrdiff_t>(t * 3);
        result.indices.insert(result.indices.end(), from, from + 3);
    }
    return result;
}

FwImageDef imageDefOf(const ImportedModel& model, const SlotPicture& picture) {
    const fwimport::DecodedImage& image = model.images[static_cast<size_t>(picture.image)];
    FwImageDef def = fwDefaultImageDef();
    def.width = image.width;
    def.height = image.height;
    def.pixels = image.rgba.data();
    def.alphaCutoff = picture.alphaCutoff;
    return def;
}

}  // namespace fwmodel
