// Random sessions. A save of every frame loads into a new world and into a used one, which then go
// on as the original does: in state, figures, events and the bytes of later saves. And both
// backends tell the same of a session.
#include "abi/random_session.h"

#include <algorithm>

namespace {

using namespace host;

struct Kept {  // of a frame
    Bytes save;
    std::vector<std::string> reported;
    std::string figures;
};

// A frame as all of them live it: the save is of its end.
Kept live(SessionWorld& w, uint32_t frame) {
    Kept kept;
    w.act(frame);
    EXPECT_EQ(FW_OK, fwWorld_RequestSave(w.world)) << lastMessage(w.world);
    w.step(frame);
    uint64_t size = 0;
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, nullptr, &size)) << lastMessage(w.world);
    kept.save.resize(size);
    EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, kept.save.data(), &size));
    kept.figures = w.figures();
    if (w.session.polls[frame]) kept.reported = w.poll();
    return kept;
}

size_t differsAt(const Bytes& a, const Bytes& b) {
    size_t at = 24;
    while (at < std::min(a.size(), b.size()) && a[at] == b[at]) ++at;
    return at;
}

// Goes on from the save of `frame`; false where it does otherwise than the original.
bool goesOn(SessionWorld& w, const std::vector<Kept>& original, uint32_t frame, uint32_t frames,
            const char* which) {
    EXPECT_EQ(FW_OK, w.load(original[frame].save))
        << which << " world, save of frame " << frame << ": " << lastMessage(w.world);
    if (::testing::Test::HasFailure()) return false;
    EXPECT_EQ(original[frame].figures, w.figures()) << which << ", as loaded at " << frame;
    if (w.session.polls[frame]) {
        EXPECT_EQ(original[frame].reported, w.poll()) << which << ", as loaded at " << frame;
    }
    const auto end = uint32_t(std::min<size_t>(frame + 1 + frames, original.size()));
    for (uint32_t next = frame + 1; next < end; ++next) {
        const Kept kept = live(w, next);
        EXPECT_TRUE(original[next].save == kept.save)
            << which << ", loaded at " << frame << ": the save of frame " << next << " has "
            << kept.save.size() << " bytes, the original's " << original[next].save.size()
            << "; they differ at " << differsAt(original[next].save, kept.save);
        EXPECT_EQ(original[next].figures, kept.figures)
            << which << ", loaded at " << frame << ", frame " << next;
        EXPECT_EQ(original[next].reported, kept.reported)
            << which << ", loaded at " << frame << ", frame " << next;
        if (::testing::Test::HasFailure()) return false;
    }
    return true;
}

void savesOfEveryFrame(uint64_t seed, uint32_t frames, uint32_t goes) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Host host;
    FwContext* context = createCpuContext(host);
    const Bytes burn = burnOfSession(context);
    const Session session = SessionDraw(seed).draw(frames);
    std::vector<Kept> original;
    uint32_t events = 0;
    {
        SessionWorld first(context, session, burn);
        for (uint32_t frame = 0; frame < frames; ++frame) {
            original.push_back(live(first, frame));
            events += uint32_t(original.back().reported.size());
        }
    }
    for (uint32_t frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame)
        for (const bool used : {false, true}) {
            if (used && frame % 4 != 1) continue;
            SessionWorld other(context, session, burn);
            for (uint32_t past = 0; past <= frame; ++past) other.build(past);
            if (used) other.liveOtherwise(6);
            if (!goesOn(other, original, frame, goes, used ? "used" : "new")) break;
        }
    EXPECT_GT(events, 5u);
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
}

class SavedSession : public ::testing::TestWithParam<uint64_t> {};
TEST_P(SavedSession, GoesOnAlikeFromEveryFrame) { savesOfEveryFrame(GetParam(), 56, 9); }
INSTANTIATE_TEST_SUITE_P(Seeds, SavedSession, ::testing::Range<uint64_t>(1, 9));

// ---- two boxes that touch, of which the first burns ---------------------------------------------

class TouchingSheets {
 public:
    explicit TouchingSheets(FwContext* context) {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = 2;
        def.flags = FW_WORLD_CONTACT;
        EXPECT_EQ(FW_OK, fwCreateWorld(context, &def, &world));
        const Sheet sheet(0.3f, 0.3f);
        const FwMeshDef meshDef = sheet.def(64);
        EXPECT_EQ(FW_OK, fwWorld_CreateMesh(world, &meshDef, &mesh_));
        FwMaterialDef paper = fwDefaultMaterialDef();
        EXPECT_EQ(FW_OK, fwInitMaterialPreset(&paper, FW_MATERIAL_PAPER));
        EXPECT_EQ(FW_OK, fwWorld_CreateMaterial(world, &paper, &material_));
        for (int i = 0; i < 2; ++i) ids[i] = make(i);
    }
    TouchingSheets(const TouchingSheets&) = delete;
    TouchingSheets& operator=(const TouchingSheets&) = delete;
    ~TouchingSheets() { fwDestroyWorld(world); }

