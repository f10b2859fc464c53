// A world whose origin moves: everything that it holds goes along. Offsets are whole metres, so
// that places counted in millimetres, and grids of a metre, move exactly.
#include "world/save.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace fw::world {
namespace {

constexpr double kFar = 1e6;             // m: of every place
constexpr double kFarthestOrigin = 1e9;  // m that all places may move in all

void moveBy(float (&place)[3], const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i) place[i] = float(double(place[i]) + by[i]);
}
void moveBy(double (&place)[3], const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i) place[i] += by[i];
}
void moveBy(gpu::vec3& place, const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i) place[i] = float(double(place[i]) + by[i]);
}
// Where something was: its owner may be elsewhere by now, and this leaves the limits of space.
template <class Place>
void movePast(Place& place, const double (&by)[3]) noexcept {
    for (int i = 0; i < 3; ++i) {
        auto& metres = place[i];
        metres = std::remove_reference_t<decltype(metres)>(std::clamp(
            double(metres) + by[i], -components::kFarthestPlace, components::kFarthestPlace));
    }
}
void movePast(int& millimetres, double metres) noexcept {
    constexpr double kMost = components::kFarthestPlace * 1000;
    millimetres = int(std::clamp(double(millimetres) + metres * 1000, -kMost, kMost));
}
// Wraps where a load goes to an origin so far off that only its save has places there.
template <class Whole>
void moveMillimetres(std::array<Whole, 3>& place, const double (&by)[3]) noexcept {
    using Wraps = std::make_unsigned_t<Whole>;
    for (size_t i = 0; i < 3; ++i) place[i] = Whole(Wraps(place[i]) + Wraps(int64_t(by[i] * 1000)));
}
void moveJet(components::JetStream& stream, const double (&by)[3]) noexcept {
    for (components::JetPatches* patches : {&stream.patches, &stream.before})
        for (components::JetPatch& patch : *patches) movePast(patch.place, by);
    for (components::JetParcel& parcel : stream.parcels) {
        movePast(parcel.from, by);
        for (components::JetRay& ray : parcel.rays) movePast(ray.hit.place, by);
    }
}
void moveEmitter(components::FireEmitter& emitter, const double (&by)[3], double along) noexcept {
    moveBy(emitter.position, by);
    emitter.def.ground += float(along);
    for (components::JetHit& hit : emitter.hits) moveBy(hit.place, by);
    for (auto* shields : {&emitter.shields, &emitter.lastShields})
        for (components::JetShield& shield : *shields) moveBy(shield.place, by);
    for (auto* births : {&emitter.births, &emitter.next}) {
        moveBy(births->position, by);
        for (auto& note : births->sparks.notes)
            for (size_t i = 0; i < 3; ++i) note[i] = float(double(note[i]) + by[i]);
    }
    if (emitter.stream) moveJet(*emitter.stream, by);
}
void moveState(components::FireState& state, const double (&by)[3]) noexcept {
    for (gpu::vec3* place :
         {&state.bounds.low, &state.bounds.high, &state.tip, &state.light, &state.contact})
        moveBy(*place, by);
}
void moveRecord(gpu::RemoteObject& record, const double (&by)[3]) noexcept {
    gpu::ivec4* rows[] = {&record.row0, &record.row1, &record.row2};
    gpu::ivec4* lows[] = {&record.turn0, &record.turn1, &record.turn2};
    for (int i = 0; i < 3; ++i) {
        movePast(rows[i]->w, by[i]);
        movePast(lows[i]->w, by[i]);
        movePast(record.high[i], by[i]);
    }
}

template <class Place>
void checkMoved(const Place& place, const double (&by)[3], const char* what, uint32_t slot) {
    for (int i = 0; i < 3; ++i)
        if (const double moved = double(place[i]) + by[i]; !(std::abs(moved) <= kFar))
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "offset[%d] is " FW_LENGTH " " FW_LENGTH_UNIT
                       " and would put %s %u at " FW_LENGTH " " FW_LENGTH_UNIT
                       "; places lie within +-" FW_LENGTH " " FW_LENGTH_UNIT
                       ". Move or destroy it first.",
                       i, by[i], what, slot + 1, moved, kFar);
}
template <class Whole>
void checkMillimetres(const std::array<Whole, 3>& place, const double (&by)[3], const char* what,
                      uint32_t slot) {
    double metres[3];
    for (size_t i = 0; i < 3; ++i) metres[i] = double(place[i]) / 1000;
    checkMoved(metres, by, what, slot);
}

}  // namespace

