// Volumetric flames on their way to the device, and the order in which a view draws them.
#include "core/error.h"
#include "gpu/passes/blend_order.h"
#include "gpu/vk/frame_needs.h"
#include "shared/volume_flame.h"

#include <algorithm>
#include <cstring>

namespace fw::gpu::vk {

constexpr uint32_t kMinImpostors = 32;          // that there is room for
constexpr uint32_t kMaxImpostorsPerFrame = 12;  // are marched again per frame, or all that must be
constexpr uint32_t kPairWords = 2 * kImpostorWords;
// A side of a pixel: all four places at which samples begin, or it is grain.
constexpr uint32_t kUnknownRays = 2;
constexpr float kImpostorMaxTurn = 0.985f;  // cosine of what a card is seen from aside: 10 degrees

static_assert(kProfileBytes == kProfileWidth * kProfileHeight * 4);

void VkBackend::setFireProfile(uint32_t slot, std::span<const uint32_t> texels) {
    State& s = *state_;
    if (!s.scene.profiles.live) return;
    PendingUpload& upload = s.stage(kProfileBytes, "fire profile");
    std::memcpy(upload.staging.mapped, texels.data(), kProfileBytes);
    upload.image = s.scene.profiles.image.handle;
    upload.width = kProfileWidth;
    upload.height = kProfileHeight;
    upload.mips = upload.layers = 1;
    upload.firstLayer = kFirePresets + slot;
}

void recordVolumes(VkBackend::State& s, const VolumeUpdate& update, FrameRecorder& recorder,
                   UploadWriter& writer) {
    s.flames.volumes.clear();  // room was made for all of them
    const std::span<const VolumeFlame> flames(update.flames, update.count);
    for (const VolumeFlame& flame : flames) {
        const FlameRecord& record = flame.record;
        VolumeBox box{record.low,
                      record.high,
                      {},
                      {},
                      volumeIntervals(flame.nodes, kFlameNodes),
                      vec3(flame.nodes[0].centre),
                      record.key,
                      record.tier,
                      record.smoke > 0.0f,
                      {},
                      {},
                      {},
                      {},
                      volumeBasePlane(record, flame.nodes, kFlameNodes)};
        box.kind = atlasKind(record, flame.nodes, kFlameNodes, box.tip);
        volumeBounds(record, flame.nodes, kFlameNodes, box.flameLow, box.flameHigh);
        volumeHazeBounds(record, flame.nodes, kFlameNodes, box.hazeLow, box.hazeHigh);
        s.flames.volumes.push_back(box);
    }
    if (flames.empty()) return;
    const Staged staged = writer.write(flames);
    recorder.copyIn(staged.at, FW_BIND_VOLUMES, 0, flames.size_bytes());
}

uint32_t VkBackend::State::orderVolumes(
    uint32_t slabs, std::array<VolumeItem, kMaxVolumeFlames>& out) const noexcept {
    if (!scene.profiles.live) return 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < flames.volumes.size(); ++i) {
        VolumeItem& item = out[count];
        item.flame = i;
        if (!volumeDraw(seen, flames.volumes[i].low, flames.volumes[i].high, slabs, item.draw,
                        &item.whole))
            continue;
        item.middle = 0.5f * (vec3(flames.volumes[i].flameLow) + vec3(flames.volumes[i].flameHigh));
        item.base = flames.volumes[i].base;
        item.tip = flames.volumes[i].tip;
        item.smokes = flames.volumes[i].smokes;
        item.highQuality = flames.volumes[i].tier == FW_FIRE_TIER_MARCH_HIGH;
        item.near = item.draw.front;
        item.far = item.draw.front + item.draw.deep * float(slabs);
        volumeSlabs(seen, flames.volumes[i].flameLow, flames.volumes[i].flameHigh, item.draw);
        if (slabs > 1) volumeBase(seen, flames.volumes[i].basePlane, item.draw);
        VolumeDraw burning;
        item.burns =
            flames.volumes[i].smokes && volumeDraw(seen, flames.volumes[i].flameLow,
                                                   flames.volumes[i].flameHigh, slabs, burning)
                ? burning.rect
                : vec4(0.0f);
        item.draw.intervals = flames.volumes[i].intervals;
        ++count;
    }
    chooseVolumes({out.data(), count});
    // By their middles: what overlaps in depth has no right order as a whole.
    const auto middle = [](const VolumeItem& item) {
        return item.draw.front + 0.5f * item.draw.deep * float(item.draw.slabs);
    };
    orderOnHost(std::span(out.data(), count), middle,
                [](const VolumeItem& item) { return item.flame; });
    return count;
}

