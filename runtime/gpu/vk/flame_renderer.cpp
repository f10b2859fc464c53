#include "gpu/vk/flame_renderer.h"

#include "core/error.h"
#include "core/reserved.h"
#include "gpu/passes/blend_order.h"
#include "gpu/vk/backend_state.h"
#include "shared/volume.h"

#include <algorithm>

namespace fw::gpu::vk {
namespace {

constexpr uint32_t kMinImpostors = 32;          // that there is space for
constexpr uint32_t kMaxImpostorsPerFrame = 12;  // are marched again per frame, or all that must be
constexpr uint32_t kPairWords = 2 * kImpostorWords;
constexpr float kImpostorMaxTurn =
    0.985f;  // cosine of what an impostor is seen from aside: 10 degrees

float areaOf(const VolumeItem& item) noexcept {
    const vec4& r = item.draw.rect;
    return (r.z - r.x) * (r.w - r.y);
}

// [0, 1]: of a flame that is not marched for the view.
float hazeAlone(uint32_t tier) noexcept {
    return tier == FW_FIRE_TIER_AUTO || tier == FW_FIRE_TIER_MARCH_HIGH ? 1.0f : 0.0f;
}

float hazeOf(const TierLife& life) noexcept {
    if (!life.marchedNow()) return 0.0f;
    const float high = float(life.steps - kLowSteps) / float(kHighSteps - kLowSteps);
    return high * (life.turned < kTierFrames ? life.part() : 1.0f);
}

// Samples of a flame, and as which pixels it shows them.
void setFade(const TierLife& life, bool now, float& from, float& to) noexcept {
    const float part = life.turned < kTierFrames ? life.part() : 1.0f;
    from = now ? 0.0f : part;
    to = now ? part : 1.0f;
}

uint32_t rayStepCount(const BackendState& s) noexcept {
    return std::min(s.limits.rayStepCount, s.flames.volumeStepsNow);
}

// At the frame's detail.
uint32_t rayWords(const BackendState& s, const March& march) noexcept {
    return uint32_t(double(s.detail.memory) * volumeRayWords(march.screen));
}

// One frame's march for one view: chooses the tier of each flame, and places it in the words.
class MarchFrame {
 public:
    MarchFrame(const BackendState& s, OutsideView& of, std::span<const VolumeItem> items)
        : s_(s),
          volumes_(s.flames.volumes),
          seen_(s.seen),
          view_(of.view),
          march_(of.march),
          items_(items),
          capacity_(s.buffers.capacity(poolOf(kPoolVolumeRays, of.number))),
          rays_(rayWords(s, of.march)) {
        places_.fill(kMaxVolumeFlames);
    }
    MarchRecord run() noexcept;

 private:
    void divideWords() noexcept;
    void assignAtlases() noexcept;
    void chooseTiers() noexcept;
    [[nodiscard]] bool placeMarched() noexcept;
    void placeAtlasFrames() noexcept;
    void placeImpostors() noexcept;
    void order() noexcept;
    void showAtlas(const VolumeItem& item, uint32_t place, uint32_t number) noexcept;
    void showPair(const VolumeItem& item, uint32_t place) noexcept;
    // Shows the impostor in `slot` as pixels [from, to), if the view has it.
    template <class Show>
    void addImpostor(float from, float to, const Show& show) noexcept {
        FW_ASSERT(march_.impostorCount < march_.impostors.size(), "%u impostors",
                  march_.impostorCount);
        VolumeImpostor& impostor = march_.impostors[march_.impostorCount];
        if (!(from < to) || !show(impostor)) return;
        impostor.from = from, impostor.to = to;
        march_.order.add(draw::volume_impostor, march_.impostorCount++);
    }
    [[nodiscard]] bool isShown(size_t i) const noexcept { return places_[i] != kMaxVolumeFlames; }
    [[nodiscard]] const VolumeBox& boxOf(size_t i) const noexcept {
        return volumes_[items_[i].flame];
    }

