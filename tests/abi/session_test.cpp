// Random sessions and a scripted game. The save of every frame loads into a new and a used world,
// which continue like the original in state, figures, events and later saves. Both backends agree
// on a session, and a world whose origin moves agrees too.
#include "abi/scripted_game.h"

#include <algorithm>

namespace {

using namespace host;

struct Kept {  // results of one frame
    Bytes save;
    std::vector<std::string> reported;
    std::string figures;
};

// Runs one frame; the save is of its end.
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

// Continues from the save of `frame`; false if the result differs from the original.
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

// How far loaded worlds are followed.
struct Following {
    uint32_t frames = 9;        // frames after each save
    uint32_t usedEvery = 4;     // every such save is also loaded into a used world
    uint32_t wholeEvery = ~0u;  // every such save is followed to the end of the session
};

void savesOfEveryFrame(FwContext* context, const Session& session, const Bytes& burn,
                       const Following& following, std::vector<std::string>* reported = nullptr) {
    const auto frames = uint32_t(session.frames.size());
    std::vector<Kept> original;
    uint32_t events = 0;
    {
        SessionWorld first(context, session, burn);
        for (uint32_t frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame) {
            original.push_back(live(first, frame));
            const std::vector<std::string>& now = original.back().reported;
            events += uint32_t(now.size());
            if (reported) reported->insert(reported->end(), now.begin(), now.end());
        }
    }
    for (uint32_t frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame)
        for (const bool used : {false, true}) {
            if (used && frame % following.usedEvery != 1) continue;
            SessionWorld other(context, session, burn);
            for (uint32_t past = 0; past <= frame; ++past) other.build(past);
            if (used) other.liveOtherwise(6);
            const bool whole = frame % following.wholeEvery == following.wholeEvery / 2;
            if (!goesOn(other, original, frame, whole ? frames : following.frames,
                        used ? "used" : "new"))
                break;
        }
    EXPECT_GT(events, 5u);
}

class SavedSession : public ::testing::TestWithParam<uint64_t> {};
TEST_P(SavedSession, ContinuesIdenticallyFromEveryFrame) {
    Host host;
    FwContext* context = createCpuContext(host);
    savesOfEveryFrame(context, SessionDraw(GetParam()).draw(56), burnOfSession(context), {});
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
}
INSTANTIATE_TEST_SUITE_P(Seeds, SavedSession, ::testing::Range<uint64_t>(1, 9));

TEST(SavedGame, ContinuesIdenticallyFromEveryFrame) {
    Host host;
    FwContext* context = createCpuContext(host);
    Following following;
    following.frames = 5;
    following.wholeEvery = 40;
    std::vector<std::string> reported;
    savesOfEveryFrame(context, ScriptedGame::play(), {}, following, &reported);
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
    // The game must raise many types of events.
    for (const uint32_t type :
         {FW_EVENT_IGNITED, FW_EVENT_BURNT_OUT, FW_EVENT_EXTINGUISHED, FW_EVENT_TAG_REACHED,
          FW_EVENT_SPREAD_TO, FW_EVENT_SPOT_FIRE, FW_EVENT_STRUCTURE_BROKE})
        EXPECT_TRUE(std::any_of(reported.begin(), reported.end(),
                                [&](const std::string& line) {
                                    return line.starts_with("type " + std::to_string(type) + " ");
                                }))
            << "no event of type " << type;
}

// ---- two touching boxes, of which the first burns

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
        FwMaterialDef paper = materialOf(FW_MATERIAL_PAPER);
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
    uint32_t ignited(int i) { return getState(fwWorld_GetObjectState, world, ids[i]).ignited; }

    FwWorld* world = nullptr;
    FwBurnableMeshId ids[2] = {};

 private:
    FwBurnableMeshId make(int i) {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = mesh_;
        def.materials[0] = material_;
        def.transform[12] = kApart * float(i);
        return created(fwWorld_CreateBurnableMesh, world, def);
    }
    FwMeshId mesh_{};
    FwMaterialId material_{};

 public:
    static constexpr float kApart = 0.301f;
};

// Compares every save until both burn.
void expectEqual(TouchingSheets& a, TouchingSheets& b, int steps) {
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

TEST(Save, ASeparatedPairBurnsIdenticallyAfterALoad) {
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
        expectEqual(a, b, 90);
    }
    fwDestroyContext(context);
}

TEST(Save, AReusedSlotOfATouchingObjectBurnsIdenticallyAfterALoad) {
    Host host;
    FwContext* context = createCpuContext(host);
    for (const int before : {4, 6, 11}) {
        TouchingSheets a(context), b(context);
        a.light();
        a.step(before);
        a.replaceSecond();
        b.replaceSecond();
        ASSERT_EQ(FW_OK, b.load(saveOf(a.world))) << lastMessage(b.world);
        expectEqual(a, b, 90);
    }
    fwDestroyContext(context);
}

