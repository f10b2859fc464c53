#include "lod/impostor_atlas.h"

#include "core/assert.h"
#include "core/hash.h"
#include "shared/volume.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fw::lod {
namespace {

constexpr float kWider = 1.3f;    // at most, than the atlas's flame, or narrower
constexpr float kTaller = 1.25f;  // the same of their heights in diameters
constexpr float kFacing = 0.17f;  // of cosines: 10 degrees where it is seen from the side
constexpr float kAtlasHysteresis =
    1.5f;                           // a flame that shows the atlas may differ so many times as much
constexpr float kStraight = 0.4f;   // diameters off the line from its base to its tip
constexpr float kWhole = 0.9f;      // of FlameRecord::air.w
constexpr float kSeenAside = 0.3f;  // of its height: less is seen along its axis

// Frames late, least and most; a cursor that turns over needs older ones.
constexpr uint32_t kMinLate = 1, kMaxLate = kAtlasFrames - kAtlasFrameStep - 2;

bool isAlike(const AtlasKind& a, const AtlasKind& b, float keeps) noexcept {
    if (a.appearance != b.appearance || !a.plain || !b.plain) return false;
    const auto within = [keeps](float x, float y, float most) {
        return std::abs(std::log(x / y)) < keeps * std::log(most);
    };
    return within(a.wide, b.wide, kWider) && within(a.tall, b.tall, kTaller) &&
           std::abs(a.facing - b.facing) < keeps * kFacing;
}

vec2 axesOf(const VolumeDraw& draw, vec3 v) noexcept {
    return {glm::dot(v, glm::normalize(vec3(draw.rayX))),
            glm::dot(v, glm::normalize(vec3(draw.rayY)))};
}

}  // namespace

AtlasKind atlasKind(const FlameRecord& r, const FlameNode* nodes, uint32_t count, vec3& tip) {
    AtlasKind kind;
    const float numbers[] = {r.tint.x,         r.tint.y,         r.tint.z,   r.tint.w,
                             r.stretch,        r.turbulence,     r.radial,   r.columns,
                             r.ridge,          r.converge,       r.puff,     r.blue,
                             r.blueHeight,     r.erode,          r.filament, r.filamentWidth,
                             r.filamentBase,   r.filamentHeight, r.tipFill,  r.smoke,
                             r.smokeTop,       r.smokeAlbedo,    r.tintLow,  r.tintHigh,
                             float(r.profile), float(r.octaves)};
    kind.appearance = core::hash32(r.tintCore);
    for (const float number : numbers) {
        uint32_t bits = 0;
        std::memcpy(&bits, &number, sizeof bits);
        kind.appearance = core::hash32(kind.appearance ^ bits);
    }
    kind.wide = std::max(r.low.w, 1e-4f);
    const float height = r.tauStart / 0.04f;  // without the pulse, as describeFlame has it
    kind.tall = height / kind.wide;
    const vec3 base(nodes[0].centre);
    tip = vec3(nodes[count - 1].centre) - base;
    for (uint32_t k = 1; k < count; ++k) {
        const float s0 = nodes[k - 1].along.w, s1 = nodes[k].along.w;
        if (s1 < height) continue;
        const float part = s1 > s0 ? std::clamp((height - s0) / (s1 - s0), 0.0f, 1.0f) : 0.0f;
        tip = glm::mix(vec3(nodes[k - 1].centre), vec3(nodes[k].centre), part) - base;
        break;
    }
    const float length2 = glm::dot(tip, tip);
    kind.plain = r.air.w > kWhole && length2 > 1e-8f;
    for (uint32_t k = 0; k < count && kind.plain; ++k) {
        if (nodes[k].along.w > height) break;
        const vec3 at = vec3(nodes[k].centre) - base;
        const vec3 off = at - tip * (glm::dot(at, tip) / length2);
        kind.plain = nodes[k].squeeze.w <= 0.0f && nodes[k].side.w < 1.01f &&
                     glm::length(off) < kStraight * kind.wide;
    }
    return kind;
}

void chooseAtlases(std::span<const AtlasItem> items, std::span<const uint32_t> had, uint32_t room,
                   ImpostorAtlases& atlases, std::span<uint32_t> out) noexcept {
    FW_ASSERT(out.size() >= items.size() && had.size() >= items.size(), "%zu items", items.size());
    std::fill(out.begin(), out.end(), kNoAtlas);
    const auto take = [&](uint32_t number) {
        ImpostorAtlas& atlas = atlases[number];
        atlas.shares = 0;
        for (size_t i = 0; i < items.size(); ++i) {
            const AtlasItem& item = items[i];
            if (!item.wants || out[i] != kNoAtlas ||
                !isAlike(item.kind, atlas.kind, had[i] == number ? kAtlasHysteresis : 1.0f))
                continue;
            out[i] = number;
            ++atlas.shares;
        }
    };
    // An atlas follows the largest of the flames that want it and are like it.
    const auto lead = [&](ImpostorAtlas& atlas, const auto& may) {
        const AtlasItem* best = nullptr;
        for (size_t i = 0; i < items.size(); ++i)
            if (items[i].wants && items[i].fits && items[i].kind.plain && out[i] == kNoAtlas &&
                may(i) && (!best || items[i].covers > best->covers))
                best = &items[i];
        if (!best) return false;
        if (atlas.key != best->key) ++atlas.run;
        atlas.key = best->key;
        atlas.kind = best->kind;
        return true;
    };
    for (uint32_t b = 0; b < kMaxImpostorAtlases; ++b) {
        ImpostorAtlas& atlas = atlases[b];
        if (!atlas.used) continue;
        atlas.used =
            b < room &&
            (lead(atlas,
                  [&](size_t i) {
                      return items[i].key == atlas.key &&
                             isAlike(items[i].kind, atlas.kind, kAtlasHysteresis);
                  }) ||
             lead(atlas, [&](size_t i) {
                 return isAlike(items[i].kind, atlas.kind, had[i] == b ? kAtlasHysteresis : 1.0f);
             }));
        if (atlas.used) take(b);
    }
    for (uint32_t b = 0; b < std::min(room, kMaxImpostorAtlases); ++b) {
        ImpostorAtlas& atlas = atlases[b];
        if (atlas.used) continue;
        const uint32_t run = atlas.run + 1;
        atlas.used = lead(atlas, [](size_t) { return true; });
        if (!atlas.used) return;
        atlas.run = run;
        atlas.written = 0;
        take(b);
    }
}

