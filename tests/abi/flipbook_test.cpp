// Flipbooks through the C ABI on the cpu backend: refusals and users.
#include "abi/fire_world.h"

#include <gmock/gmock.h>

#include <cstring>
#include <vector>

namespace {

using host::created;
using host::FireWorld;
using host::lastMessage;
using ::testing::HasSubstr;

FwFlipbookId make(FireWorld& w, uint32_t preset) {
    FwFlipbookDef def = fwDefaultFlipbookDef();
    def.preset = preset;
    return created(fwWorld_CreateFlipbook, w.world, def);
}

TEST(CreateFlipbook, RefusesInvalidData) {
    FireWorld w;
    FwFlipbookId id{};
    FwFlipbookDef def = fwDefaultFlipbookDef();
    const auto refuses = [&](FwResult result, const char* text) {
        EXPECT_EQ(result, fwWorld_CreateFlipbook(w.world, &def, &id));
        EXPECT_THAT(lastMessage(w.world), HasSubstr(text));
        def = fwDefaultFlipbookDef();
    };
    refuses(FW_ERROR_INVALID_ARGUMENT, "FwFlipbookDef::cooked is null");
    def.preset = FW_FLIPBOOK_PRESET_COUNT;
    refuses(FW_ERROR_INVALID_ARGUMENT, "FwFlipbookDef::preset is 7");
    def.flags = 2;
    refuses(FW_ERROR_INVALID_ARGUMENT, "FwFlipbookDef::flags is 2");
    unsigned char bytes[80] = {'F', 'W', 'B', 'X'};
    def.preset = FW_FLIPBOOK_ROLL;
    def.cooked = bytes;
    refuses(FW_ERROR_INVALID_ARGUMENT, "FwFlipbookDef::cooked is not null");
    def.cooked = bytes;
    def.cookedSize = 20;
    refuses(FW_ERROR_BAD_DATA, "the .fwbook has 20 bytes; its header alone has 56");
    def.cooked = bytes;
    def.cookedSize = sizeof bytes;
    refuses(FW_ERROR_BAD_DATA, "begins with 0x58425746");
    for (int i = 0; i < 32; ++i) (void)make(w, FW_FLIPBOOK_SPARK);
    def.preset = FW_FLIPBOOK_SPARK;
    refuses(FW_ERROR_INVALID_ARGUMENT, "32 flipbooks are there; the limit is 32.");
}

TEST(CreateFlipbook, StaysAliveWhileInUse) {
    FireWorld w;
    const FwFlipbookId fire = make(w, FW_FLIPBOOK_FLAME), smoke = make(w, FW_FLIPBOOK_HAZE);
    FwFireEmitterDef def = fwDefaultFireEmitterDef();
    FwFireEmitterId emitter{};
    def.fireFlipbooks[1] = smoke;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_CreateFireEmitter(w.world, &def, &emitter));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("FwFireEmitterDef::fireFlipbooks is a flipbook of "
                                                "smoke; it must be one of fire."));
    def.fireFlipbooks[1] = fire;
    def.smokeFlipbooks[0] = smoke;
    ASSERT_EQ(FW_OK, fwWorld_CreateFireEmitter(w.world, &def, &emitter)) << lastMessage(w.world);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_SetFlameFlipbooks(w.world, smoke, fire));
    ASSERT_EQ(FW_OK, fwWorld_SetFlameFlipbooks(w.world, fire, {}));
    ASSERT_EQ(FW_OK, fwWorld_SetFlameFlipbooks(w.world, fire, smoke));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_DestroyFlipbook(w.world, fire));
    EXPECT_THAT(lastMessage(w.world), HasSubstr("is used by 2 emitter(s) and flames"));
    ASSERT_EQ(FW_OK, fwWorld_DestroyFireEmitter(w.world, emitter));
    EXPECT_THAT(fwWorld_DestroyFlipbook(w.world, smoke), FW_ERROR_INVALID_ARGUMENT);
    ASSERT_EQ(FW_OK, fwWorld_SetFlameFlipbooks(w.world, {}, {}));
    w.run(0.2f);
    EXPECT_EQ(FW_OK, fwWorld_DestroyFlipbook(w.world, fire));
    EXPECT_EQ(FW_OK, fwWorld_DestroyFlipbook(w.world, smoke));
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_SetFlameFlipbooks(w.world, fire, {}));
    def.smokeFlipbooks[0] = def.smokeFlipbooks[1] = {};
    EXPECT_EQ(FW_ERROR_STALE_ID, fwWorld_CreateFireEmitter(w.world, &def, &emitter));
}

}  // namespace