bool sameView(const FwView& a, const FwView& b) noexcept {
    const auto same = [](const auto& x, const auto& y) {
        return std::memcmp(&x, &y, sizeof x) == 0;
    };
    return same(a.view, b.view) && same(a.projection, b.projection) &&
           same(a.sunColor, b.sunColor) && same(a.ambientSky, b.ambientSky) &&
           same(a.ambientGround, b.ambientGround) && same(a.exposure, b.exposure) &&
           same(a.emissionScale, b.emissionScale);
}

VolumeScreen VkBackend::State::screenOf(const TargetKey& target, vec2 size) const noexcept {
    // Cells are so many pixels of the picture.
    const uint32_t cell =
        target.half ? std::max(limits.volumePixelSize / 2, 1u) : limits.volumePixelSize;
    return {size, target.depthMode == FW_DEPTH_NONE ? 1 : kVolumeSlabs, cell, rayStepCount(),
            uint32_t(target.encoding)};
}

void VkBackend::State::recordScreen(OutsideView& of, const FwView& view, const VolumeScreen& screen,
                                    uint64_t frame) noexcept {
    March& march = of.march;
    if (!sameView(view, of.view)) return;
    const auto area = [](const VolumeScreen& s) { return s.size.x * s.size.y; };
    if (march.frame == frame && area(screen) <= area(march.screen)) return;
    march.screen = screen;
    march.frame = frame;
}

uint32_t VkBackend::State::rayWords(const March& march) const noexcept {
    return uint32_t(double(detail.memory) * volumeRayWords(march.screen));
}

void VkBackend::State::makeMarchRoom(OutsideView& of, uint32_t flameCount, uint64_t last) {
    if (!scene.profiles.live) return;
    March& march = of.march;
    while (march.slots < flameCount) march.slots = std::max(2 * march.slots, kMinImpostors);
    try {
        buffers.fit(
            poolOf(kPoolVolumeRays, of.number),
            march.slots * kPairWords + march.atlasCapacity * kImpostorAtlasWords + rayWords(march),
            detail.memory < 1 || march.atlasSpare, last);
        march.atlasSpare = false;
    } catch (const core::Error& error) {
        if (error.result != FW_ERROR_OUT_OF_MEMORY) throw;
    }
}

namespace {

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

}  // namespace

uint32_t VkBackend::State::orderHazes(
    const March* march, float strength,
    std::array<HazedVolume, kMaxVolumeFlames>& out) const noexcept {
    if (!scene.profiles.live) return 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < flames.volumes.size(); ++i) {
        const VolumeBox& box = flames.volumes[i];
        const float share = march ? march->haze[i] : hazeAlone(box.tier);
        HazedVolume& one = out[count];
        if (!makeHazePush(seen, box.hazeLow, box.hazeHigh, share * strength, one.draw)) continue;
        one.flame = i;
        one.away = glm::dot(vec3(seen.forward), box.base - vec3(seen.eye));
        ++count;
    }
    orderOnHost(
        std::span(out.data(), count), [](const HazedVolume& one) { return one.away; },
        [](const HazedVolume& one) { return one.flame; });
    return count;
}