void World::shiftOrigin(const float offset[3], float applied[3]) {
    mayChange();
    components::checkLengths(offset, 3, "offset", -2e6f, 2e6f);
    double by[3];
    for (int i = 0; i < 3; ++i) {
        by[i] = std::round(double(offset[i]));
        if (!(std::abs(origin_[i] + by[i]) <= kFarthestOrigin))
            core::fail(FW_ERROR_INVALID_ARGUMENT,
                       "offset[%d] is " FW_LENGTH " " FW_LENGTH_UNIT
                       " and all places have moved by " FW_LENGTH " " FW_LENGTH_UNIT
                       " already; the limit is +-" FW_LENGTH " " FW_LENGTH_UNIT " in all.",
                       i, by[i], origin_[i], kFarthestOrigin);
    }
    float whole[3];
    for (int i = 0; i < 3; ++i) whole[i] = float(by[i]);
    for (uint32_t i = 0; i < objects_.slotCount(); ++i)
        if (const auto* object = objects_.at(i))
            checkMoved((*object)->data.pose.translation, by, "burnable mesh", i);
    for (uint32_t i = 0; i < blockers_.slotCount(); ++i)
        if (const BlockerEntry* blocker = blockers_.at(i))
            checkMoved(blocker->pose.translation, by, "blocker", i);
    for (uint32_t i = 0; i < fires_.slotCount(); ++i)
        if (const auto* fire = fires_.at(i)) {
            checkMoved((*fire)->data.position, by, "volumetric fire", i);
            for (uint32_t k = 0; k < (*fire)->data.pointCount; ++k)
                checkMoved((*fire)->data.points[k].position, by, "a point of volumetric fire", i);
        }
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i)
        if (const auto* emitter = emitters_.at(i))
            checkMoved(emitter->position, by, "fire emitter", i);
    for (uint32_t i = 0; i < fields_.slotCount(); ++i)
        if (const auto* field = fields_.at(i))
            checkMoved((*field)->data.position, by, "particle field", i);
    for (uint32_t i = 0; i < fireColliders_.slotCount(); ++i)
        if (const auto* collider = fireColliders_.at(i)) {
            checkMoved((*collider)->shape.place, by, "fire collider", i);
            if ((*collider)->shape.kind == volume::ColliderKind::Capsule)
                checkMoved((*collider)->shape.extent, by, "fire collider", i);
        }
    for (uint32_t i = 0; i < windPool_.slotCount(); ++i)
        if (const components::WindZone* zone = windPool_.at(i))
            checkMillimetres(zone->middle, by, "wind zone", i);
    for (uint32_t i = 0; i < rooms_.slotCount(); ++i)
        if (const RoomEntry* room = rooms_.at(i))
            checkMillimetres(room->room.middle, by, "room", i);
    if (!windGrid_.points.empty()) checkMillimetres(windGrid_.shape.origin, by, "wind grid", 0);
    if (shield_.grid.shape.cells() != 0)
        checkMillimetres(shield_.grid.shape.origin, by, "heat shield", 0);
    places_.reserveMoves(objects_.live());
    // The host's answers about sight hold; shiftBy has the lists of neighbours made again.
    std::pmr::vector<Seen> seen(memory_);
    noteSeen(seen);
    shiftBy(by);
    if (remote_.rebuild) remote_.loadedSeen.swap(seen);
    if (applied) std::copy_n(whole, 3, applied);
    record(ShiftOrigin{{int32_t(by[0]), int32_t(by[1]), int32_t(by[2])}});
}

// Places in a readback of a frame before `lastFrame_` + 1 are relative to the old origin.
void World::noteShift(const double (&by)[3]) noexcept {
    if (shiftCount_ > 0 && shifts_[shiftCount_ - 1].frame == lastFrame_) {
        moveBy(shifts_[shiftCount_ - 1].by, by);
        return;
    }
    if (shiftCount_ == shifts_.size()) {  // rare: the two oldest count together
        for (int i = 0; i < 3; ++i) shifts_[1].by[i] += shifts_[0].by[i];
        std::copy(shifts_.begin() + 1, shifts_.end(), shifts_.begin());
        --shiftCount_;
    }
    Shift& shift = shifts_[shiftCount_++];
    shift.frame = lastFrame_;
    std::copy_n(by, 3, shift.by);
}