// The save is of the frame whose readback reports it: the event is in the save, the tag is not.
TEST(Save, ATagIsReportedOnceWhicheverFrameIsSaved) {
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

TEST(Save, RefusesAnOlderVersionByItsNumber) {
    Host host;
    FwContext* context = createCpuContext(host);
    {
        TouchingSheets w(context);
        Bytes bytes = saveOf(w.world);
        bytes[4] = 8;
        EXPECT_EQ(FW_ERROR_BAD_DATA, w.load(bytes));
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("version 8"))
            << lastMessage(w.world);
        EXPECT_NE(std::string::npos, lastMessage(w.world).find("older library"));
    }
    fwDestroyContext(context);
}

// ---- backends

// A device reports frames some frames later. Events, figures and saves agree once all readbacks
// have arrived. Objects move and drop only then, because event places are those at the time of the
// report.
void backendsAgree(uint64_t seed, uint32_t frames) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Host hosts[2];
    FwContext* contexts[2] = {createCpuContext(hosts[0]),
                              createContext(hosts[1], FW_BACKEND_VULKAN)};
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
TEST_P(AgreedSession, AgreesOnBothBackends) { backendsAgree(GetParam(), 48); }
INSTANTIATE_TEST_SUITE_P(Seeds, AgreedSession, ::testing::Range<uint64_t>(101, 104));

// ---- a world whose origin moves

struct Reported {
    std::vector<std::string> words;
    std::vector<SessionWorld::Place> places;
};
void expectEqual(const Reported& still, const Reported& shifted) {
    EXPECT_EQ(still.words, shifted.words);
    ASSERT_EQ(still.places.size(), shifted.places.size());
    for (size_t i = 0; i < still.places.size(); ++i)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(still.places[i].at[k], shifted.places[i].at[k], 0.05)
                << "of event " << i << ": " << still.words[i];
}

// Places in the second world are those of the first relative to its origin; everything else is
// equal. Its save, loaded and moved back, equals the first world's.
void shiftsChangeNothingElse(uint32_t backend, uint64_t seed, uint32_t frames) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Host host;
    FwContext* context = createContext(host, backend);
    if (!context) GTEST_SKIP() << "there is no device here";
    const Bytes burn = burnOfSession(context);
    const Session moves = SessionDraw(seed, true).draw(frames);
    Session stays = moves;
    size_t shifts = 0;
    for (std::vector<Act>& acts : stays.frames)
        shifts += std::erase_if(acts, [](const Act& act) { return act.kind == Act::shift; });
    {
        SessionWorld still(context, stays, burn), shifted(context, moves, burn);
        SessionWorld* const both[2] = {&still, &shifted};
        Reported reported[2];
        const auto poll = [&](int k) {
            const std::vector<std::string> more = both[k]->poll(&reported[k].places);
            reported[k].words.insert(reported[k].words.end(), more.begin(), more.end());
        };
        for (uint32_t frame = 0; frame < frames && !::testing::Test::HasFailure(); ++frame) {
            SCOPED_TRACE("frame " + std::to_string(frame));
            const bool settles = drops(moves, frame);
            Bytes saves[2];
            uint64_t hashes[2] = {};
            std::string figures[2];
            for (int k = 0; k < 2; ++k) {
                SessionWorld& w = *both[k];
                if (settles) settle(w);
                if (settles) poll(k);
                w.act(frame);
                w.step(frame);
                if (frame % 8 != 7) continue;
                settle(w);
                poll(k);
                figures[k] = w.figures();
                hashes[k] = w.hash();
                saves[k] = saveOf(w.world);
            }
            if (frame % 8 != 7) continue;
            expectEqual(reported[0], reported[1]);
            reported[0] = reported[1] = {};
            EXPECT_EQ(figures[0], figures[1]);
            EXPECT_EQ(hashes[0], hashes[1]);
            SessionWorld back(context, moves, burn);
            for (uint32_t past = 0; past <= frame; ++past) back.build(past);
            ASSERT_EQ(FW_OK, back.load(saves[1])) << lastMessage(back.world);
            back.shift(-back.origin[0], -back.origin[1], -back.origin[2]);
            const Bytes again = saveOf(back.world);
            EXPECT_TRUE(saves[0] == again)
                << "saves of " << saves[0].size() << " and " << again.size() << " bytes differ at "
                << differsAt(saves[0], again);
        }
    }
    EXPECT_GT(shifts, 0u);
    fwDestroyContext(context);
    EXPECT_EQ(0, host.blocks);
}

class ShiftedSession : public ::testing::TestWithParam<uint64_t> {};
TEST_P(ShiftedSession, DiffersOnlyByItsOrigin) {
    shiftsChangeNothingElse(FW_BACKEND_CPU, GetParam(), 64);
}
INSTANTIATE_TEST_SUITE_P(Seeds, ShiftedSession, ::testing::Range<uint64_t>(201, 205));
class ShiftedSessionOnADevice : public ::testing::TestWithParam<uint64_t> {};
TEST_P(ShiftedSessionOnADevice, DiffersOnlyByItsOrigin) {
    shiftsChangeNothingElse(FW_BACKEND_VULKAN, GetParam(), 40);
}
INSTANTIATE_TEST_SUITE_P(Seeds, ShiftedSessionOnADevice, ::testing::Values(201u, 203u));

}  // namespace
