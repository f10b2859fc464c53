#include "import/gltf_material.h"

#include <algorithm>
#include <cmath>

namespace fwimport {
namespace {

constexpr const char* kOwnShine = "is left out: the burn material defines the gloss";

double unit(double value, double otherwise) {
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
}

void readColor(const std::vector<double>& from, std::array<float, 4>& to) {
    for (size_t i = 0; i < from.size() && i < 4; ++i) to[i] = static_cast<float>(unit(from[i], 1));
}

double brightness(const glm::dvec3& c) { return 0.299 * c.x + 0.587 * c.y + 0.114 * c.z; }

// Returns how metallic a specular-glossiness surface is, [0, 1]. Metals are black in diffuse light
// and have coloured reflections.
double metalShare(const glm::dvec3& diffuse, const glm::dvec3& specular) {
    const double dark = std::clamp(1 - 10 * brightness(diffuse), 0.0, 1.0);
    return dark * std::clamp((brightness(specular) - 0.04) / 0.06, 0.0, 1.0);
}

// Returns true if the image has both transparent and opaque parts.
bool hasHoles(const DecodedImage& image) {
    bool hole = false, solid = false;
    for (size_t i = 3; i < image.rgba.size() && !(hole && solid); i += 4)
        (image.rgba[i] < 128 ? hole : solid) = true;
    return hole && solid;
}

// Adds metal colours to the diffuse image where it is dark.
void addMetal(DecodedImage& diffuse, const std::array<float, 4>& factor,
              const DecodedImage& specular, const glm::dvec3& specularFactor) {
    std::array<double, 256> linear;
    for (size_t i = 0; i < 256; ++i) linear[i] = toLinear(double(i) / 255);
    for (uint32_t y = 0; y < diffuse.height; ++y) {
        for (uint32_t x = 0; x < diffuse.width; ++x) {
            uint8_t* to = &diffuse.rgba[(size_t{y} * diffuse.width + x) * 4];
            const size_t column = size_t{x} * specular.width / diffuse.width;
            const size_t row = size_t{y} * specular.height / diffuse.height;
            const uint8_t* from = &specular.rgba[(row * specular.width + column) * 4];
            glm::dvec3 base, metal;
            for (int c = 0; c < 3; ++c) {
                base[c] = linear[to[c]] * double(factor[size_t(c)]);
                metal[c] = linear[from[c]] * specularFactor[c];
            }
            const double share = metalShare(base, metal);
            if (share <= 0) continue;
            for (int c = 0; c < 3; ++c) {
                const double wanted = glm::mix(base[c], metal[c], share);
                const double stored = toSrgb(wanted / std::max(double(factor[size_t(c)]), 1e-3));
                to[c] = static_cast<uint8_t>(std::lround(255 * std::clamp(stored, 0.0, 1.0)));
            }
        }
    }
}

}  // namespace

glm::dvec2 TextureUse::apply(glm::dvec2 uv) const {
    if (!transformed) return uv;
    const double cosine = std::cos(rotation), sine = std::sin(rotation);
    uv *= scale;
    return glm::dvec2(cosine * uv.x + sine * uv.y, cosine * uv.y - sine * uv.x) + offset;
}

uint32_t Materials::indexOf(int index) {
    if (const auto found = materials_.find(index); found != materials_.end()) return found->second;
    ImportedMaterial material;
    TextureUse use;
    if (index >= 0)
        readMaterial(file_.item("materials", index), material, use);
    else
        material.name = "default";
    const auto result = static_cast<uint32_t>(model_.materials.size());
    model_.materials.push_back(material);
    uses_.push_back(use);
    materials_[index] = result;
    return result;
}

void Materials::readMaterial(const Field& from, ImportedMaterial& material, TextureUse& use) {
    material.name = from.string("name");
    material.doubleSided = from.flag("doubleSided", false);
    const bool glossy = from.extension("KHR_materials_pbrSpecularGlossiness").present();
    if (glossy) {
        readSpecularGlossiness(from, material, use);
    } else if (const Field pbr = from.object("pbrMetallicRoughness"); pbr.present()) {
        readColor(pbr.numbers("baseColorFactor", 4), material.baseColor);
        material.roughness = static_cast<float>(unit(pbr.number("roughnessFactor", 1), 1));
        material.image = textureImage(pbr.object("baseColorTexture"), use);
    }
    readAlpha(from, material);
    noteChannels(from, glossy);
}

void Materials::readSpecularGlossiness(const Field& from, ImportedMaterial& material,
                                       TextureUse& use) {
    const Field glossy = from.extension("KHR_materials_pbrSpecularGlossiness");
    readColor(glossy.numbers("diffuseFactor", 4), material.baseColor);
    material.roughness = static_cast<float>(1 - unit(glossy.number("glossinessFactor", 1), 1));
    material.image = textureImage(glossy.object("diffuseTexture"), use);
    std::array<float, 4> specular{1, 1, 1, 1};
    const std::vector<double> factor = glossy.numbers("specularFactor", 3);
    readColor(factor, specular);
    const Field map = glossy.object("specularGlossinessTexture");
    // A file without specular values has no metal.
    if (factor.empty() && !map.present()) return;
    const glm::dvec3 metal(specular[0], specular[1], specular[2]);
    if (material.image < 0) {
        const glm::dvec3 base(material.baseColor[0], material.baseColor[1], material.baseColor[2]);
        const double share = metalShare(base, metal);
        for (int c = 0; c < 3; ++c)
            material.baseColor[size_t(c)] = static_cast<float>(glm::mix(base[c], metal[c], share));
        return;
    }
    if (!map.present()) return;
    std::string error;
    const int texture = map.index("index", file_.count("textures"));
    if (texture < 0) return;
    const int image = file_.item("textures", texture).index("source", file_.count("images"));
    DecodedImage reflected;
    if (image < 0) return;
    reflections_.insert(image);
    if (!decode(image, reflected, error)) {
        notes_.add(text("images[", image, "] is left out: ", error));
        return;
    }
    const DecodedImage& plain = model_.images[static_cast<size_t>(material.image)];
    if (!file_.tryReserve(plain.rgba.size())) {
        notes_.leaveOut("colour of metals in specularGlossinessTexture", from.path());
        return;
    }
    DecodedImage mixed = plain;
    addMetal(mixed, material.baseColor, reflected, metal);
    if (mixed.rgba == plain.rgba) return;
    material.image = static_cast<int32_t>(model_.images.size());
    model_.images.push_back(std::move(mixed));
}

// Approximates alpha that a Mask cannot represent, with a note.
void Materials::readAlpha(const Field& from, ImportedMaterial& material) {
    const std::string mode = from.string("alphaMode", "OPAQUE");
    if (mode == "MASK") {
        material.alphaMode = AlphaMode::Mask;
        // Above 1, everything is cut out.
        material.alphaCutoff =
            static_cast<float>(std::clamp(from.number("alphaCutoff", 0.5), 0.0, 2.0));
    } else if (mode == "BLEND") {
        bool holes = false;
        if (material.image >= 0) {
            const auto [found, fresh] = holes_.try_emplace(material.image);
            if (fresh) found->second = hasHoles(model_.images[static_cast<size_t>(found->first)]);
            holes = found->second;
        }
        if (holes) material.alphaMode = AlphaMode::Mask;
        // Uses the holes of the image, independent of the overall alpha.
        material.alphaCutoff = 0.5f * std::max(material.baseColor[3], 1e-3f);
        notes_.leaveOut("alphaMode BLEND", from.path(),
                        holes ? "is shown as a cut-out at alpha 0.5" : "is shown opaque");
    } else if (mode != "OPAQUE") {
        notes_.add(text(from.path(), ".alphaMode is \"", mode.substr(0, 40),
                        "\", which glTF has not; it is shown opaque"));
    }
}

void Materials::noteChannels(const Field& from, bool glossy) {
    for (const char* name : {"normalTexture", "occlusionTexture", "emissiveTexture"})
        if (from.has(name)) notes_.leaveOut(name, from.path());
    const std::vector<double> glow = from.numbers("emissiveFactor", 3);
    if (std::any_of(glow.begin(), glow.end(), [](double value) { return value > 0; }))
        notes_.leaveOut("emissiveFactor", from.path());
    if (glossy) {
        const Field one = from.extension("KHR_materials_pbrSpecularGlossiness");
        if (one.has("glossinessFactor"))
            notes_.leaveOut("glossinessFactor", from.path(), kOwnShine);
        if (one.has("specularGlossinessTexture"))
            notes_.leaveOut("glossiness of specularGlossinessTexture", from.path());
        return;
    }
    const Field pbr = from.object("pbrMetallicRoughness");
    if (!pbr.present()) return;
    if (pbr.has("roughnessFactor")) notes_.leaveOut("roughnessFactor", from.path(), kOwnShine);
    if (pbr.has("metallicRoughnessTexture"))
        notes_.leaveOut("metallicRoughnessTexture", from.path());
    if (pbr.number("metallicFactor", 1) > 0)
        notes_.leaveOut("metallicFactor", from.path(), "is left out: no surface is shown as metal");
}

void Materials::readTransform(const Field& info, TextureUse& use) const {
    const Field transform = info.extension("KHR_texture_transform");
    if (!transform.present()) return;
    const auto pair = [&](const char* name, glm::dvec2 otherwise) {
        const std::vector<double> both = transform.numbers(name, 2);
        const bool good = both.size() == 2 && std::isfinite(both[0]) && std::isfinite(both[1]);
        return good ? glm::dvec2(both[0], both[1]) : otherwise;
    };
    use.transformed = true;
    use.offset = pair("offset", glm::dvec2(0));
    use.scale = pair("scale", glm::dvec2(1));
    use.rotation = transform.number("rotation", 0);
    if (!std::isfinite(use.rotation)) use.rotation = 0;
    use.texCoord = transform.integer("texCoord", use.texCoord);
}

void Materials::readSampler(const Field& texture, TextureUse& use) {
    const int index = texture.index("sampler", file_.count("samplers"));
    if (index < 0) return;
    const Field sampler = file_.item("samplers", index);
    use.sampler = sampler.path();
    for (size_t c = 0; c < 2; ++c) {
        const char* name = c == 0 ? "wrapS" : "wrapT";
        use.wrap[c] = sampler.integer(name, kRepeat);
        if (use.wrap[c] != kRepeat && use.wrap[c] != kClamp && use.wrap[c] != kMirror) {
            notes_.add(text(sampler.path(), ".", name, " is ", use.wrap[c],
                            ", which glTF has not; it is shown as REPEAT"));
            use.wrap[c] = kRepeat;
        }
    }
    for (const char* name : {"magFilter", "minFilter"}) {
        // NEAREST, and NEAREST of one level or between two.
        const int64_t filter = sampler.integer(name, 9729);
        if (filter == 9728 || filter == 9984 || filter == 9986)
            notes_.leaveOut(text(name, " NEAREST"), sampler.path(), "is shown as LINEAR");
    }
}

int32_t Materials::textureImage(const Field& info, TextureUse& use) {
    if (!info.present()) return -1;
    const int index = info.index("index", file_.count("textures"));
    if (index < 0) {
        notes_.leaveOut("picture without an index", info.path());
        return -1;
    }
    use.texCoord = info.integer("texCoord", 0);
    readTransform(info, use);
    const Field texture = file_.item("textures", index);
    readSampler(texture, use);
    const size_t images = file_.count("images");
    std::vector<int> candidates;  // use the first one that decodes
    for (const char* name : {"EXT_texture_webp", "MSFT_texture_dds"})
        candidates.push_back(texture.extension(name).index("source", images));
    candidates.push_back(texture.index("source", images));
    for (const char* name : {"EXT_texture_avif", "KHR_texture_basisu"})
        candidates.push_back(texture.extension(name).index("source", images));
    std::string why;
    for (const int image : candidates) {
        if (image < 0) continue;
        std::string error;
        if (const int32_t result = imageIndex(image, error); result >= 0) return result;
        why += text("\nimages[", image, "] is left out: ", error);
    }
    if (why.empty()) notes_.add(text(texture.path(), " has no image that can be read"));
    for (size_t from = 1; from < why.size();) {
        const size_t end = std::min(why.find('\n', from), why.size());
        notes_.add(why.substr(from, end - from));
        from = end + 1;
    }
    return -1;
}

int32_t Materials::imageIndex(int image, std::string& error) {
    if (const auto found = images_.find(image); found != images_.end()) {
        error = imageErrors_[image];
        return found->second;
    }
    int32_t result = -1;
    DecodedImage decoded;
    if (decode(image, decoded, error)) {
        result = static_cast<int32_t>(model_.images.size());
        model_.images.push_back(std::move(decoded));
    }
    imageErrors_[image] = error;
    return images_[image] = result;
}

bool Materials::decode(int index, DecodedImage& decoded, std::string& error) {
    const Field image = file_.item("images", index);
    try {
        std::vector<uint8_t> other;
        std::span<const uint8_t> bytes;
        if (image.has("bufferView")) {
            bytes = file_.view(image.integer("bufferView", -1), image.path()).span();
        } else if (image.has("uri")) {
            other = file_.uri(image.string("uri"), image.path() + ".uri");
            bytes = other;
        } else {
            error = "it has neither a uri nor a bufferView";
            return false;
        }
        if (!decodeImage(bytes, decoded, error, file_.memoryLeft())) return false;
        file_.reserve(decoded.rgba.size(), image.path());
        return true;
    } catch (const Refusal& refusal) {
        error = refusal.what();
        return false;
    }
}

void Materials::unwrapPictures() {
    // One axis of an image: texels `from` to `from + length` are laid out.
    struct Axis {
        int64_t wrap = kRepeat, from = 0, length = 0;
    };
    constexpr float kFar = 1e30f;
    const size_t vertices = model_.vertexCount();
    std::vector<uint32_t> materialOf(vertices, UINT32_MAX);
    std::vector<std::array<float, 4>> ranges(uses_.size(), {kFar, kFar, -kFar, -kFar});
    for (size_t i = 0; i < model_.indices.size(); ++i) {
        const uint32_t vertex = model_.indices[i], material = model_.triangleMaterials[i / 3];
        materialOf[vertex] = material;
        for (size_t c = 0; c < 2; ++c) {
            const float uv = model_.uvs[2 * size_t{vertex} + c];
            ranges[material][c] = std::min(ranges[material][c], uv);
            ranges[material][2 + c] = std::max(ranges[material][2 + c], uv);
        }
    }
    struct Layout {
        double offset[2] = {0, 0}, scale[2] = {1, 1};
        bool changed = false;
    };
    std::vector<Layout> layouts(uses_.size());
    std::map<int32_t, size_t> users;
    for (const ImportedMaterial& material : model_.materials) ++users[material.image];
    for (size_t m = 0; m < uses_.size(); ++m) {
        ImportedMaterial& material = model_.materials[m];
        if (material.image < 0 || ranges[m][0] > ranges[m][2]) continue;
        const DecodedImage& image = model_.images[static_cast<size_t>(material.image)];
        Axis axes[2];
        Layout layout;
        for (size_t c = 0; c < 2; ++c) {
            Axis& axis = axes[c];
            const auto texels = static_cast<int64_t>(c == 0 ? image.width : image.height);
            axis.length = texels;
            const double low = double(ranges[m][c]), high = double(ranges[m][2 + c]);
            if (low >= -0.001 && high <= 1.001) continue;
            axis.wrap = uses_[m].wrap[c];
            if (axis.wrap == kRepeat) continue;
            layout.changed = true;
            if (axis.wrap == kMirror) {
                axis.length = 2 * texels;
            } else {
                // Add one texel on both sides for filtering.
                const auto size = double(texels);
                axis.from = std::min<int64_t>(0, int64_t(std::floor(low * size)) - 1);
                axis.length =
                    std::max<int64_t>(texels, int64_t(std::ceil(high * size)) + 1) - axis.from;
            }
            layout.scale[c] = double(texels) / double(axis.length);
            layout.offset[c] = -double(axis.from) / double(axis.length);
        }
        if (!layout.changed) continue;
        // A small image stays within limits at any extent.
        constexpr uint64_t kMostBytes = 256ull << 20, kSmall = 4ull << 20;
        const uint64_t most = std::clamp(64 * uint64_t{image.rgba.size()}, kSmall, kMostBytes);
        const uint64_t bytes = 4 * static_cast<uint64_t>(axes[0].length * axes[1].length);
        if (axes[0].length > int64_t{kMaxImageSide} || axes[1].length > int64_t{kMaxImageSide} ||
            bytes > most || !file_.tryReserve(bytes)) {
            notes_.leaveOut(text("wrapS and wrapT of ", uses_[m].sampler), material.name,
                            "are shown as REPEAT: the UVs reach too far beyond the picture");
            continue;
        }
        DecodedImage tiled;
        tiled.width = static_cast<uint32_t>(axes[0].length);
        tiled.height = static_cast<uint32_t>(axes[1].length);
        tiled.rgba.resize(bytes);
        const auto source = [](const Axis& axis, int64_t at, int64_t texels) {
            if (axis.wrap == kMirror) return at < texels ? at : 2 * texels - 1 - at;
            return std::clamp<int64_t>(axis.from + at, 0, texels - 1);
        };
        for (int64_t y = 0; y < axes[1].length; ++y) {
            const int64_t row = source(axes[1], y, image.height);
            for (int64_t x = 0; x < axes[0].length; ++x) {
                const int64_t column = source(axes[0], x, image.width);
                std::copy_n(&image.rgba[static_cast<size_t>(row * image.width + column) * 4], 4,
                            &tiled.rgba[static_cast<size_t>(y * axes[0].length + x) * 4]);
            }
        }
        if (--users[material.image] == 0) {
            model_.images[static_cast<size_t>(material.image)] = std::move(tiled);
        } else {
            material.image = static_cast<int32_t>(model_.images.size());
            model_.images.push_back(std::move(tiled));
        }
        layouts[m] = layout;
    }
    for (size_t v = 0; v < vertices; ++v) {
        if (materialOf[v] == UINT32_MAX || !layouts[materialOf[v]].changed) continue;
        const Layout& layout = layouts[materialOf[v]];
        for (size_t c = 0; c < 2; ++c) {
            float& uv = model_.uvs[2 * v + c];
            uv = static_cast<float>(double(uv) * layout.scale[c] + layout.offset[c]);
        }
    }
}

void Materials::noteUnusedImages() {
    const Field images = file_.root().list("images");
    for (size_t i = 0; i < images.size(); ++i)
        if (!images_.contains(static_cast<int>(i)) && !reflections_.contains(static_cast<int>(i)))
            notes_.leaveOut("image", images.at(i).path(),
                            "is left out: no base colour that is shown uses it");
}

}  // namespace fwimport
