// Plays fixed sessions and prints hashes of their state, saves and events. Every exact build of the
// library, on any processor, operating system and backend, prints the text of sessions.txt.
// Usage: flamewright_portable [cpu | vulkan | upward]
//   upward: rounds upward and prints the library's warnings alone
#include "abi/scripted_game.h"
#include "common/options.h"
#include "common/yard.h"
#include "core/hash.h"
#include "game/bot.h"
#include "siege.h"
#include "world_def.h"

#include <algorithm>
#include <cfenv>
#include <cinttypes>
#include <cstdio>

namespace {

using namespace host;

uint64_t hashOfBytes(const void* bytes, size_t size) {
    return fw::core::hashBytes({static_cast<const std::byte*>(bytes), size});
}

struct Line {  // results at a frame of a session
    uint64_t state = 0;
    Bytes save;
    std::vector<std::string> events;  // since the session's previous line
};

void print(const std::string& session, uint32_t frame, Line& line) {
    // A device reports frames late, so only the set of events is the same.
    std::sort(line.events.begin(), line.events.end());
    std::string events;
    for (const std::string& event : line.events) events += event + "\n";
    std::printf("%-9s frame %3u  state %016" PRIx64 "  save %6zu bytes %016" PRIx64
                "  events %3zu %016" PRIx64 "\n",
                session.c_str(), frame, line.state, line.save.size(),
                hashOfBytes(line.save.data(), line.save.size()), line.events.size(),
                hashOfBytes(events.data(), events.size()));
    std::fflush(stdout);
}

void play(FwContext* context, const std::string& name, const Session& session, const Bytes& burn) {
    constexpr uint32_t kEvery = 16;  // frames between two lines
    SessionWorld w(context, session, burn);
    Line line;
    const auto poll = [&] {
        settle(w);
        for (std::string& event : w.poll()) line.events.push_back(std::move(event));
    };
    for (uint32_t frame = 0; frame < uint32_t(session.frames.size()); ++frame) {
        if (drops(session, frame)) poll();
        w.act(frame);
        w.step(frame);
        if (frame % kEvery != kEvery - 1) continue;
        poll();
        const std::string figures = w.figures();
        line.state = w.hash() * 31 + hashOfBytes(figures.data(), figures.size());
        line.save = saveOf(w.world);
        print(name, frame, line);
        line = {};
    }
}

// Cooked bytes of triangles at random places, with and without UVs of their own, and of a profile.
void playBakes(FwContext* context) {
    uint32_t random = 1;
    const auto number = [&] {
        random = random * 1664525u + 1013904223u;
        return float(random >> 8) / 16777216.0f;
    };
    Bytes bytes;
    uint64_t size = 0;
    for (uint32_t mesh = 0; mesh < 16; ++mesh) {
        const uint32_t vertices = 8 + 4 * mesh;
        std::vector<float> positions(vertices * 3), uvs(vertices * 2);
        std::vector<uint32_t> indices(vertices * 3);
        for (float& value : positions) value = number();
        for (float& value : uvs) value = number();
        for (uint32_t& index : indices) index = uint32_t(number() * float(vertices));
        FwMeshDef def = fwDefaultMeshDef();
        def.positions = positions.data();
        def.uvs = mesh % 2 == 0 ? uvs.data() : nullptr;
        def.flags = mesh % 4 == 0 ? FW_MESH_TRUST_UVS : 0;
        def.vertexCount = vertices;
        def.indices = indices.data();
        def.indexCount = vertices * 3;
        def.texelsPerMetre = 20 + 30 * number();
        def.noiseSeed = mesh;
        ASSERT_EQ(FW_OK, fwCookMesh(context, &def, nullptr, &size)) << lastMessage(context);
        bytes.resize(size);
        ASSERT_EQ(FW_OK, fwCookMesh(context, &def, bytes.data(), &size)) << lastMessage(context);
        std::printf("bake      mesh %2u  %zu bytes %016" PRIx64 "\n", mesh, bytes.size(),
                    hashOfBytes(bytes.data(), bytes.size()));
    }
    std::vector<float> texels(2 * 12 * 12);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = number() * (i % 2 == 0 ? 2000.0f : 1.0f);
    FwFireProfileDef def = fwDefaultFireProfileDef();
    def.width = def.height = 12;
    def.texels = texels.data();
    ASSERT_EQ(FW_OK, fwCookFireProfile(context, &def, nullptr, &size)) << lastMessage(context);
    bytes.resize(size);
    ASSERT_EQ(FW_OK, fwCookFireProfile(context, &def, bytes.data(), &size));
    std::printf("bake      profile  %zu bytes %016" PRIx64 "\n", bytes.size(),
                hashOfBytes(bytes.data(), bytes.size()));
}

// Crates that light each other in a wind, of which water meets some.
void playCrates(FwContext* context) {
    FwWorldDef def = fwDefaultWorldDef();
    def.flags = FW_WORLD_RADIATION | FW_WORLD_PLUME | FW_WORLD_CONTACT | FW_WORLD_EMBERS;
    def.paceFactor = 10;
    def.wind[0] = 1.5f;
    FwWorld* world = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
    const Yard yard = makeYard(world, 25);
    for (const uint32_t crate : {6u, 18u}) lightCrate(world, yard, crate);
    Line line;
    for (uint32_t frame = 0; frame < 320; ++frame) {
        if (frame == 160) {
            FwIgnitionDef water = fwDefaultIgnitionDef();
            water.kind = FW_WET;
            placeOf(yard, 12, water.position);
            water.radius = 1;
            water.water = 150;
            check(fwWorld_Ignite(world, &water, nullptr), world);
        }
        check(fwWorld_Step(world, 1.0f / 32), world);
        if (frame % 40 != 39) continue;
        line.state = hashOf(world, yard.crates);
        line.save = saveOf(world);
        FwEvent event;
        while (fwWorld_PollEvents(world, &event, 1) != 0) {
            char text[160];
            std::snprintf(text, sizeof text, "type %u tag %u of %u by %u at %.9g %.9g %.9g: %.9g",
                          event.type, event.tag, event.object.index1, event.other.index1,
                          double(event.position[0]), double(event.position[1]),
                          double(event.position[2]), double(event.value));
            line.events.emplace_back(text);
        }
        print("crates", frame, line);
        line = {};
    }
    fwDestroyWorld(world);
}

// The first wave of the sample game, by its scripted player.
void playGame(FwContext* context) {
    constexpr uint32_t kSeed = 1;
    constexpr int32_t kTicks = 4, kEvery = 96;
    const tower::Battlefield field = tower::makeBattlefield(kSeed);
    const FwWorldDef def = tower::villageWorld(kSeed, 14);
    FwWorld* world = nullptr;
    ASSERT_EQ(FW_OK, fwCreateWorld(context, &def, &world)) << lastMessage(context);
    tower::FireVillage fires(context, world, field.scene, nullptr);
    tower::Siege siege(world, fires, field, game::newGame(kSeed));
    const game::State& state = siege.state();
    Line line;
    while (state.outcome == game::Outcome::kPlaying && state.wave < 1) {
        siege.give(game::botsOrder(state));
        siege.advance(kTicks);
        check(fwWorld_Step(world, kTicks * tower::kTickSeconds), world);
        for (const game::Event& event : siege.events())
            line.events.emplace_back(reinterpret_cast<const char*>(&event), sizeof event);
        if (state.tick % kEvery != 0) continue;
        line.state = game::hashOf(state);
        line.save = saveOf(world);
        print("game", uint32_t(state.tick), line);
        line = {};
    }
    fwDestroyWorld(world);
}

void playSessions(FwContext* context) {
    playBakes(context);
    const Bytes burn = burnOfSession(context);
    for (uint32_t seed = 1; seed <= 10; ++seed)
        play(context, "random_" + std::to_string(seed), SessionDraw(seed).draw(64), burn);
    play(context, "script", ScriptedGame::play(), {});
    playCrates(context);
    playGame(context);
}

void run(const std::string& mode) {
    Host host;
    if (mode == "upward") std::fesetround(FE_UPWARD);
    FwContext* context = createContext(host, mode == "vulkan" ? FW_BACKEND_VULKAN : FW_BACKEND_CPU);
    if (!context) throw std::runtime_error("there is no Vulkan device here");
    if (mode != "upward") playSessions(context);
    fwDestroyContext(context);
    for (const std::string& warning : host.warnings) std::printf("log: %s\n", warning.c_str());
}

}  // namespace

int main(int argc, char** argv) {
    const std::string mode = argc > 1 ? argv[1] : "cpu";
    if (argc > 2 || (mode != "cpu" && mode != "vulkan" && mode != "upward")) {
        std::fprintf(stderr, "usage: flamewright_portable [cpu | vulkan | upward]\n");
        return 2;
    }
    int count = 1;
    ::testing::InitGoogleTest(&count, argv);
    GTEST_FLAG_SET(throw_on_failure, true);  // expectations of the shared helpers
    try {
        run(mode);
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "flamewright_portable: %s\n", failure.what());
        return 1;
    }
    return 0;
}
