// Which objects some view shows. Arrival ahead of the front is cosmetic: of an object that no view
// shows, only burning and extinguished texels are recorded as they come, so that their ages are
// right. When a view shows the object again, arrival ahead of its front is found at once.
#include "gpu/vk/frame_needs.h"

#include <algorithm>
#include <cmath>

namespace fw::gpu::vk {
namespace {

// Frames that an object is still predicted after a view showed it: one that looks around comes
// back.
constexpr uint64_t kSeenFrames = 64;
constexpr uint64_t kIdleTurns = 16;  // unburnt objects are checked once in so many frames
static_assert(kIdleTurns < kSeenFrames);
constexpr float kSeenRoom = 1.5f;   // of its bounds: it deforms, and the view turns
constexpr float kMinPixels = 3.0f;  // a smaller radius does not show arrival ahead of the front
constexpr float kAnyHeight = 1080;  // px, before anything was drawn

struct Sphere {
    glm::vec3 middle;  // m, from the camera
    float radius;      // m
};

Sphere sphereOf(const ObjectEntry& object, const mesh::BurnDomain& domain, const vec4& eye) {
    const glm::vec3 low(domain.boundsLow[0], domain.boundsLow[1], domain.boundsLow[2]);
    const glm::vec3 high(domain.boundsHigh[0], domain.boundsHigh[1], domain.boundsHigh[2]);
    const vec4 rest(0.5f * (low + high), 1.0f);
    const vec4 &x = object.record.worldRow0, &y = object.record.worldRow1,
               &z = object.record.worldRow2;
    const glm::vec3 middle(glm::dot(x, rest), glm::dot(y, rest), glm::dot(z, rest));
    const float scale = glm::length(glm::vec3(x));
    return {middle - glm::vec3(eye), kSeenRoom * scale * 0.5f * glm::length(high - low)};
}

bool shows(const ViewParams& p, const Sphere& sphere) noexcept {
    if (!sphereInView(p, sphere.middle, sphere.radius)) return false;
    const bool perspective = p.forward.w > 0.5f;
    const float away = perspective ? std::max(glm::length(sphere.middle) - sphere.radius, 0.0f) : 1;
    return sphere.radius >= kMinPixels * p.eye.w * away;
}

}  // namespace

bool shownLately(uint64_t seenFrame, uint64_t frame) noexcept {
    return seenFrame + kSeenFrames >= frame;
}

void markVisible(BackendState& s, const FwView& view, float height, uint64_t frame) noexcept {
    if (!s.scene.appearanceTextures.live) return;
    const ViewParams params = s.paramsOf(view, height, kAnyHeight);
    const auto lookAt = [&](ObjectEntry& object) {
        if (!object.live || object.seenFrame == frame) return;
        // Bounds of skinned objects are not known: the host moves their vertices.
        if (object.deforms.skinPlus1 == 0 &&
            !shows(params, sphereOf(object, *s.scene.meshOf(object).domain, params.eye)))
            return;
        object.seenFrame = frame;
        if ((object.record.flags & kObjectHidden) == 0) s.simulation.seenFrame = frame;
    };
    for (const uint32_t i : s.scene.awake)
        if (s.scene.objects[i].burn.touched) lookAt(s.scene.objects[i]);
    for (size_t i = frame % kIdleTurns; i < s.scene.objects.size(); i += kIdleTurns)
        if (!s.scene.objects[i].burn.touched) lookAt(s.scene.objects[i]);
}

void addSeenNeeds(BackendState& s, FrameNeeds& needs) {
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        const bool unseen = (object.record.flags & kObjectUnseen) != 0;
        const bool wanted = shownLately(object.seenFrame, s.open.ringFrame) &&
                            (object.record.flags & kObjectHidden) == 0;
        object.turns = object.live && object.burn.touched && unseen == wanted;
        if (!object.turns) continue;
        needs.uploadBytes += 2 * uploaded(sizeof object.record.flags);
        needs.appears |= wanted;
    }
}

}  // namespace fw::gpu::vk
