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
// More rings of a frame in which an object comes into view or catches fire, which would end in
// steps of whole texels: the next ones add to them. A picture by itself has no next frame, and
// takes what there is to see, up to so many.
constexpr uint32_t kRingsOfFrame = 8, kRingsOfPicture = 96;
// How long predictions may wait where detail is short: ticks, with no triangles left, and texels
// that fire crosses meanwhile, as a round brings a ring. Known predictions stay, and age.
constexpr double kLongestPause = kTicksPerSecond / 10.0, kCrossedInPause = 0.6;

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

// Texels that fire may cross in a tick.
double paceOf(const ObjectEntry& object) noexcept {
    return metresPerTick(object) / std::sqrt(std::max(double(object.record.tint.w), 1e-12));
}

// Texels that fire may cross in the time that is looked ahead.
uint32_t ringsOf(const ObjectEntry& object) noexcept {
    const double rings = double(object.record.horizon) * paceOf(object);
    return uint32_t(std::clamp(rings, 1.0, double(kRingsOfPicture)));
}

bool lately(uint64_t seenFrame, uint64_t frame) noexcept {
    return seenFrame + kSeenFrames >= frame;
}

bool seenLately(const ObjectEntry& object, uint64_t frame) noexcept {
    return lately(object.seenFrame, frame) && (object.record.flags & kObjectHidden) == 0;
}

}  // namespace

void markVisible(BackendState& s, const FwView& view, float height, uint64_t frame) noexcept {
    if (!s.scene.lookTextures.live) return;
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
        const bool wanted = seenLately(object, s.open.ringFrame);
        object.turns = object.live && object.burn.touched && unseen == wanted;
        if (!object.turns) continue;
        needs.uploadBytes += 2 * uploaded(sizeof object.record.flags);
        needs.appears |= wanted;
    }
}

bool predictsNow(const BackendState& s, const FrameNeeds& needs, uint32_t endTick) noexcept {
    const double shortOf = 1.0 - double(s.detail.triangles);
    if (shortOf <= 0 || needs.stimulus || needs.appears) return true;
    double pause = kLongestPause * shortOf;
    for (const uint32_t i : s.scene.awake)
        if (const ObjectEntry& object = s.scene.objects[i];
            object.live && object.burn.touched && (object.record.flags & kObjectUnseen) == 0)
            pause = std::min(pause, kCrossedInPause / std::max(paceOf(object), 1e-9));
    return double(endTick - s.simulation.predictTick) >=
           pause;  // of a save that was loaded: long ago
}

void recordPredictions(BackendState& s, const FramePlan& plan, FrameRecorder& recorder) {
    const auto uploadFlags = [&](uint32_t slot, uint32_t flags) {
        recorder.uploadOne(FW_BIND_OBJECTS,
                           uint64_t(slot) * sizeof(BurnObject) + offsetof(BurnObject, flags),
                           flags);
    };
    s.simulation.predictTick = plan.endTick;
    const uint32_t most = plan.frameIndex == 0 ? kRingsOfPicture : kRingsOfFrame;
    uint32_t rings = 0;
    bool seen = lately(s.simulation.seenFrame,
                       s.open.ringFrame);  // objects that others lit are known only later
    for (const uint32_t i : s.scene.awake) {
        ObjectEntry& object = s.scene.objects[i];
        uint32_t& flags = object.record.flags;
        if (object.turns) {
            flags ^= kObjectUnseen;
            const bool comes = (flags & kObjectUnseen) == 0;
            uploadFlags(i, comes ? flags | kObjectShownAgain : flags);
            if (comes) {
                recordPredictRestart(recorder, s.simulation.lists, i, object.record.tileCount);
                rings = std::max(rings, std::min(ringsOf(object), most));
            }
        }
        if (object.burn.catches && (flags & kObjectUnseen) == 0)
            rings = std::max(rings, std::min(ringsOf(object), kRingsOfFrame));
        object.burn.catches = false;
        seen |= object.live && object.burn.touched && (flags & kObjectUnseen) == 0;
    }
    // A ring a round: long frames need more to stay ahead of a fast front.
    auto rounds = uint32_t(std::clamp<size_t>(plan.steps.size() * 2, 2, 9) - 1);
    recordPrediction(recorder, s.simulation.lists, plan.endTick, seen);
    if (rings > 0) {
        rounds += rings;
        for (const uint32_t i : s.scene.awake)
            if (s.scene.objects[i].turns && (s.scene.objects[i].record.flags & kObjectUnseen) == 0)
                uploadFlags(i, s.scene.objects[i].record.flags);
    }
    for (uint32_t i = 1; seen && i < rounds; ++i)
        recordPrediction(recorder, s.simulation.lists, plan.endTick, seen);
    s.simulation.predictWalks += seen ? rounds : 1;
}

}  // namespace fw::gpu::vk