    void light() {
        FwIgnitionDef ball = fwDefaultIgnitionDef();
        ball.object = ids[0];
        ball.position[0] = ball.position[2] = 0.15f;
        ball.radius = 0.2f;
        EXPECT_EQ(FW_OK, fwWorld_Ignite(world, &ball, nullptr)) << lastMessage(world);
    }
    void step(int count) {
        for (int i = 0; i < count; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(world, 1.0f / 32));
    }
    void moveSecond(float x) {
        FwBurnableMeshDef at = fwDefaultBurnableMeshDef();
        at.transform[12] = x;
        EXPECT_EQ(FW_OK, fwWorld_SetTransform(world, ids[1], at.transform));
    }
    void dropSecond() { EXPECT_EQ(FW_OK, fwWorld_DestroyBurnableMesh(world, ids[1])); }
    void replaceSecond() {
        dropSecond();
        ids[1] = make(1);
    }
    FwResult load(const Bytes& bytes) { return fwWorld_Load(world, bytes.data(), bytes.size()); }
    uint32_t ignited(int i) {
        FwObjectState state{};
        state.structSize = sizeof state;
        EXPECT_EQ(FW_OK, fwWorld_GetObjectState(world, ids[i], &state));
        return state.ignited;
    }

    FwWorld* world = nullptr;
    FwBurnableMeshId ids[2] = {};

 private:
    FwBurnableMeshId make(int i) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh_;
        def.materials[0] = material_;
        def.transform[12] = kApart * float(i);
        FwBurnableMeshId id{};
        EXPECT_EQ(FW_OK, fwWorld_CreateBurnableMesh(world, &def, &id)) << lastMessage(world);
        return id;
    }
    FwMeshId mesh_{};
    FwMaterialId material_{};

 public:
    static constexpr float kApart = 0.301f;
};

// Until both burn; compared in every save.
void expectAlike(TouchingSheets& a, TouchingSheets& b, int steps) {
    for (int i = 0; i < steps; ++i) {
        a.step(1);
        b.step(1);
        ASSERT_TRUE(saveOf(a.world) == saveOf(b.world)) << i << " steps later";
    }
    EXPECT_LT(0u, a.ignited(1)) << "the second sheet caught";
}

TEST(Save, LoadsAfterATouchingObjectWasDestroyed) {
    Host host;
    FwContext* context = createCpuContext(host);
    for (const int after : {1, 5, 20}) {
        TouchingSheets w(context);
        w.light();
        w.step(after);
        w.dropSecond();
        w.step(1);
        EXPECT_EQ(FW_OK, w.load(saveOf(w.world))) << lastMessage(w.world);
        w.step(4);
        EXPECT_EQ(FW_OK, w.load(saveOf(w.world))) << lastMessage(w.world);
    }
    fwDestroyContext(context);
}

TEST(Save, ATouchingPairThatIsPartedBurnsAlikeAfterALoad) {
    Host host;
    FwContext* context = createCpuContext(host);
    for (const int away : {1, 3, 4, 8}) {
        TouchingSheets a(context), b(context);
        a.light();
        a.step(12);
        ASSERT_EQ(FW_OK, b.load(saveOf(a.world))) << lastMessage(b.world);
        for (TouchingSheets* w : {&a, &b}) {
            w->moveSecond(3);
            w->step(away);
            w->moveSecond(TouchingSheets::kApart);
        }
        expectAlike(a, b, 90);
    }
    fwDestroyContext(context);
}

TEST(Save, AnObjectInTheSlotOfATouchingOneBurnsAlikeAfterALoad) {
    Host host;
    FwContext* context = createCpuContext(host);
    for (const int before : {4, 6, 11}) {
        TouchingSheets a(context), b(context);
        a.light();
        a.step(before);
        a.replaceSecond();
        b.replaceSecond();
        ASSERT_EQ(FW_OK, b.load(saveOf(a.world))) << lastMessage(b.world);
        expectAlike(a, b, 90);
    }
    fwDestroyContext(context);
}