    const BackendState& s_;
    const std::pmr::vector<VolumeBox>& volumes_;
    const ViewParams& seen_;
    const FwView& view_;
    March& march_;
    std::span<const VolumeItem> items_;
    uint32_t capacity_, rays_;          // words: of the buffer, and for rays
    uint32_t slots_ = 0, atlases_ = 0;  // pairs and atlases that there is space for
    uint32_t first_ = 0;                // word behind those
    VolumeAllocation marched_;          // of march_.items, and behind them
    uint32_t impostors_ = 0;            // impostors
    std::array<uint32_t, kMaxVolumeFlames> places_, numbers_;  // by item: its life, its atlas
};

MarchRecord MarchFrame::run() noexcept {
    divideWords();
    assignAtlases();
    chooseTiers();
    if (!placeMarched()) return {};
    placeAtlasFrames();
    placeImpostors();
    order();
    march_.made = march_.screen;
    march_.view = view_;
    march_.count = marched_.count;
    march_.there = true;
    FW_ASSERT(marched_.count + impostors_ <= march_.items.size(), "%u marches",
              marched_.count + impostors_);
    return {{march_.items.data(), marched_.count + impostors_}, first_, marched_.end, impostors_};
}

// Pairs of impostors, atlases, rays, in this order. Where memory is short there are none of the
// first two.
void MarchFrame::divideWords() noexcept {
    if (capacity_ != march_.capacity)
        for (ImpostorPair& pair : march_.pairs)
            for (ImpostorShape& shape : pair.shapes) shape.there = false;
    const bool fits = uint64_t{march_.slots} * kPairWords + rays_ / 4 <= capacity_;
    slots_ = fits ? march_.slots : 0;
    const uint64_t beside = uint64_t{slots_} * kPairWords + rays_ / 4;
    atlases_ = slots_ > 0 ? march_.atlasCapacity : 0;
    while (atlases_ > 0 && beside + uint64_t{atlases_} * kImpostorAtlasWords > capacity_)
        --atlases_;
    if (capacity_ != march_.capacity || march_.impostorSlot != 2 * slots_ ||
        march_.screen.encoding != march_.atlasEncoding)
        for (ImpostorAtlas& atlas : march_.atlases) atlas.used = false, atlas.written = 0;
    march_.capacity = capacity_;
    march_.impostorSlot = 2 * slots_;
    march_.atlasEncoding = march_.screen.encoding;
    first_ = slots_ * kPairWords + atlases_ * kImpostorAtlasWords;
    ++march_.passed;
}

// Which of the atlases each item may show.
void MarchFrame::assignAtlases() noexcept {
    std::array<AtlasItem, kMaxVolumeFlames> requested;
    std::array<uint32_t, kMaxVolumeFlames> had;
    bool wanted = false;
    for (size_t i = 0; i < items_.size(); ++i) {
        const VolumeBox& box = boxOf(i);
        const uint32_t at = lifeOf(box.key, march_.lives);
        const TierLife* life = at < kMaxVolumeFlames ? &march_.lives[at] : nullptr;
        had[i] = life && march_.cursors[at].key == box.key ? march_.cursors[at].atlas : kNoAtlas;
        AtlasItem& one = requested[i];
        one.kind = box.kind;
        one.kind.facing =
            glm::dot(glm::normalize(box.tip), glm::normalize(items_[i].middle - vec3(seen_.eye)));
        one.key = box.key;
        one.covers = areaOf(items_[i]);
        one.fits = impostorFits(items_[i]);
        one.wants =
            one.kind.plain && wantsAtlas(box.tier, volumeWide(items_[i].draw, march_.screen),
                                         life ? *life : TierLife{});
        wanted = wanted || (one.wants && one.fits);
    }
    chooseAtlases({requested.data(), items_.size()}, {had.data(), items_.size()}, atlases_,
                  march_.atlases, std::span(numbers_).first(items_.size()));
    // More where flames that want one have none: all are placed again, so not one by one.
    bool without = false;
    for (size_t i = 0; i < items_.size(); ++i)
        without = without || (requested[i].wants && requested[i].fits && numbers_[i] == kNoAtlas);
    if (without && atlases_ == march_.atlasCapacity)
        march_.atlasCapacity = std::clamp(2 * atlases_, 1u, kMaxImpostorAtlases);
    march_.atlasIdleFrames = wanted ? 0 : std::min(march_.atlasIdleFrames + 1, kAtlasFrames);
    if (march_.atlasIdleFrames < kAtlasFrames || march_.atlasCapacity == 0) return;
    march_.atlasCapacity = 0;
    march_.atlasSpare = true;
}

void MarchFrame::chooseTiers() noexcept {
    std::array<TierItem, kMaxVolumeFlames> requested;
    for (size_t i = 0; i < items_.size(); ++i) {
        const VolumeBox& box = boxOf(i);
        const ImpostorAtlas* atlas =
            numbers_[i] == kNoAtlas ? nullptr : &march_.atlases[numbers_[i]];
        // Its newest frame is this one.
        const bool ready = atlas && (atlas->key == box.key || atlas->written + 1 >= kAtlasFrames);
        requested[i] = {box.key,           box.tier, volumeWide(items_[i].draw, march_.screen),
                        areaOf(items_[i]), ready,    atlas && atlas->shares > 1};
        const bool extended = box.tier == core::reserved::kFireTier;
        if (box.body1 != 0)
            requested[i].requested = FW_FIRE_TIER_MARCH_HIGH;
        else if (extended && !extension()->showsVolumes(march_.screen.encoding))
            requested[i].requested = FW_FIRE_TIER_MARCH_LOW;
        else if (!extended && !impostorFits(items_[i]))
            requested[i].requested = FW_FIRE_TIER_MARCH_HIGH;  // around the camera
    }
    lod::chooseTiers({requested.data(), items_.size()}, slots_,
                     {s_.detail.marchedHigh, s_.detail.marched}, march_.lives, places_);
    // A place may have gone to another flame.
    for (size_t i = 0; i < march_.pairs.size(); ++i) {
        const TierLife& life = march_.lives[i];
        if (!life.used || march_.cursors[i].key != life.key) march_.cursors[i] = {};
        for (ImpostorShape& shape : march_.pairs[i].shapes)
            shape.there = shape.there && life.used && shape.key == life.key &&
                          shape.encoding == march_.screen.encoding &&
                          life.shows(FW_FIRE_TIER_IMPOSTOR);
    }
    // A flame that is marched with all its samples has haze; it goes with them, little by little.
    // The column of a flame beside the view may be in it.
    FW_ASSERT(volumes_.size() <= march_.haze.size(), "%zu flames", volumes_.size());
    for (size_t i = 0; i < volumes_.size(); ++i) march_.haze[i] = hazeAlone(volumes_[i].tier);
    for (size_t i = 0; i < items_.size(); ++i)
        if (isShown(i)) march_.haze[items_[i].flame] = hazeOf(march_.lives[places_[i]]);
}

// False: they do not fit.
bool MarchFrame::placeMarched() noexcept {
    std::array<VolumeItem, kMaxVolumeFlames> marched;
    std::array<uint32_t, kMaxVolumeFlames> lives;
    uint32_t count = 0;
    for (size_t i = 0; i < items_.size(); ++i) {
        if (!isShown(i) || !march_.lives[places_[i]].marched()) continue;
        marched[count] = items_[i];
        marched[count].draw.mostSteps = march_.lives[places_[i]].steps;
        lives[count++] = places_[i];
    }
    marched_ = {first_, 0};
    if (count == 0) return true;
    // `seen_` is a view of one pixel.
    marched_ =
        allocateVolumes({marched.data(), count}, march_.screen, seen_.eye.w / march_.screen.size.y,
                        std::min(capacity_, first_ + rays_), march_.items, first_);
    if (marched_.end == 0) return false;
    FW_ASSERT(marched_.end <= capacity_, "word %u of %u", marched_.end, capacity_);
    for (uint32_t i = 0, k = 0; k < marched_.count; ++k) {
        MarchedVolume& one = march_.items[k];
        while (marched[i].flame != one.flame) ++i;
        const TierLife& life = march_.lives[lives[i]];
        setFade(life, life.marchedNow(), one.composite.from, one.composite.to);
        if (one.window) one.march.flame = 2 * uint32_t(volumes_.size()) + one.flame;
    }
    return true;
}

// The next frame of each atlas: the flame that it follows, as it is now.
void MarchFrame::placeAtlasFrames() noexcept {
    for (uint32_t b = 0; b < kMaxImpostorAtlases; ++b) {
        ImpostorAtlas& atlas = march_.atlases[b];
        if (!atlas.used) continue;
        for (size_t i = 0; i < items_.size(); ++i) {
            if (boxOf(i).key != atlas.key || numbers_[i] != b) continue;
            const auto at = uint32_t(atlas.written % kAtlasFrames);
            MarchedVolume& one = march_.items[marched_.count + impostors_++];
            placeAtlasFrame(seen_, items_[i], march_.screen,
                            march_.impostorSlot + b * kAtlasFrames + at, atlas.frames[at], one);
            atlas.frames[at].run = atlas.run;
            one.march.flame = 3 * uint32_t(volumes_.size()) + one.flame;
            ++atlas.written;
            break;
        }
    }
}

// Flames that have none, and of the others the oldest.
void MarchFrame::placeImpostors() noexcept {
    const uint32_t perFrame = kMaxImpostorsPerFrame - impostors_;
    std::array<uint32_t, kMaxVolumeFlames> due;
    uint32_t dues = 0;
    for (uint32_t i = 0; i < items_.size(); ++i)
        if (isShown(i) && march_.lives[places_[i]].shows(FW_FIRE_TIER_IMPOSTOR)) due[dues++] = i;
    const auto age = [&](uint32_t i) {
        const ImpostorPair& pair = march_.pairs[places_[i]];
        const ImpostorShape& shape = pair.shapes[pair.newest];
        const vec3 direction = glm::normalize(items_[i].middle - vec3(seen_.eye));
        const bool good = shape.there && glm::dot(direction, shape.direction) > kImpostorMaxTurn;
        return good ? march_.passed - shape.frame : ~uint64_t{0};
    };
    std::sort(due.begin(), due.begin() + dues, [&](uint32_t a, uint32_t b) {
        const uint64_t x = age(a), y = age(b);
        return x != y ? x > y : a < b;
    });
    for (uint32_t k = 0; k < dues; ++k) {
        const uint32_t i = due[k];
        if (k >= perFrame && age(i) != ~uint64_t{0}) break;
        MarchedVolume& one = march_.items[marched_.count + impostors_++];
        ImpostorPair& pair = march_.pairs[places_[i]];
        if (pair.shapes[pair.newest].there) pair.newest ^= 1u;
        pair.over = (dues + perFrame - 1) / perFrame;
        ImpostorShape& shape = pair.shapes[pair.newest];
        placeImpostor(seen_, items_[i], march_.screen, 2 * places_[i] + pair.newest, shape, one);
        shape.key = march_.lives[places_[i]].key;
        shape.frame = march_.passed;
        one.march.flame = uint32_t(volumes_.size()) + one.flame;
    }
}

// In the order in which they lie behind each other, whatever they are shown as.
void MarchFrame::order() noexcept {
    for (uint32_t i = 0, shown = 0; i < items_.size(); ++i) {
        if (!isShown(i)) continue;
        const TierLife& life = march_.lives[places_[i]];
        for (; shown < marched_.count && march_.items[shown].flame == items_[i].flame; ++shown)
            march_.order.add(
                march_.items[shown].body ? draw::body_composite : draw::volume_composite, shown);
        if (life.shows(core::reserved::kFireTier)) {
            float from = 0, to = 1;
            setFade(life, life.tier == core::reserved::kFireTier, from, to);
            march_.calls[march_.callCount] = extension()->volumeCall(items_[i], from, to);
            march_.order.add(draw::Number(extension()->volumePass), march_.callCount++);
        }
        if (life.shows(FW_FIRE_TIER_SHARED_IMPOSTOR))
            showAtlas(items_[i], places_[i], numbers_[i]);
        else
            march_.cursors[places_[i]] = {};
        if (life.shows(FW_FIRE_TIER_IMPOSTOR)) showPair(items_[i], places_[i]);
    }
}

// A flame's own impostor, of the last two marches of it.
void MarchFrame::showPair(const VolumeItem& item, uint32_t place) noexcept {
    const TierLife& life = march_.lives[place];
    const ImpostorPair& pair = march_.pairs[place];
    float from = 0.0f, to = 1.0f;
    setFade(life, life.tier == FW_FIRE_TIER_IMPOSTOR, from, to);
    const uint32_t older = pair.newest ^ 1u;
    const float part = float(march_.passed - pair.shapes[pair.newest].frame + 1) / float(pair.over);
    const float border = pair.shapes[older].there ? from + std::min(part, 1.0f) * (to - from) : to;
    const auto show = [&](uint32_t half, float first, float last) {
        addImpostor(first, last, [&](VolumeImpostor& out) {
            return showImpostor(seen_, item, march_.screen, 2 * place + half, pair.shapes[half],
                                out);
        });
    };
    show(pair.newest, from, border);
    show(older, border, to);
}

void MarchFrame::showAtlas(const VolumeItem& item, uint32_t place, uint32_t number) noexcept {
    AtlasCursor& cursor = march_.cursors[place];
    const TierLife& life = march_.lives[place];
    cursor.key = life.key;
    if (number == kNoAtlas) number = cursor.atlas;  // it is like none any more, and turns
    if (number == kNoAtlas) return;
    if (march_.atlases[number].used) cursor.read(number, march_.atlases);
    if (cursor.at >= march_.atlases[cursor.atlas].written) return;  // its space is another's
    float from = 0.0f, to = 1.0f;
    setFade(life, life.tier == FW_FIRE_TIER_SHARED_IMPOSTOR, from, to);
    const float border = from + float(cursor.turned) / float(kAtlasFrameStep) * (to - from);
    const auto show = [&](uint32_t atlas, uint64_t at, bool mirrored, float first, float last) {
        const auto frame = uint32_t(at % kAtlasFrames);
        addImpostor(first, last, [&](VolumeImpostor& out) {
            return showAtlasFrame(seen_, item, march_.screen,
                                  march_.impostorSlot + atlas * kAtlasFrames + frame,
                                  march_.atlases[atlas].frames[frame], mirrored, out);
        });
    };
    show(cursor.atlas, cursor.at, cursor.mirrored, from, border);
    if (border < to) show(cursor.atlasBefore, cursor.before, cursor.mirroredBefore, border, to);
}

}  // namespace

void FlameRenderer::record(const VolumeUpdate& update, FrameRecorder& recorder) {
    volumes.clear();
    const std::span<const VolumeFlame> flames(update.flames, update.count);
    FW_ASSERT(update.bodyCount <= update.count, "%u bodies", update.bodyCount);
    for (const VolumeFlame& flame : flames) {
        const FlameRecord& record = flame.record;
        VolumeBox box;
        box.low = record.low;
        box.high = record.high;
        box.key = record.key;
        box.tier = record.tier;
        box.smokes = record.smoke > 0.0f;
        const auto number = uint32_t(volumes.size());
        if (number + update.bodyCount >= update.count) {
            box.body1 = number + update.bodyCount - update.count + 1;
            box.flameLow = record.low, box.flameHigh = record.high;
            box.base = vec3(flame.record.glow);
            volumes.push_back(box);
            continue;
        }
        box.intervals = volumeIntervals(flame.nodes, kFlameNodes);
        box.base = vec3(flame.nodes[0].centre);
        box.basePlane = volumeBasePlane(record, flame.nodes, kFlameNodes);
        box.kind = atlasKind(record, flame.nodes, kFlameNodes, box.tip);
        volumeBounds(record, flame.nodes, kFlameNodes, box.flameLow, box.flameHigh);
        volumeHazeBounds(record, flame.nodes, kFlameNodes, box.hazeLow, box.hazeHigh);
        FW_ASSERT(volumes.size() < volumes.capacity(), "%u flames", update.count);
        volumes.push_back(box);
    }
    bodyCount = update.bodyCount;
    recorder.upload(FW_BIND_VOLUMES, 0, flames);
    recorder.upload(FW_BIND_BODIES, 0, std::span(update.bodies, update.bodyCount));
}

uint32_t FlameRenderer::order(const BackendState& s, uint32_t slabs,
                              std::array<VolumeItem, kMaxVolumeFlames>& out) const noexcept {
    if (!s.scene.profiles.live) return 0;
    FW_ASSERT(volumes.size() <= out.size(), "%zu flames", volumes.size());
    uint32_t count = 0;
    for (uint32_t i = 0; i < volumes.size(); ++i) {
        const VolumeBox& box = volumes[i];
        VolumeItem& item = out[count];
        item.flame = i;
        if (!volumeDraw(s.seen, box.low, box.high, slabs, item.draw, &item.whole)) continue;
        item.middle = 0.5f * (vec3(box.flameLow) + vec3(box.flameHigh));
        item.base = box.base;
        item.tip = box.tip;
        item.smokes = box.smokes;
        item.highQuality = box.tier == FW_FIRE_TIER_MARCH_HIGH;
        item.near = item.draw.front;
        item.far = item.draw.front + item.draw.deep * float(slabs);
        volumeSlabs(s.seen, box.flameLow, box.flameHigh, item.draw);
        if (slabs > 1 && box.body1 == 0) volumeBase(s.seen, box.basePlane, item.draw);
        item.body1 = box.body1;
        VolumeDraw burning;
        const bool burns =
            box.smokes && volumeDraw(s.seen, box.flameLow, box.flameHigh, slabs, burning);
        item.burns = burns ? burning.rect : vec4(0.0f);
        item.draw.intervals = box.intervals;
        ++count;
    }
    chooseVolumes({out.data(), count});
    // By their middles: flames that overlap in depth have no right order as a whole.
    const auto middle = [](const VolumeItem& item) {
        return item.draw.front + 0.5f * item.draw.deep * float(item.draw.slabs);
    };
    orderOnHost(std::span(out.data(), count), middle,
                [](const VolumeItem& item) { return item.flame; });
    return count;
}

VolumeScreen FlameRenderer::screenOf(const BackendState& s, const TargetKey& target,
                                     vec2 size) const noexcept {
    // March pixels are so many pixels of the picture.
    const uint32_t pixel =
        target.half ? std::max(s.limits.volumePixelSize / 2, 1u) : s.limits.volumePixelSize;
    return {size, target.depthMode == FW_DEPTH_NONE ? 1 : kVolumeSlabs, pixel, rayStepCount(s),
            uint32_t(target.encoding)};
}

void FlameRenderer::makeMarchRoom(BackendState& s, OutsideView& of, uint32_t flameCount,
                                  uint64_t last) const {
    if (!s.scene.profiles.live) return;
    March& march = of.march;
    while (march.slots < flameCount) march.slots = std::max(2 * march.slots, kMinImpostors);
    const uint32_t kept = march.slots * kPairWords + march.atlasCapacity * kImpostorAtlasWords;
    try {
        s.buffers.fit(poolOf(kPoolVolumeRays, of.number), kept + rayWords(s, march),
                      s.detail.memory < 1 || march.atlasSpare, last);
        march.atlasSpare = false;
    } catch (const core::Error& error) {
        if (error.result != FW_ERROR_OUT_OF_MEMORY) throw;
    }
}

uint32_t FlameRenderer::orderHazes(const BackendState& s, const March* march, float strength,
                                   std::array<HazedVolume, kMaxVolumeFlames>& out) const noexcept {
    if (!s.scene.profiles.live) return 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < volumes.size(); ++i) {
        const VolumeBox& box = volumes[i];
        const float share = march ? march->haze[i] : hazeAlone(box.tier);
        HazedVolume& one = out[count];
        if (!makeHazePush(s.seen, box.hazeLow, box.hazeHigh, share * strength, one.draw)) continue;
        one.flame = i;
        one.away = glm::dot(vec3(s.seen.forward), box.base - vec3(s.seen.eye));
        ++count;
    }
    orderOnHost(
        std::span(out.data(), count), [](const HazedVolume& one) { return one.away; },
        [](const HazedVolume& one) { return one.flame; });
    return count;
}

