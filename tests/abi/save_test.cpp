// Saves: a loaded world continues bit for bit like the saved one, on either backend. A save that
// does not fit is refused and changes nothing.
#include "abi/busy_world.h"
#include "abi/panels.h"

#include <algorithm>
#include <functional>

namespace {

using namespace host;

// Saves at several frames; each is loaded into a new world, which runs to the end.
void continuesIdentically(uint32_t saves, uint32_t loads, uint32_t end) {
    BusyWorld first(saves);
    if (!there(first)) GTEST_SKIP() << "there is no such backend here";
    const uint32_t savedFrames[] = {25, 92, 140};
    std::vector<Bytes> bytes;
    std::vector<uint64_t> hashes;
    uint32_t frame = 0;
    for (const uint32_t saved : savedFrames) {
        if (saved >= end) continue;
        first.run(frame, saved);
        bytes.push_back(first.save());
        hashes.push_back(first.hash());
        frame = saved;
    }
    first.run(frame, end);
    const uint64_t last = first.hash();
    EXPECT_GE(first.burning(), 4u);
    for (size_t i = 0; i < bytes.size(); ++i) {
        BusyWorld other(loads);
        if (!there(other)) GTEST_SKIP() << "there is no such backend here";
        ASSERT_EQ(FW_OK, other.load(bytes[i])) << lastMessage(other.world);
        EXPECT_EQ(hashes[i], other.hash()) << "at " << savedFrames[i];
        EXPECT_EQ(bytes[i], other.save()) << "saved again, at " << savedFrames[i];
        other.run(savedFrames[i], end);
        EXPECT_EQ(last, other.hash()) << "from " << savedFrames[i];
    }
}

TEST(Save, ContinuesIdentically) { continuesIdentically(FW_BACKEND_CPU, FW_BACKEND_CPU, 260); }
TEST(Save, ContinuesIdenticallyOnADevice) {
    continuesIdentically(FW_BACKEND_VULKAN, FW_BACKEND_VULKAN, 150);
}
TEST(Save, MovesFromADeviceToTheCpu) {
    continuesIdentically(FW_BACKEND_VULKAN, FW_BACKEND_CPU, 110);
}
TEST(Save, MovesFromTheCpuToADevice) {
    continuesIdentically(FW_BACKEND_CPU, FW_BACKEND_VULKAN, 110);
}

// Loads into the same world twice, from a later and from an earlier frame.
void rewinds(uint32_t backend) {
    BusyWorld w(backend);
    if (!there(w)) GTEST_SKIP() << "there is no such backend here";
    w.run(0, 70);
    const Bytes bytes = w.save();
    const uint64_t then = w.hash();
    w.run(70, 150);
    const uint64_t later = w.hash();
    EXPECT_NE(then, later);
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(FW_OK, w.load(bytes)) << lastMessage(w.world);
        EXPECT_EQ(then, w.hash());
        w.run(70, 150);
        EXPECT_EQ(later, w.hash());
    }
}
TEST(Save, RewindsTheSameWorld) { rewinds(FW_BACKEND_CPU); }
TEST(Save, RewindsTheSameWorldOnADevice) { rewinds(FW_BACKEND_VULKAN); }

// Rewinds to before the first fire, also in a world that never had the save's wind: a fire lit then
// burns in that wind.
void rewindsToBeforeTheFire(uint32_t backend) {
    BusyWorld w(backend);
    if (!there(w)) GTEST_SKIP() << "there is no such backend here";
    const float wind[3] = {2, 0, 1};
    EXPECT_EQ(FW_OK, fwWorld_SetWind(w.world, wind));
    w.run(0, 1);
    const Bytes bytes = w.save();
    w.run(1, 60);
    const uint64_t then = w.hash();
    w.run(60, 90);
    ASSERT_EQ(FW_OK, w.load(bytes)) << lastMessage(w.world);
    w.run(1, 60);
    EXPECT_EQ(then, w.hash());
    BusyWorld other(backend);
    ASSERT_EQ(FW_OK, other.load(bytes)) << lastMessage(other.world);
    other.run(1, 60);
    EXPECT_EQ(then, other.hash());
}
TEST(Save, RewindsToBeforeTheFirstFire) { rewindsToBeforeTheFire(FW_BACKEND_CPU); }
TEST(Save, RewindsToBeforeTheFirstFireOnADevice) { rewindsToBeforeTheFire(FW_BACKEND_VULKAN); }