MarchRecord VkBackend::State::marchVolumes(OutsideView& of) noexcept {
    March& march = of.march;
    march.count = march.impostorCount = march.slicedCount = march.order.count = 0;
    march.there = false;
    march.screen.steps = rayStepCount();
    if (!(march.screen.size.x >= 1.0f && march.screen.size.y >= 1.0f)) return {};
    std::array<VolumeItem, kMaxVolumeFlames> items;
    const uint32_t count = orderVolumes(march.screen.slabs, items);
    if (count == 0) return {};
    return allocateMarch(of, {items.data(), count});
}

void VkBackend::State::showPair(March& march, const VolumeItem& item,
                                uint32_t place) const noexcept {
    const TierLife& life = march.lives[place];
    const ImpostorPair& pair = march.pairs[place];
    float from = 0.0f, to = 1.0f;
    setFade(life, life.tier == FW_FIRE_TIER_IMPOSTOR, from, to);
    const uint32_t older = pair.newest ^ 1u;
    const float part = float(march.passed - pair.shapes[pair.newest].frame + 1) / float(pair.over);
    const float border = pair.shapes[older].there ? from + std::min(part, 1.0f) * (to - from) : to;
    const auto show = [&](uint32_t half, float first, float last) {
        VolumeImpostor& card = march.cards[march.impostorCount];
        if (!(first < last) ||
            !showImpostor(seen, item, march.screen, 2 * place + half, pair.shapes[half], card))
            return;
        card.from = first, card.to = last;
        march.order.add(draw::volume_impostor, march.impostorCount++);
    };
    show(pair.newest, from, border);
    show(older, border, to);
}

void VkBackend::State::assignAtlases(March& march, std::span<const VolumeItem> items, uint32_t room,
                                     std::span<uint32_t> numbers) const noexcept {
    std::array<AtlasItem, kMaxVolumeFlames> asked;
    std::array<uint32_t, kMaxVolumeFlames> had;
    bool wanted = false;
    for (size_t i = 0; i < items.size(); ++i) {
        const VolumeBox& box = flames.volumes[items[i].flame];
        const uint32_t at = lifeOf(box.key, march.lives);
        const TierLife* life = at < kMaxVolumeFlames ? &march.lives[at] : nullptr;
        had[i] = life && march.readers[at].key == box.key ? march.readers[at].book : kNoAtlas;
        const vec4& r = items[i].draw.rect;
        AtlasItem& one = asked[i];
        one.kind = box.kind;
        one.kind.facing =
            glm::dot(glm::normalize(box.tip), glm::normalize(items[i].middle - vec3(seen.eye)));
        one.key = box.key;
        one.covers = (r.z - r.x) * (r.w - r.y);
        one.fits = impostorFits(items[i]);
        one.wants = one.kind.plain && wantsAtlas(box.tier, volumeWide(items[i].draw, march.screen),
                                                 life ? *life : TierLife{});
        wanted = wanted || (one.wants && one.fits);
    }
    chooseAtlases({asked.data(), items.size()}, {had.data(), items.size()}, room, march.books,
                  numbers);
    // More where flames that want one have none: all are placed again, so not one by one.
    bool without = false;
    for (size_t i = 0; i < items.size(); ++i)
        without = without || (asked[i].wants && asked[i].fits && numbers[i] == kNoAtlas);
    if (without && room == march.atlasCapacity)
        march.atlasCapacity = std::clamp(2 * room, 1u, kMaxImpostorAtlases);
    march.atlasIdleFrames = wanted ? 0 : std::min(march.atlasIdleFrames + 1, kAtlasFrames);
    if (march.atlasIdleFrames < kAtlasFrames || march.atlasCapacity == 0) return;
    march.atlasCapacity = 0;
    march.atlasSpare = true;
}