void AtlasCursor::read(uint32_t number, const ImpostorAtlases& atlases) noexcept {
    FW_ASSERT(number < kMaxImpostorAtlases && atlases[number].written > 0, "atlas %u", number);
    const ImpostorAtlas& shown = atlases[number];
    const uint64_t newest = shown.written - 1;
    const bool own = key == shown.key;
    const uint32_t hash = core::hash32(key);
    const uint64_t late = own ? 0 : kMinLate + (hash >> 1) % (kMaxLate - kMinLate + 1);
    const uint64_t wanted = newest - std::min(newest, late);
    const bool mirror = !own && (hash & 1u) != 0;
    const auto isThere = [&](uint32_t in, uint64_t frame) {
        return in != kNoAtlas && frame < atlases[in].written &&
               frame + kAtlasFrames > atlases[in].written;
    };
    const auto runOf = [&](uint64_t frame) { return shown.frames[frame % kAtlasFrames].run; };
    const bool goesOn = atlas == number && mirrored == mirror && isThere(atlas, at) &&
                        wanted >= at && wanted <= at + 2 && runOf(at) == runOf(wanted);
    if (turned < kAtlasFrameStep) ++turned;
    if (!goesOn && atlas != kNoAtlas) {
        before = at, atlasBefore = atlas, mirroredBefore = mirrored;
        turned = 1;
    }
    atlas = number, at = wanted, mirrored = mirror;
    if (!isThere(atlasBefore, before)) turned = kAtlasFrameStep;
}

void placeAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                     uint32_t slot, AtlasFrame& frame, MarchedVolume& out) noexcept {
    placeImpostor(view, item, screen, slot, frame.impostor, out);
    frame.middle = vec3(axesOf(item.draw, frame.impostor.middle),
                        glm::dot(frame.impostor.middle, vec3(view.forward)));
    frame.tip = axesOf(item.draw, item.tip);
    frame.wide = item.draw.wide;
}

bool showAtlasFrame(const ViewParams& view, const VolumeItem& item, const VolumeScreen& screen,
                    uint32_t slot, const AtlasFrame& frame, bool mirrored,
                    VolumeImpostor& out) noexcept {
    // Across the view: maps the axis of the frame's flame to the item's axis.
    FW_ASSERT(frame.wide > 0.0f, "a frame %g m wide", double(frame.wide));
    const float wider = item.draw.wide / frame.wide, side = mirrored ? -wider : wider;
    const vec2 tip = axesOf(item.draw, item.tip);
    const vec2 from = frame.tip, ours(mirrored ? -from.x : from.x, from.y);
    const float length = glm::length(ours), now = glm::length(tip);
    vec2 x(side, 0.0f), y(0.0f, wider);
    float deeper = wider;
    if (length > kSeenAside * frame.wide && now > kSeenAside * item.draw.wide) {
        const vec2 a = ours / length, b = tip / now;
        const float taller = now / length;
        deeper = taller;
        const auto turn = [&](vec2 p) {
            const float along = glm::dot(p, a), aside = p.x * a.y - p.y * a.x;
            return taller * along * b + wider * aside * vec2(b.y, -b.x);
        };
        x = turn({mirrored ? -1.0f : 1.0f, 0.0f}), y = turn({0.0f, 1.0f});
    }
    // As far from the camera as its middle is: seen from above that is nearer than where it stands,
    // and a frame in the distance of its foot would be too small.
    const vec2 aside = frame.middle.x * x + frame.middle.y * y;
    ImpostorShape stands = frame.impostor;
    stands.middle = aside.x * glm::normalize(vec3(item.draw.rayX)) +
                    aside.y * glm::normalize(vec3(item.draw.rayY)) +
                    deeper * frame.middle.z * vec3(view.forward);
    if (!showImpostor(view, item, screen, slot, stands, out)) return false;
    // showImpostor has cells as they lie in the frame: by how much a metre is.
    const vec2 perMetre = vec2(out.place.z, out.upY) / frame.impostor.cell;
    const vec2 middle = vec2(out.place) - frame.impostor.low * perMetre;
    const vec2 first = frame.impostor.low.x * x + frame.impostor.low.y * y;
    const vec2 cellX = frame.impostor.cell * x * perMetre,
               cellY = frame.impostor.cell * y * perMetre;
    out.place = vec4(middle + first * perMetre, cellX);
    out.upX = cellY.x, out.upY = cellY.y;
    out.perX = 2.0f / glm::length(screen.size * cellX);
    out.perY = 2.0f / glm::length(screen.size * cellY);
    return true;
}

}  // namespace fw::lod