MarchRecord FlameRenderer::march(const BackendState& s, OutsideView& of) const noexcept {
    March& march = of.march;
    march.count = march.impostorCount = march.callCount = march.order.count = 0;
    march.there = false;
    march.screen.steps = rayStepCount(s);
    if (!(march.screen.size.x >= 1.0f && march.screen.size.y >= 1.0f)) return {};
    std::array<VolumeItem, kMaxVolumeFlames> items;
    const uint32_t count = order(s, march.screen.slabs, items);
    if (count == 0) return {};
    return MarchFrame(s, of, {items.data(), count}).run();
}

uint64_t FlameRenderer::detailBytes(const BackendState& s) const noexcept {
    uint64_t all = 0;
    for (const core::Owned<OutsideView>& of : s.outsideViews.all) {
        if (!of) continue;
        // The words of impostors and atlases, before the rays, follow the number of flames.
        const uint64_t impostors = (uint64_t(of->march.slots) * kPairWords +
                                    of->march.atlasCapacity * kImpostorAtlasWords) *
                                   sizeof(uint32_t);
        const uint64_t rays = s.buffers.bytes(poolOf(kPoolVolumeRays, of->number));
        all += rays - std::min(rays, impostors) + s.buffers.bytes(poolOf(kPoolFlames, of->number));
    }
    return all;
}

}  // namespace fw::gpu::vk