void VkBackend::State::sampleFlipbook(March& march, const VolumeItem& item, uint32_t place,
                                      uint32_t number) const noexcept {
    AtlasCursor& reader = march.readers[place];
    const TierLife& life = march.lives[place];
    reader.key = life.key;
    if (number == kNoAtlas) number = reader.book;  // it is like none any more, and turns
    if (number == kNoAtlas) return;
    if (march.books[number].used) reader.read(number, march.books);
    if (reader.at >= march.books[reader.book].written) return;  // its room is another's
    float from = 0.0f, to = 1.0f;
    setFade(life, life.tier == FW_FIRE_TIER_SHARED_IMPOSTOR, from, to);
    const float border = from + float(reader.turned) / float(kAtlasFrameStep) * (to - from);
    const auto show = [&](uint32_t book, uint64_t at, bool mirrored, float first, float last) {
        VolumeImpostor& card = march.cards[march.impostorCount];
        const auto page = uint32_t(at % kAtlasFrames);
        if (!(first < last) || !showAtlasFrame(seen, item, march.screen,
                                               march.impostorSlot + book * kAtlasFrames + page,
                                               march.books[book].pages[page], mirrored, card))
            return;
        card.from = first, card.to = last;
        march.order.add(draw::volume_impostor, march.impostorCount++);
    };
    show(reader.book, reader.at, reader.mirrored, from, border);
    if (border < to) show(reader.bookBefore, reader.before, reader.mirroredBefore, border, to);
}