// A sleeping world stays asleep: the wind of its first fire starts with that fire, not at the load.
TEST(Save, FirstFireAfterALoadIsIdentical) {
    uint64_t hashes[2] = {};
    for (const bool loads : {false, true}) {
        FwWorldDef def = worldDef(FW_WORLD_CONTACT | FW_WORLD_EMBERS | FW_WORLD_RADIATION);
        def.paceFactor = 8;
        Panels panels(def);
        for (int i = 0; i < 8; ++i) (void)panels.add(0.43f * float(i % 4), 0, 0.23f * float(i / 4));
        for (uint32_t frame = 0; frame < 320; ++frame) {
            const float wind[3] = {4 * std::cos(0.02f * float(frame)), 0, 3};
            EXPECT_EQ(FW_OK, fwWorld_SetWind(panels.world, wind));
            FwBurnableMeshDef at = panels.def(1.72f, 0.001f * float(frame), 0);
            EXPECT_EQ(FW_OK, fwWorld_SetTransform(panels.world, panels.ids[7], at.transform));
            if (frame == 80) panels.ignite(panels.ids[0], 0.2f, 0, 0.1f, 0.05f);
            panels.run(1.0 / 32);
            if (!loads || frame != 41) continue;
            EXPECT_EQ(FW_OK, fwWorld_RequestSave(panels.world));
            uint64_t size = 0;
            EXPECT_EQ(FW_NOT_READY, fwWorld_FetchSave(panels.world, nullptr, &size));
            EXPECT_EQ(FW_OK, fwWorld_Step(panels.world, 0));  // the frame of the save
            EXPECT_EQ(FW_OK, fwWorld_FetchSave(panels.world, nullptr, &size));
            Bytes bytes(size);
            EXPECT_EQ(FW_OK, fwWorld_FetchSave(panels.world, bytes.data(), &size));
            EXPECT_EQ(FW_OK, fwWorld_Load(panels.world, bytes.data(), size));
        }
        EXPECT_GT(panels.alight(), 2u);
        hashes[loads] = panels.hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// The device is lost at some frame. From the last save that was fetched, or that the lost world
// still holds, the fire continues on another device or without one.
TEST(Save, SurvivesALostDevice) {
    const uint32_t losses[] = {26, 41};
    for (const uint32_t loss : losses) {
        BusyWorld w(FW_BACKEND_VULKAN);
        if (!there(w)) GTEST_SKIP() << "there is no such backend here";
        w.run(0, loss - 5);
        const Bytes mirror = w.save();
        const uint64_t then = w.hash();
        w.run(loss - 5, loss);
        fwContext_NotifyDeviceLost(w.context);
        EXPECT_EQ(FW_ERROR_DEVICE_LOST, fwWorld_Step(w.world, 1.0f / 32));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("lost")) << lastMessage(w.world);
        uint64_t size = mirror.size();
        Bytes again(mirror.size());
        EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, again.data(), &size)) << lastMessage(w.world);
        EXPECT_EQ(mirror, again);
        BusyWorld plain(FW_BACKEND_CPU);  // a world without a device
        plain.run(0, loss + 10);
        const uint64_t later = plain.hash();
        for (const uint32_t backend : {FW_BACKEND_VULKAN, FW_BACKEND_CPU}) {
            BusyWorld other(backend);
            ASSERT_EQ(FW_OK, other.load(mirror)) << lastMessage(other.world);
            EXPECT_EQ(then, other.hash()) << loss;
            other.run(loss - 5, loss + 10);
            EXPECT_EQ(later, other.hash()) << loss;
        }
    }
}

