// Flipbooks: ids, users, and the texture that the backend gets. Cosmetic.
#include "world/flame_system.h"

#include "components/fire_emitter.h"
#include "flipbook/own.h"
#include "flipbook/picture.h"

namespace fw::world {

// Of all that there are and `fresh` in `slot`; without what is there already where `fresh` is null.
void FlameSystem::sendFlipbooks(uint32_t slot, const flipbook::Flipbook* fresh) {
    const flipbook::Flipbook* all[gpu::kMaxFlipbooks] = {};
    uint32_t count = 0;
    for (uint32_t i = 0; i < gpu::kMaxFlipbooks; ++i) {
        const FlipbookEntry* entry = flipbooks_.findSlot(i);
        all[i] = i == slot ? fresh : entry ? entry->data.get() : nullptr;
        count += all[i] != nullptr;
    }
    if (count == 0) {
        context_.backend.setFlipbooks(0, 0, {}, {});
        return;
    }
    const flipbook::Picture picture = flipbook::packFlipbooks(all, context_.memory);
    context_.backend.setFlipbooks(picture.width, picture.height,
                                  std::as_bytes(std::span(picture.texels)), picture.words);
}

FwFlipbookId FlameSystem::createFlipbook(const FwFlipbookDef& def) {
    checkRoom(flipbooks_, gpu::kMaxFlipbooks, "flipbooks");
    components::checkWhole(def.flags, "FwFlipbookDef::flags", 0, 0);
    components::checkWhole(def.preset, "FwFlipbookDef::preset", 0, FW_FLIPBOOK_PRESET_COUNT - 1);
    components::checkWhole(def.reserved, "FwFlipbookDef::reserved", 0, 0);
    auto flipbook = core::Owned<flipbook::Flipbook>::make(context_.memory, context_.memory);
    if (def.preset == FW_FLIPBOOK_CUSTOM) {
        if (!def.cooked)
            core::refuse(
                "FwFlipbookDef::cooked is null, and FwFlipbookDef::preset is "
                "FW_FLIPBOOK_CUSTOM.");
        if (def.cookedSize > (uint64_t(1) << 30))
            core::refuse("FwFlipbookDef::cookedSize is %llu.",
                         static_cast<unsigned long long>(def.cookedSize));
        const auto* bytes = static_cast<const std::byte*>(def.cooked);
        flipbook::readFlipbook({bytes, size_t(def.cookedSize)}, *flipbook);
    } else {
        if (def.cooked)
            core::refuse("FwFlipbookDef::cooked is not null, and FwFlipbookDef::preset is %u.",
                         def.preset);
        flipbook::readFlipbook(flipbook::presetFlipbook(def.preset, context_.memory), *flipbook);
    }
    const FwFlipbookId id = flipbooks_.create();
    try {
        sendFlipbooks(id.index1 - 1, flipbook.get());
    } catch (...) {
        flipbooks_.destroy(id);
        throw;
    }
    FlipbookEntry& entry = flipbooks_.get(id);
    entry.emits = flipbook::emitsAlone(*flipbook);
    entry.data = std::move(flipbook);
    return id;
}

void FlameSystem::destroyFlipbook(FwFlipbookId id) {
    const uint32_t users = flipbooks_.get(id).users;
    if (users > 0)
        core::refuse(
            "Flipbook %u (generation %u) is used by %u emitter(s) and flames; destroy or "
            "change them first.",
            id.index1, id.generation, users);
    sendFlipbooks(id.index1 - 1, nullptr);
    flipbooks_.destroy(id);
}

uint32_t FlameSystem::flipbookByte(FwFlipbookId id, const char* name, flipbook::Kind kind) {
    if (id.index1 == 0) return 0;
    const FlipbookEntry& entry = flipbooks_.get(id);
    static constexpr const char* kNames[] = {"fire", "smoke", "sparks"};
    const flipbook::Kind has = entry.data->facts.kind;
    if (has != kind)
        core::refuse("%s is a flipbook of %s; it must be one of %s.", name, kNames[uint32_t(has)],
                     kNames[uint32_t(kind)]);
    return id.index1;
}

void FlameSystem::setFlipbooks(FwFlipbookId fire, FwFlipbookId smoke) {
    const uint32_t bytes = flipbookByte(fire, "fire", flipbook::Kind::Fire) |
                           flipbookByte(smoke, "smoke", flipbook::Kind::Smoke) << 8;
    const FwFlipbookId now[2] = {fire, smoke};
    for (int i = 0; i < 2; ++i) {
        if (now[i].index1) ++flipbooks_.get(now[i]).users;
        if (flameFlipbooks_[i].index1) --flipbooks_.get(flameFlipbooks_[i]).users;
        flameFlipbooks_[i] = now[i];
    }
    context_.backend.setTileFlipbooks(bytes);
}

components::EmitterFlipbooks FlameSystem::flipbooksOf(const FwFireEmitterDef& def) {
    const auto pack = [&](std::span<const FwFlipbookId> ids, const char* name,
                          flipbook::Kind kind) {
        uint32_t bytes = 0, at = 0;
        for (const FwFlipbookId id : ids)
            if (const uint32_t b = flipbookByte(id, name, kind)) bytes |= b << (8 * at++);
        return bytes;
    };
    components::EmitterFlipbooks flipbooks;
    flipbooks.fire =
        pack(def.fireFlipbooks, "FwFireEmitterDef::fireFlipbooks", flipbook::Kind::Fire);
    flipbooks.fireEmits =
        flipbooks.fire != 0 && std::ranges::all_of(def.fireFlipbooks, [&](FwFlipbookId id) {
            return id.index1 == 0 || flipbooks_.get(id).emits;
        });
    flipbooks.other =
        pack(def.smokeFlipbooks, "FwFireEmitterDef::smokeFlipbooks", flipbook::Kind::Smoke);
    flipbooks.spark =
        flipbookByte(def.sparkFlipbook, "FwFireEmitterDef::sparkFlipbook", flipbook::Kind::Spark);
    return flipbooks;
}

// `by` is 1 or -1.
void FlameSystem::countFlipbookUsers(const FwFireEmitterDef& def, int by) noexcept {
    const auto count = [&](FwFlipbookId id) {
        if (id.index1) flipbooks_.at(id.index1 - 1)->users += uint32_t(by);
    };
    for (const FwFlipbookId id : def.fireFlipbooks) count(id);
    for (const FwFlipbookId id : def.smokeFlipbooks) count(id);
    count(def.sparkFlipbook);
}

}  // namespace fw::world