MarchRecord VkBackend::State::allocateMarch(OutsideView& of,
                                            std::span<const VolumeItem> items) noexcept {
    March& march = of.march;
    const uint32_t capacity = buffers.capacity(poolOf(kPoolVolumeRays, of.number));
    if (capacity != march.capacity)
        for (ImpostorPair& pair : march.pairs)
            for (ImpostorShape& shape : pair.shapes) shape.there = false;
    // Where memory is short there are none.
    const uint32_t rays = rayWords(march);
    const uint32_t slots =
        uint64_t{march.slots} * kPairWords + rays / 4 <= capacity ? march.slots : 0;
    const uint64_t beside = uint64_t{slots} * kPairWords + rays / 4;
    uint32_t atlasCapacity = slots > 0 ? march.atlasCapacity : 0;
    while (atlasCapacity > 0 && beside + uint64_t{atlasCapacity} * kImpostorAtlasWords > capacity)
        --atlasCapacity;
    if (capacity != march.capacity || march.impostorSlot != 2 * slots ||
        march.screen.encoding != march.atlasEncoding)
        for (ImpostorAtlas& book : march.books) book.used = false, book.written = 0;
    march.capacity = capacity;
    march.impostorSlot = 2 * slots;
    march.atlasEncoding = march.screen.encoding;
    ++march.passed;
    std::array<TierItem, kMaxVolumeFlames> asked;
    std::array<uint32_t, kMaxVolumeFlames> places{}, numbers;
    assignAtlases(march, items, atlasCapacity, {numbers.data(), items.size()});
    for (size_t i = 0; i < items.size(); ++i) {
        const VolumeBox& box = flames.volumes[items[i].flame];
        const vec4& r = items[i].draw.rect;
        const ImpostorAtlas* book = numbers[i] == kNoAtlas ? nullptr : &march.books[numbers[i]];
        // Its newest page is this frame's.
        const bool booked = book && (book->key == box.key || book->written + 1 >= kAtlasFrames);
        asked[i] = {box.key,
                    box.tier,
                    volumeWide(items[i].draw, march.screen),
                    (r.z - r.x) * (r.w - r.y),
                    booked,
                    book && book->shares > 1};
        const bool slices = box.tier == FW_FIRE_TIER_SLICES;
        if (slices && !slicesShow(march.screen.encoding))
            asked[i].asked = FW_FIRE_TIER_MARCH_LOW;
        else if (!slices && !impostorFits(items[i]))
            asked[i].asked = FW_FIRE_TIER_MARCH_HIGH;  // around the eye
    }
    chooseTiers({asked.data(), items.size()}, slots, {detail.marchedHigh, detail.marched},
                march.lives, places);
    // A place may have gone to another flame.
    for (size_t i = 0; i < march.pairs.size(); ++i) {
        const TierLife& life = march.lives[i];
        if (!life.used || march.readers[i].key != life.key) march.readers[i] = {};
        for (ImpostorShape& shape : march.pairs[i].shapes)
            shape.there = shape.there && life.used && shape.key == life.key &&
                          shape.encoding == march.screen.encoding &&
                          life.shows(FW_FIRE_TIER_IMPOSTOR);
    }

    std::array<VolumeItem, kMaxVolumeFlames> marched;
    std::array<uint32_t, kMaxVolumeFlames> lives;
    uint32_t count = 0;
    for (size_t i = 0; i < items.size(); ++i) {
        if (places[i] == kMaxVolumeFlames || !march.lives[places[i]].marched()) continue;
        marched[count] = items[i];
        marched[count].draw.mostSteps = march.lives[places[i]].steps;
        lives[count++] = places[i];
    }
    // `seen` is a view of one pixel.
    const uint32_t first = slots * kPairWords + atlasCapacity * kImpostorAtlasWords;
    VolumeAllocation laid{first, 0};
    if (count > 0) {
        laid =
            allocateVolumes({marched.data(), count}, march.screen, seen.eye.w / march.screen.size.y,
                            std::min(capacity, first + rays), march.items, first);
        if (laid.end == 0) return {};
    }
    for (uint32_t i = 0, k = 0; k < laid.count; ++k) {
        MarchedVolume& one = march.items[k];
        while (marched[i].flame != one.flame) ++i;
        const TierLife& life = march.lives[lives[i]];
        setFade(life, life.marchedNow(), one.composite.from, one.composite.to);
        if (one.window) one.march.flame = 2 * uint32_t(flames.volumes.size()) + one.flame;
    }

    // What is marched with all its samples has haze; it goes with them, little by little.
    // Of a flame beside the view its column may be in it.
    for (size_t i = 0; i < flames.volumes.size(); ++i)
        march.haze[i] = hazeAlone(flames.volumes[i].tier);
    for (size_t i = 0; i < items.size(); ++i)
        if (places[i] != kMaxVolumeFlames)
            march.haze[items[i].flame] = hazeOf(march.lives[places[i]]);

    uint32_t cards = 0;
    for (uint32_t b = 0; b < kMaxImpostorAtlases; ++b) {
        ImpostorAtlas& book = march.books[b];
        if (!book.used) continue;
        for (size_t i = 0; i < items.size(); ++i) {
            if (flames.volumes[items[i].flame].key != book.key || numbers[i] != b) continue;
            const auto at = uint32_t(book.written % kAtlasFrames);
            MarchedVolume& one = march.items[laid.count + cards++];
            placeAtlasFrame(seen, items[i], march.screen,
                            march.impostorSlot + b * kAtlasFrames + at, book.pages[at], one);
            book.pages[at].run = book.run;
            one.march.flame = 3 * uint32_t(flames.volumes.size()) + one.flame;
            ++book.written;
            break;
        }
    }
    const uint32_t impostorsPerFrame = kMaxImpostorsPerFrame - cards;

    // Those that have none, and of the others the oldest.
    std::array<uint32_t, kMaxVolumeFlames> due;
    uint32_t dues = 0;
    for (uint32_t i = 0; i < items.size(); ++i)
        if (places[i] != kMaxVolumeFlames && march.lives[places[i]].shows(FW_FIRE_TIER_IMPOSTOR))
            due[dues++] = i;
    const auto age = [&](uint32_t i) {
        const ImpostorPair& pair = march.pairs[places[i]];
        const ImpostorShape& shape = pair.shapes[pair.newest];
        const vec3 direction = glm::normalize(items[i].middle - vec3(seen.eye));
        const bool good = shape.there && glm::dot(direction, shape.direction) > kImpostorMaxTurn;
        return good ? march.passed - shape.frame : ~uint64_t{0};
    };
    std::sort(due.begin(), due.begin() + dues, [&](uint32_t a, uint32_t b) {
        const uint64_t x = age(a), y = age(b);
        return x != y ? x > y : a < b;
    });
    for (uint32_t k = 0; k < dues; ++k) {
        const uint32_t i = due[k];
        if (k >= impostorsPerFrame && age(i) != ~uint64_t{0}) break;
        MarchedVolume& one = march.items[laid.count + cards];
        ImpostorPair& pair = march.pairs[places[i]];
        if (pair.shapes[pair.newest].there) pair.newest ^= 1u;
        pair.over = (dues + impostorsPerFrame - 1) / impostorsPerFrame;
        ImpostorShape& shape = pair.shapes[pair.newest];
        placeImpostor(seen, items[i], march.screen, 2 * places[i] + pair.newest, shape, one);
        shape.key = march.lives[places[i]].key;
        shape.frame = march.passed;
        one.march.flame = uint32_t(flames.volumes.size()) + one.flame;
        ++cards;
    }
    // In the order in which they lie behind each other, whatever they are shown as.
    for (uint32_t i = 0, shown = 0; i < items.size(); ++i) {
        if (places[i] == kMaxVolumeFlames) continue;
        const TierLife& life = march.lives[places[i]];
        for (; shown < laid.count && march.items[shown].flame == items[i].flame; ++shown)
            march.order.add(draw::volume_composite, shown);
        if (life.shows(FW_FIRE_TIER_SLICES)) {
            SlicedVolume& one = march.sliced[march.slicedCount];
            one = makeSlicedVolume(items[i]);
            setFade(life, life.tier == FW_FIRE_TIER_SLICES, one.draw.from, one.draw.to);
            march.order.add(draw::volume_slices, march.slicedCount++);
        }
        if (life.shows(FW_FIRE_TIER_SHARED_IMPOSTOR))
            sampleFlipbook(march, items[i], places[i], numbers[i]);
        else
            march.readers[places[i]] = {};
        if (life.shows(FW_FIRE_TIER_IMPOSTOR)) showPair(march, items[i], places[i]);
    }
    march.made = march.screen;
    march.view = of.view;
    march.count = laid.count;
    march.there = true;
    return {{march.items.data(), laid.count + cards}, first, laid.end, cards};
}