// The save is of the frame whose readback says so: the event is in it, and the tag is not.
TEST(Save, ATagIsReportedOnceWhateverFrameIsSaved) {
    Host host;
    FwContext* context = createCpuContext(host);
    for (int frame = 1; frame < 40; ++frame) {
        TouchingSheets w(context);
        w.light();
        const float place[3] = {0.28f, 0, 0.28f};
        EXPECT_EQ(FW_OK, fwWorld_TagPoint(w.world, w.ids[0], place, 7));
        w.step(frame - 1);
        EXPECT_EQ(FW_OK, fwWorld_RequestSave(w.world));
        w.step(1);
        uint64_t size = 0;
        EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, nullptr, &size));
        Bytes bytes(size);
        EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, bytes.data(), &size));
        EXPECT_EQ(FW_OK, w.load(bytes)) << lastMessage(w.world);
        w.step(40);
        uint32_t reached = 0;
        FwEvent events[64];
        for (uint32_t count; (count = fwWorld_PollEvents(w.world, events, 64)) != 0;)
            for (uint32_t i = 0; i < count; ++i) reached += events[i].type == FW_EVENT_TAG_REACHED;
        EXPECT_EQ(1u, reached) << "saved in frame " << frame;
    }
    fwDestroyContext(context);
}

TEST(Save, OfAnOlderVersionIsRefusedByItsNumber) {
    Host host;
    FwContext* context = createCpuContext(host);
    {
        TouchingSheets w(context);
        Bytes bytes = saveOf(w.world);
        bytes[4] = 7;
        EXPECT_EQ(FW_ERROR_BAD_DATA, w.load(bytes));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("version 7"))
            << lastMessage(w.world);
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("older library"));
    }
    fwDestroyContext(context);
}

// ---- backends -----------------------------------------------------------------------------------

FwContext* createDeviceContext(Host& host) {
    FwContextDef def = fwDefaultContextDef();
    def.backend = FW_BACKEND_VULKAN;
    def.callbacks = host.callbacks();
    FwContext* context = nullptr;
    FwErrorInfo error{};
    return fwCreateContext(&def, &context, &error) == FW_OK ? context : nullptr;
}

// Until all readbacks are here.
void settle(SessionWorld& w) {
    for (int i = 0; i < 6; ++i) EXPECT_EQ(FW_OK, fwWorld_Step(w.world, 0)) << lastMessage(w.world);
}

bool drops(const Session& session, uint32_t frame) {
    return std::any_of(session.frames[frame].begin(), session.frames[frame].end(),
                       [](const Act& act) {
                           return act.kind == Act::dropObject || act.kind == Act::dropRoom ||
                                  act.kind == Act::moveObject;
                       });
}

// A device tells of frames some frames later. What is reported of them, figures and saves are alike
// once all of them are here; things are moved and dropped only then, as the places of events are
// those at which things are when they are reported.
void backendsAgree(uint64_t seed, uint32_t frames) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Host hosts[2];
    FwContext* contexts[2] = {createCpuContext(hosts[0]), createDeviceContext(hosts[1])};
    if (!contexts[1]) {
        fwDestroyContext(contexts[0]);
        GTEST_SKIP() << "there is no device here";
    }
    const Bytes burn = burnOfSession(contexts[0]);
    const Session session = SessionDraw(seed).draw(frames);
    {
        SessionWorld cpu(contexts[0], session, burn), device(contexts[1], session, burn);
        for (uint32_t frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame) {
            const bool saves = frame % 8 == 7;
            Bytes bytes[2];
            std::vector<std::string> reported[2];
            std::string figures[2];
            SessionWorld* const both[2] = {&cpu, &device};
            for (int k = 0; k < 2; ++k) {
                SessionWorld& w = *both[k];
                if (drops(session, frame)) {
                    settle(w);
                    reported[k] = w.poll();
                }
                w.act(frame);
                if (saves) {
                    EXPECT_EQ(FW_OK, fwWorld_RequestSave(w.world));
                }
                w.step(frame);
                if (!saves) continue;
                settle(w);
                uint64_t size = 0;
                EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, nullptr, &size));
                bytes[k].resize(size);
                EXPECT_EQ(FW_OK, fwWorld_FetchSave(w.world, bytes[k].data(), &size));
                figures[k] = w.figures();
                const std::vector<std::string> more = w.poll();
                reported[k].insert(reported[k].end(), more.begin(), more.end());
            }
            for (std::vector<std::string>& all : reported) std::sort(all.begin(), all.end());
            EXPECT_EQ(reported[0], reported[1]) << "frame " << frame;
            EXPECT_EQ(figures[0], figures[1]) << "frame " << frame;
            EXPECT_TRUE(bytes[0] == bytes[1])
                << "frame " << frame << ": saves of " << bytes[0].size() << " and "
                << bytes[1].size() << " bytes differ at " << differsAt(bytes[0], bytes[1]);
        }
    }
    fwDestroyContext(contexts[0]);
    fwDestroyContext(contexts[1]);
}

class AgreedSession : public ::testing::TestWithParam<uint64_t> {};
TEST_P(AgreedSession, IsAlikeOnBothBackends) { backendsAgree(GetParam(), 48); }
INSTANTIATE_TEST_SUITE_P(Seeds, AgreedSession, ::testing::Range<uint64_t>(101, 104));

}  // namespace