void World::movePlace(float (&place)[3], uint64_t frame) const noexcept {
    for (uint32_t k = 0; k < shiftCount_; ++k)
        if (frame <= shifts_[k].frame) moveBy(place, shifts_[k].by);
}

void World::shiftBy(const double (&by)[3]) noexcept {
    if (by[0] == 0 && by[1] == 0 && by[2] == 0) return;
    double along = 0;  // m up
    for (int i = 0; i < 3; ++i) along += by[i] * double(def_.up[i]);
    noteShift(by);
    moveBy(origin_, by);
    backend_.moveWorld(by);
    // Burning objects: their poses, and their latched poses.
    for (uint32_t i = 0; i < objects_.slotCount(); ++i) {
        auto* owned = objects_.at(i);
        if (!owned) continue;
        Object& object = **owned;
        moveBy(object.data.pose.translation, by);
        movePast(object.latch.pose.translation, by);
        sendPose(object);
        placeNow(object);
        if (object.remoteVersion != 0) moveRecord(object.remote, by);
    }
    remote_.rebuild = remote_.unsent = true;  // its grid is of the places before
    for (uint32_t i = 0; i < blockers_.slotCount(); ++i)
        if (BlockerEntry* blocker = blockers_.at(i)) moveBy(blocker->pose.translation, by);
    for (gpu::Blocker& blocker : remote_.blockers) {
        gpu::ivec4* turns[] = {&blocker.turn0, &blocker.turn1, &blocker.turn2};
        for (int i = 0; i < 3; ++i) movePast(turns[i]->w, by[i]);
    }
    remote_.unsent |= !remote_.blockers.empty();
    if (shield_.grid.shape.cells() != 0) {
        moveMillimetres(shield_.grid.shape.origin, by);
        shield_.unsent = shield_.unpacked = true;
    }
    for (uint32_t i = 0; i < rooms_.slotCount(); ++i)
        if (RoomEntry* room = rooms_.at(i)) moveMillimetres(room->room.middle, by);
    // Wind.
    for (uint32_t i = 0; i < windPool_.slotCount(); ++i)
        if (components::WindZone* zone = windPool_.at(i)) moveMillimetres(zone->middle, by);
    for (components::WindZone& zone : windZones_) moveMillimetres(zone.middle, by);
    if (!windGrid_.points.empty()) moveMillimetres(windGrid_.shape.origin, by);
    components::moveGusts(gusts_, by);
    // Fires, emitters, fields, and what is in their way.
    for (uint32_t i = 0; i < fires_.slotCount(); ++i) {
        auto* owned = fires_.at(i);
        if (!owned) continue;
        components::VolumetricFire& fire = (*owned)->data;
        moveBy(fire.position, by);
        for (volume::ControlPoint& point : fire.points) moveBy(point.position, by);
        moveState(fire.state, by);
        moveState(fire.nextState, by);
        for (FireTouch& touch : (*owned)->touches) {
            moveBy(touch.fireAt, by);
            moveBy(touch.objectAt, by);
        }
    }
    burning_.carry(gpu::vec3(float(by[0]), float(by[1]), float(by[2])));
    for (uint32_t i = 0; i < emitters_.slotCount(); ++i)
        if (components::FireEmitter* emitter = emitters_.at(i)) moveEmitter(*emitter, by, along);
    for (uint32_t i = 0; i < fields_.slotCount(); ++i)
        if (auto* field = fields_.at(i)) moveBy((*field)->data.position, by);
    for (uint32_t i = 0; i < fireColliders_.slotCount(); ++i) {
        auto* collider = fireColliders_.at(i);
        if (!collider) continue;
        moveBy((*collider)->shape.place, by);
        if ((*collider)->shape.kind == volume::ColliderKind::Capsule)
            moveBy((*collider)->shape.extent, by);
        moveBy((*collider)->picture.eye, by);
    }
    // Events that hosts have not polled yet.
    for (auto* lights : {&lights_, &lightsBefore_, &shownLights_})
        for (FwLight& light : *lights) moveBy(light.position, by);
    for (uint32_t i = 0; i < queries_.slotCount(); ++i)
        if (Query* query = queries_.at(i); query && query->ready)
            moveBy(query->answer.position, by);
    events_.move(by);
}

}  // namespace fw::world