bool VkBackend::State::marchedFor(const OutsideView& of, const FwView& view,
                                  const VolumeScreen& screen) noexcept {
    const March& march = of.march;
    return of.given && march.there && screen == march.made && sameView(view, march.view);
}

uint32_t VkBackend::State::minRays(OutsideView& of, const FwView& view,
                                   const VolumeScreen& screen) noexcept {
    if (!sameView(view, of.view) || screen == of.march.unknown) return 1;
    of.march.unknown = screen;
    return kUnknownRays;
}

uint32_t VkBackend::quadsShown() const noexcept { return state_->particles.quadsShown; }

uint64_t VkBackend::detailBytes() const noexcept {
    const State& s = *state_;
    uint64_t all = 0;
    for (const core::Owned<OutsideView>& of : s.flames.outsideViews) {
        if (!of) continue;
        // Cards and books lie before the rays; those are by flames.
        const uint64_t cards = (uint64_t(of->march.slots) * kPairWords +
                                of->march.atlasCapacity * kImpostorAtlasWords) *
                               sizeof(uint32_t);
        const uint64_t rays = s.buffers.bytes(poolOf(kPoolVolumeRays, of->number));
        all += rays - std::min(rays, cards) + s.buffers.bytes(poolOf(kPoolFlames, of->number));
    }
    return all;
}

}  // namespace fw::gpu::vk