void expectSaveRefused(BusyWorld& w, const Bytes& bytes, const char* says) {
    const uint64_t before = w.hash();
    EXPECT_EQ(FW_ERROR_BAD_DATA, w.load(bytes)) << says;
    EXPECT_NE(std::string::npos, lastMessage(w.world).find(says)) << lastMessage(w.world);
    EXPECT_EQ(before, w.hash()) << says;
}

TEST(Save, RefusesSavesOfOtherWorlds) {
    BusyWorld w(FW_BACKEND_CPU);
    w.run(0, 30);
    const Bytes bytes = w.save();
    Bytes wrong = bytes;
    wrong[0] ^= 1;
    expectSaveRefused(w, wrong, "\"FWSV\"");
    wrong = bytes;
    wrong[4] = 99;
    expectSaveRefused(w, wrong, "format version 99");
    wrong = bytes;
    wrong[bytes.size() / 2] ^= 0x10;
    expectSaveRefused(w, wrong, "checksum");
    wrong.assign(bytes.begin(), bytes.end() - 1);
    expectSaveRefused(w, wrong, "bytes of content; its header says");
    wrong.assign(bytes.begin(), bytes.begin() + 11);
    expectSaveRefused(w, wrong, "has 11 bytes");
    expectSaveRefused(w, {}, "has 0 bytes");
    BusyWorld slower(FW_BACKEND_CPU, 11);
    expectSaveRefused(slower, bytes, "FwWorldDef::paceFactor is 12; this world's is 11");
    BusyWorld fewer(FW_BACKEND_CPU, 12, 9);
    expectSaveRefused(fewer, bytes, "10 burnable meshes; this world has 9");
    uint64_t size = 3;
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchSave(fewer.world, nullptr, &size));
    EXPECT_NE(std::string::npos, lastMessage(fewer.world).find("request it first"));
    unsigned char few[3];
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchSave(w.world, few, &size));
    EXPECT_EQ(bytes.size(), size);
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_FetchSave(w.world, few, nullptr));
    EXPECT_EQ(FW_ERROR_INVALID_ARGUMENT, fwWorld_Load(w.world, nullptr, 0));
}

// With a correct checksum it is loaded or refused with a message, and the world continues.
TEST(Save, DamagedSavesNeverCrash) {
    BusyWorld w(FW_BACKEND_CPU, 12, 5);
    w.run(0, 40);
    const Bytes bytes = w.save();
    uint32_t random = 7, refused = 0;
    const auto next = [&](uint32_t most) {
        random = random * 1664525u + 1013904223u;
        return uint32_t((uint64_t(random) * most) >> 32);
    };
    for (int i = 0; i < 400; ++i) {
        Bytes wrong = bytes;
        const uint32_t kind = next(8);
        if (kind == 0) wrong.resize(24 + next(uint32_t(bytes.size() - 24)));
        const uint32_t changes = 1 + next(4);
        for (uint32_t k = 0; k < changes && wrong.size() > 24; ++k) {
            // Half of the damage hits the numbers of the world and its objects.
            const auto most = uint32_t(wrong.size() - 24);
            const uint32_t at = 24 + next(next(2) ? most : std::min(most, 900u));
            wrong[at] = kind == 1 ? 0xFF : (unsigned char)(wrong[at] ^ (1u << next(8)));
        }
        signSave(wrong);
        const FwResult result = w.load(wrong);
        if (result != FW_OK) {
            EXPECT_EQ(FW_ERROR_BAD_DATA, result) << lastMessage(w.world);
            EXPECT_FALSE(lastMessage(w.world).empty());
            ++refused;
        }
        EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 1.0f / 16)) << lastMessage(w.world);
    }
    EXPECT_GT(refused, 40u);
    EXPECT_EQ(FW_OK, w.load(bytes)) << lastMessage(w.world);
    EXPECT_EQ(bytes, w.save());
}

}  // namespace
