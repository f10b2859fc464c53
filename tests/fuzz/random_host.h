// A random host on the cpu backend: calls in any order with arbitrary numbers, ids and bytes. Only
// pointers and array sizes are always valid.
#pragma once
#include "abi/abi_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace host {

// Numbers of xorshift64* from a seed, or from the bytes of a fuzzer's input, as few as will do;
// zeros after its end.
struct Random {
    uint64_t state = 0;
    std::span<const uint8_t> input;
    bool reads = false;
    explicit Random(uint64_t seed) : state(seed * 0x9E3779B97F4A7C15ull + 1) {}
    explicit Random(std::span<const uint8_t> bytes) : input(bytes), reads(true) {}
    uint32_t take(size_t bytes) {
        uint32_t value = 0;
        for (; bytes > 0 && !input.empty(); --bytes, input = input.subspan(1))
            value = value << 8 | input[0];
        return value;
    }
    uint32_t next() {
        if (reads) return take(4);
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        return uint32_t((state * 0x2545F4914F6CDD1Dull) >> 32);
    }
    uint32_t below(uint32_t n) {
        return (reads ? take(n <= 256 ? 1 : n <= 65536 ? 2 : 4) : next()) % n;
    }
    bool once(uint32_t in) { return below(in) == 0; }
    float unit() { return reads ? float(take(1)) / 256 : float(next() >> 8) / 16777216.0f; }
    float number() {  // mostly valid, sometimes arbitrary
        static constexpr float kOdd[] = {0.0f,
                                         -0.0f,
                                         1e-30f,
                                         -1.0f,
                                         1e9f,
                                         -1e9f,
                                         3.4e38f,
                                         1e-45f,
                                         std::numeric_limits<float>::infinity(),
                                         -std::numeric_limits<float>::infinity(),
                                         std::numeric_limits<float>::quiet_NaN()};
        if (reads) {
            const uint32_t byte = take(1);
            return byte < 11 ? kOdd[byte] : (float(byte) - 128) / (byte % 3 ? 128.0f : 12.0f);
        }
        if (once(24)) return kOdd[below(11)];
        return (unit() * 2 - 1) * (once(3) ? 10.0f : 1.0f);
    }
};

template <class Id>
struct Ids {
    std::vector<Id> known;  // newest last; a few stay after they were destroyed
    Id any(Random& random) const {
        if (random.once(40)) return Id{random.next() % 8, random.next() % 4};
        if (random.once(80)) return Id{random.next(), random.next()};
        if (known.empty()) return Id{};
        return known[known.size() - 1 - random.below(std::min(uint32_t(known.size()), 10u))];
    }
    void gone(Random& random, Id id) {
        if (!random.once(5))
            std::erase_if(known, [&](Id k) {
                return k.index1 == id.index1 && k.generation == id.generation;
            });
    }
};

class RandomHost {
 public:
    explicit RandomHost(Random random) : random_(random) {
        context_ = host::createCpuContext(host_);
        makeWorld();
        const host::Sheet sheet(0.2f, 0.2f);
        const FwMeshDef def = sheet.def(40);
        uint64_t size = 0;
        EXPECT_EQ(FW_OK, fwCookMesh(context_, &def, nullptr, &size));
        cooked_.resize(size);
        EXPECT_EQ(FW_OK, fwCookMesh(context_, &def, cooked_.data(), &size));
    }
    RandomHost(const RandomHost&) = delete;
    RandomHost& operator=(const RandomHost&) = delete;
    ~RandomHost() {
        fwDestroyContext(context_);
        EXPECT_EQ(0, host_.blocks);
        EXPECT_EQ(0, host_.bytes);
    }

    void run(int calls) {
        const auto ended = [&] { return random_.reads && random_.input.empty(); };
        for (int i = 0; i < calls && !ended() && !::testing::Test::HasFailure(); ++i) call();
    }
    uint64_t accepted = 0, refused = 0, meshes = 0, objects = 0, fires = 0, flames = 0, sought = 0;

 private:
    void makeWorld() {
        FwWorldDef def = fwDefaultWorldDef();
        def.paceFactor = 20;
        def.maxStepsPerFrame = 4;
        ASSERT_EQ(FW_OK, fwCreateWorld(context_, &def, &world_));
    }

    void check(FwResult result) {
        EXPECT_TRUE(result <= FW_NOTHING_THERE && result >= FW_ERROR_WRONG_BACKEND)
            << result << " " << lastMessage(world_);
        if (result < 0) {
            const std::string text = lastMessage(world_);
            EXPECT_NE(std::string::npos, text.find("\n - While calling fw")) << text;
        }
        ++(result < 0 ? refused : accepted);
    }

    // Changes some words of a struct; pointers are set afterwards.
    template <class Def>
    void garble(Def& def) {
        if (!random_.once(4)) return;
        auto* words = reinterpret_cast<unsigned char*>(&def);
        const uint32_t count = uint32_t(sizeof def / 4);
        for (uint32_t n = 1 + random_.below(3); n > 0; --n) {
            const uint32_t at = 4 * (1 + random_.below(count - 1));
            if (random_.once(2)) {
                const float value = random_.number();
                std::memcpy(words + at, &value, 4);
            } else {
                const uint32_t value = random_.once(2) ? random_.below(20) : random_.next();
                std::memcpy(words + at, &value, 4);
            }
        }
    }

    void createMesh() {
        FwMeshDef def = fwDefaultMeshDef();
        def.texelsPerMetre = 5 + random_.unit() * 40;
        def.mapSize = 8 + random_.below(120);
        const uint32_t vertices = 3 + random_.below(24);
        const uint32_t triangles = 1 + random_.below(24);
        std::vector<float> positions, uvs, normals;
        const bool wild = random_.once(3);
        for (uint32_t i = 0; i < vertices * 3; ++i)
            positions.push_back(wild ? random_.number() : random_.unit());
        for (uint32_t i = 0; i < vertices * 2; ++i)
            uvs.push_back(wild ? random_.number() : random_.unit());
        for (uint32_t i = 0; i < vertices * 3; ++i) normals.push_back(random_.number());
        std::vector<uint32_t> indices;
        std::vector<uint16_t> narrow;
        const uint32_t reach = random_.once(10) ? vertices + 2 : vertices;
        for (uint32_t i = 0; i < triangles * 3; ++i) {
            indices.push_back(random_.below(reach));
            narrow.push_back(uint16_t(indices.back()));
        }
        std::vector<uint8_t> materials;
        for (uint32_t i = 0; i < triangles; ++i)
            materials.push_back(uint8_t(random_.below(random_.once(5) ? 256 : 8)));
        garble(def);
        def.vertexCount = vertices;
        def.indexCount = triangles * 3 - (random_.once(30) ? 1 : 0);
        def.mapSize = std::min(def.mapSize, 256u);  // keeps a case small
        def.indexSize = random_.once(30) ? 3 : (random_.once(2) ? 2 : 4);
        def.indices = def.indexSize == 2 ? static_cast<const void*>(narrow.data())
                                         : static_cast<const void*>(indices.data());
        def.positions = random_.once(40) ? nullptr : positions.data();
        def.uvs = random_.once(2) ? uvs.data() : nullptr;
        def.normals = random_.once(2) ? normals.data() : nullptr;
        def.details = nullptr;
        def.colors = nullptr;
        def.triangleMaterials = random_.once(2) ? materials.data() : nullptr;
        def.cooked = nullptr;
        def.cookedSize = 0;
        def.structSize = sizeof def;
        FwMeshId id{};
        const FwResult result = fwWorld_CreateMesh(world_, &def, &id);
        check(result);
        if (result == FW_OK) {
            meshes_.known.push_back(id);
            ++meshes;
        }
    }

    void createCooked() {
        std::vector<unsigned char> bytes = cooked_;
        for (uint32_t n = random_.below(4); n > 0; --n)
            bytes[random_.below(uint32_t(bytes.size()))] ^= uint8_t(1 + random_.below(255));
        if (random_.once(3)) bytes.resize(random_.below(uint32_t(bytes.size())) + 1);
        FwMeshDef def = fwDefaultMeshDef();
        def.cooked = bytes.data();
        def.cookedSize = bytes.size();
        FwMeshId id{};
        const FwResult result = fwWorld_CreateMesh(world_, &def, &id);
        check(result);
        if (bytes != cooked_) {
            EXPECT_TRUE(result == FW_ERROR_BAD_DATA || result == FW_OK) << lastMessage(world_);
        }
        if (result == FW_OK) meshes_.known.push_back(id);
    }

    void createObject() {
        FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
        def.mesh = meshes_.any(random_);
        for (int i = 0; i < 3; ++i) def.materials[i] = materials_.any(random_);
        if (random_.once(5)) def.baseColor = images_.any(random_);
        for (int i = 12; i < 15; ++i) def.transform[i] = random_.unit();
        if (random_.once(6)) def.transform[random_.below(16)] = random_.number();
        def.flags = random_.below(random_.once(9) ? 64 : 16);
        std::vector<uint8_t> multiplier(64);
        for (uint8_t& m : multiplier) m = uint8_t(random_.below(256));
        if (objects % 3 == 0) def.breakArea = 1e-4f;
        if (objects % 4 == 0) def.breakShare = 0.2f;
        garble(def);
        def.multiplier = random_.once(3) ? multiplier.data() : nullptr;
        def.multiplierWidth = random_.once(20) ? 0 : 8;
        def.multiplierHeight = 8;
        const FwPin pins[8]{};
        def.pins = random_.once(2) ? pins : nullptr;
        def.structSize = sizeof def;
        FwBurnableMeshId id{};
        const FwResult result = fwWorld_CreateBurnableMesh(world_, &def, &id);
        check(result);
        if (result == FW_OK) {
            objects_.known.push_back(id);
            ++objects;
        }
    }

    void createFlame() {
        FwVolumetricFireDef def = fwDefaultVolumetricFireDef();
        (void)fwInitFirePreset(&def, random_.below(10));
        for (float& x : def.position) x = random_.unit();
        FwFirePoint points[32];
        for (FwFirePoint& point : points) {
            for (float& x : point.position) x = random_.once(9) ? 0.5f : random_.number();
            point.radius = random_.once(5) ? 0.0f : random_.unit();
        }
        garble(def);
        def.pointCount = random_.once(2) ? 0 : random_.below(35);
        def.points = random_.once(20) ? nullptr : points;
        def.profile = random_.once(3) ? profiles_.any(random_) : FwFireProfileId{};
        if (def.pointCount > 32 && def.points) def.pointCount = 32;  // valid array sizes
        def.structSize = sizeof def;
        FwVolumetricFireId id{};
        const FwResult result = fwWorld_CreateVolumetricFire(world_, &def, &id);
        check(result);
        if (result == FW_OK) {
            flames_.known.push_back(id);
            ++flames;
        }
    }

    // Saves, and loads of complete or damaged saves into a world that may have changed since.
    void useSaves() {
        const FwResult asked = fwWorld_RequestSave(world_);
        check(asked);
        check(fwWorld_Step(world_, 0));
        uint64_t size = 0;
        if (asked == FW_OK && fwWorld_FetchSave(world_, nullptr, &size) == FW_OK) {
            std::vector<unsigned char> bytes(size);
            check(fwWorld_FetchSave(world_, bytes.data(), &size));
            if (saved_.empty() || random_.once(2)) saved_.swap(bytes);
        }
        if (saved_.empty()) return;
        std::vector<unsigned char> bytes = saved_;
        if (random_.once(3)) bytes[random_.below(uint32_t(bytes.size()))] ^= 1u << random_.below(8);
        if (random_.once(5)) bytes.resize(random_.below(uint32_t(bytes.size())) + 1);
        check(fwWorld_Load(world_, bytes.data(), bytes.size()));
    }

    // Timelines of any size; ticks inside and outside, some out of reach.
    void useTimeline() {
        FwTimelineDef def = fwDefaultTimelineDef();
        def.interval = 0.1f + random_.unit();
        if (random_.once(3)) def.bytes = 65536 + random_.below(100000);
        garble(def);
        def.structSize = sizeof def;
        FwTimelineState state{};
        state.structSize = sizeof state;
        check(fwWorld_GetTimelineState(world_, &state));
        if (state.endTick == 0 || random_.once(20)) {
            check(fwWorld_StartTimeline(world_, &def));
            check(fwWorld_Step(world_, random_.unit()));
        }
        if (random_.once(30)) check(fwWorld_StopTimeline(world_));
        const uint64_t most = std::max<uint64_t>(state.endTick - state.firstTick, 1);
        const uint64_t tick =
            random_.once(8) ? random_.next() : state.firstTick + random_.next() % most;
        for (uint32_t pieces = random_.below(6); pieces > 0; --pieces) {
            float seconds = 0;
            const FwResult result = fwWorld_Seek(world_, tick, &seconds);
            check(result);
            if (result != FW_OK) break;
            sought += seconds == 0;
            if (seconds == 0) break;
            check(fwWorld_Step(world_, random_.once(9) ? seconds / 2 : seconds));
        }
    }

    void createEmitter() {
        FwFireEmitterDef def = fwDefaultFireEmitterDef();
        def.flags = random_.below(64);
        def.shape = random_.below(5);
        for (float& x : def.position) x = random_.unit();
        for (float& x : def.extent) x = random_.number();
        garble(def);
        def.structSize = sizeof def;
        if (random_.once(2)) def.fireFlipbooks[random_.below(3)] = flipbooks_.any(random_);
        if (random_.once(2)) def.smokeFlipbooks[random_.below(2)] = flipbooks_.any(random_);
        FwFireEmitterId id{};
        const FwResult result = fwWorld_CreateFireEmitter(world_, &def, &id);
        check(result);
        if (result == FW_OK) emitters_.known.push_back(id);
    }
    void changeEmitter() {
        const FwFireEmitterId id = emitters_.any(random_);
        float place[3], way[3];
        for (float& x : place) x = random_.number();
        for (float& x : way) x = random_.number();
        FwFireEmitterState state{};
        state.structSize = sizeof state;
        switch (random_.below(4)) {
            case 0:
                check(fwWorld_MoveFireEmitter(world_, id, place, random_.once(2) ? way : nullptr));
                break;
            case 1:
                check(fwWorld_SetFireEmitterPower(world_, id, 1000 * random_.number()));
                break;
            case 2:
                check(fwWorld_SetFireEmitterHidden(world_, id, random_.below(2)));
                break;
            default:
                check(fwWorld_GetFireEmitterState(world_, id, &state));
                break;
        }
    }

    void useField() {
        if (fields_.known.size() < 6 || random_.once(20)) {
            FwParticleFieldDef def = fwDefaultParticleFieldDef();
            (void)fwInitFieldPreset(&def, random_.below(4));
            def.shape = random_.below(3);
            def.source = random_.below(3);
            garble(def);
            def.paint = def.walls = nullptr;
            def.width = std::min(def.width, 64u);
            def.structSize = sizeof def;
            FwParticleFieldId id{};
            const FwResult result = fwWorld_CreateParticleField(world_, &def, &id);
            check(result);
            if (result == FW_OK) fields_.known.push_back(id);
        }
        const FwParticleFieldId id = fields_.any(random_);
        float place[4];
        for (float& x : place) x = random_.number();
        switch (random_.below(4)) {
            case 0:
                check(fwWorld_MoveParticleField(world_, id, place,
                                                random_.once(2) ? place : nullptr));
                break;
            case 1:
                check(fwWorld_SetParticleFieldAmount(world_, id, 5 * random_.unit()));
                break;
            case 2:
                check(fwWorld_SetParticleFieldHidden(world_, id, random_.below(2)));
                break;
            default: {
                FwParticleFieldState state{};
                state.structSize = sizeof state;
                const FwResult result = fwWorld_GetParticleFieldState(world_, id, &state);
                check(result);
                if (result != FW_OK) break;
                EXPECT_EQ(state.emitted, state.inside + state.dead + state.out);
            }
        }
        if (random_.once(6)) destroy(fields_, fwWorld_DestroyParticleField);
    }

    void changeFlame() {
        const FwVolumetricFireId id = flames_.any(random_);
        float place[3];
        for (float& x : place) x = random_.number();
        FwFirePoint points[4];
        for (FwFirePoint& point : points) {
            for (float& x : point.position) x = random_.number();
            point.radius = random_.number();
        }
        switch (random_.below(5)) {
            case 0:
                check(fwWorld_MoveVolumetricFire(world_, id, place));
                break;
            case 1:
                check(fwWorld_SetVolumetricFirePower(world_, id, 100 * random_.number()));
                break;
            case 2:
                check(fwWorld_SetVolumetricFirePoints(world_, id, points, random_.below(5)));
                break;
            case 3:
                check(fwWorld_SetVolumetricFireHidden(world_, id, random_.below(2)));
                check(fwWorld_SetVolumetricFireTier(world_, id, random_.below(7)));
                break;
            default: {
                FwVolumetricFireState state{};
                state.structSize = sizeof state;
                const FwResult result = fwWorld_GetVolumetricFireState(world_, id, &state);
                check(result);
                if (result != FW_OK) break;
                for (int i = 0; i < 3; ++i) {
                    EXPECT_TRUE(std::isfinite(state.tip[i] + state.lightPosition[i]));
                    EXPECT_LE(state.boundsLow[i], state.boundsHigh[i]);
                }
                EXPECT_TRUE(std::isfinite(state.height + state.lightIntensity));
            }
        }
    }

    static float FW_CALL anyDistance(void* user, const float point[3], float normal[3]) {
        auto& random = *static_cast<Random*>(user);
        for (int i = 0; i < 3; ++i) normal[i] = random.number();
        return random.once(3) ? random.number() : point[1];
    }

    void createBook() {
        FwFlipbookDef def = fwDefaultFlipbookDef();
        def.preset = random_.below(FW_FLIPBOOK_PRESET_COUNT + 1);
        std::vector<unsigned char> bytes(random_.below(200));
        for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random_.below(256));
        if (bytes.size() > 8 && random_.once(2)) std::memcpy(bytes.data(), "FWBK\1\0\0", 8);
        if (random_.once(4)) {
            def.cooked = bytes.data();
            def.cookedSize = bytes.size();
        }
        FwFlipbookId id{};
        const FwResult result = fwWorld_CreateFlipbook(world_, &def, &id);
        check(result);
        if (result == FW_OK) flipbooks_.known.push_back(id);
        check(fwWorld_SetFlameFlipbooks(world_, flipbooks_.any(random_), flipbooks_.any(random_)));
    }

    void createProfile() {
        std::vector<float> texels;
        FwFireProfileDef def = fwDefaultFireProfileDef();
        def.width = 6 + random_.below(12);
        def.height = 6 + random_.below(12);
        for (uint32_t i = 0; i < def.width * def.height; ++i) {
            texels.push_back(random_.unit() * 2000);
            texels.push_back(random_.once(400) ? random_.number() : random_.unit());
        }
        def.texels = random_.once(20) ? nullptr : texels.data();
        std::vector<unsigned char> bytes;
        if (random_.once(2)) {
            uint64_t size = 0;
            if (fwCookFireProfile(context_, &def, nullptr, &size) == FW_OK) {
                bytes.resize(size);
                EXPECT_EQ(FW_OK, fwCookFireProfile(context_, &def, bytes.data(), &size));
                for (uint32_t n = random_.below(3); n > 0; --n)
                    bytes[random_.below(random_.once(2) ? 32 : uint32_t(size))] ^=
                        uint8_t(1 + random_.below(255));
                if (random_.once(4)) bytes.resize(1 + random_.below(uint32_t(size)));
                def.cooked = bytes.data();
                def.cookedSize = bytes.size();
            }
        }
        FwFireProfileId id{};
        const FwResult result = fwWorld_CreateFireProfile(world_, &def, &id);
        check(result);
        if (result == FW_OK) profiles_.known.push_back(id);
    }

    void shapeGrid() {
        FwGustDef gusts = fwDefaultGustDef();
        gusts.strength = random_.number();
        gusts.size = random_.number();
        garble(gusts);
        gusts.structSize = sizeof gusts;
        check(fwWorld_SetGusts(world_, &gusts));
        float velocities[3 * 64];  // as many as a damaged count may ask for below
        for (float& value : velocities) value = random_.number();
        FwWindGridDef grid = fwDefaultWindGridDef();
        grid.cellSize = random_.number();
        for (float& value : grid.origin) value = random_.number();
        garble(grid);
        grid.structSize = sizeof grid;
        uint64_t points = 1;
        for (const uint32_t count : grid.counts) points *= std::min(count, 65u);
        grid.velocities = points <= 64 && !random_.once(8) ? velocities : nullptr;
        check(fwWorld_SetWindGrid(world_, random_.once(6) ? nullptr : &grid));
    }
    void setHeatOcclusion() {
        uint8_t solid[512];  // as many as a damaged count may ask for below
        for (uint8_t& cell : solid) cell = uint8_t(random_.below(2));
        FwHeatOcclusionDef grid = fwDefaultHeatOcclusionDef();
        grid.cellSize = random_.number();
        for (float& value : grid.origin) value = random_.number();
        garble(grid);
        grid.structSize = sizeof grid;
        uint64_t cells = 1;
        for (const uint32_t count : grid.counts) cells *= std::min(count, 257u);
        grid.cells = cells <= 512 && !random_.once(8) ? solid : nullptr;
        grid.distance = nullptr;
        const FwBurnableMeshId one{1 + random_.below(4), 1};
        grid.objects = random_.once(4) ? nullptr : &one;
        grid.objectCount = std::min(grid.objectCount, 1u);
        check(fwWorld_SetHeatOcclusion(world_, random_.once(6) ? nullptr : &grid));
    }
    void shapeWind() {
        FwWindZoneDef def = fwDefaultWindZoneDef();
        def.shape = random_.below(4);
        def.flow = random_.below(4);
        def.blend = random_.below(2);
        for (float* vector : {def.position, def.axis, def.size})
            for (int i = 0; i < 3; ++i) vector[i] = random_.number();
        def.speed = random_.number();
        garble(def);
        def.structSize = sizeof def;
        if (random_.once(2)) {
            check(fwWorld_SetWindZone(world_, zones_.any(random_), &def));
            return;
        }
        shapeGrid();
        setHeatOcclusion();
        FwWindZoneId id{};
        const FwResult result = fwWorld_CreateWindZone(world_, &def, &id);
        check(result);
        if (result == FW_OK) zones_.known.push_back(id);
        float wind[3] = {}, point[3] = {random_.number(), random_.number(), random_.number()};
        const FwResult asked = fwWorld_GetWindAt(world_, point, wind);
        check(asked);
        for (const float value : wind) EXPECT_LE(std::abs(value), 120.1f) << asked;
    }
    void airRoom() {
        FwRoomDef def = fwDefaultRoomDef();
        for (float* vector : {def.position, def.halfSize})
            for (int i = 0; i < 3; ++i) vector[i] = random_.number();
        if (random_.once(4)) def.rotation[random_.below(4)] = random_.number();
        def.volume = random_.once(2) ? 0 : random_.number();
        def.vent = random_.number();
        def.oxygen = random_.unit();
        def.flags = random_.below(2);
        garble(def);
        def.structSize = sizeof def;
        FwRoomState state{};
        state.structSize = sizeof state;
        check(fwWorld_GetRoomState(world_, rooms_.any(random_), &state));
        EXPECT_LE(state.oxygen, 1.0f);
        EXPECT_LE(state.strength, 1.0f);
        if (random_.once(2)) {
            check(fwWorld_SetRoom(world_, rooms_.any(random_), &def));
            return;
        }
        FwRoomId id{};
        const FwResult result = fwWorld_CreateRoom(world_, &def, &id);
        check(result);
        if (result == FW_OK) rooms_.known.push_back(id);
    }
    // A burn of the object, sometimes damaged, played by any object.
    void useBurn(FwBurnableMeshId object) {
        check(fwWorld_RequestBurn(world_, object));
        uint64_t size = 0;
        FwResult result = fwWorld_FetchBurn(world_, object, nullptr, &size);
        check(result);
        if (result == FW_OK) {
            std::vector<unsigned char> bytes(size);
            check(fwWorld_FetchBurn(world_, object, bytes.data(), &size));
            if (random_.once(4)) bytes[random_.below(uint32_t(size))] ^= 1u << random_.below(8);
            FwBurnId id{};
            result = fwWorld_CreateBurn(world_, bytes.data(), size, &id);
            check(result);
            if (result == FW_OK) burns_.known.push_back(id);
        }
        check(fwWorld_PlayBurn(world_, objects_.any(random_), burns_.any(random_),
                               random_.unit() - 0.1f, random_.unit() * 20));
        if (random_.once(4)) check(fwWorld_StopBurn(world_, objects_.any(random_)));
        if (random_.once(4)) destroy(burns_, fwWorld_DestroyBurn);
    }
    void shapeCollider() {
        FwFireColliderDef def = fwDefaultFireColliderDef();
        def.kind = random_.below(8);
        for (float& x : def.position) x = random_.number();
        for (float& x : def.end) x = random_.number();
        for (float& x : def.normal) x = random_.number();
        def.columns = random_.below(6);
        def.rows = random_.below(6);
        garble(def);
        float heights[36];
        for (float& height : heights) height = random_.once(99) ? random_.number() : random_.unit();
        def.columns = std::min(def.columns, 6u);  // valid array sizes
        def.rows = std::min(def.rows, 6u);
        def.heights = random_.once(9) ? nullptr : heights;
        def.depths = random_.once(9) ? nullptr : heights;
        def.distance = random_.once(9) ? nullptr : &anyDistance;
        def.distanceData = &random_;
        def.structSize = sizeof def;
        if (random_.once(3)) {
            check(fwWorld_SetFireCollider(world_, colliders_.any(random_), &def));
            return;
        }
        FwFireColliderId id{};
        const FwResult result = fwWorld_AddFireCollider(world_, &def, &id);
        check(result);
        if (result == FW_OK) colliders_.known.push_back(id);
    }

    void scriptFlame() {
        std::vector<float> times;
        std::vector<FwFirePoint> points;
        FwFireTrackDef def = fwDefaultFireTrackDef();
        def.keyCount = random_.below(5);
        def.pointsPerKey = 1 + random_.below(5);
        for (uint32_t i = 0; i < def.keyCount; ++i)
            times.push_back(random_.once(20) ? random_.number() : float(i));
        for (uint32_t i = 0; i < def.keyCount * def.pointsPerKey; ++i) {
            FwFirePoint& point = points.emplace_back();
            for (float& x : point.position) x = random_.once(9) ? 0.5f : random_.number();
            point.radius = random_.unit();
        }
        def.times = random_.once(20) ? nullptr : times.data();
        def.points = points.data();
        def.flags = random_.below(3);
        def.weight = random_.once(3) ? random_.number() : 1;
        check(fwWorld_SetVolumetricFireTrack(world_, flames_.any(random_),
                                             random_.once(4) ? nullptr : &def));
    }

    void queryFlames() {
        float place[3];
        for (float& x : place) x = random_.number();
        FwFireSample answer{};
        answer.structSize = sizeof answer;
        FwResult result = fwWorld_SampleVolumetricFires(world_, place, &answer);
        check(result);
        if (result == FW_OK) {
            EXPECT_TRUE(answer.temperature >= 293.0f && answer.temperature < 4000.0f);
            EXPECT_TRUE(answer.heatFlux >= 0.0f && answer.heatFlux <= 2e5f);
            EXPECT_TRUE(std::isfinite(answer.gas[0] + answer.gas[1] + answer.gas[2]));
        }
        FwFireForce push{};
        push.structSize = sizeof push;
        result = fwWorld_GetVolumetricFireForce(world_, place, random_.number(), &push);
        check(result);
        if (result == FW_OK) {
            EXPECT_TRUE(std::isfinite(push.force[0] + push.force[1] + push.force[2]));
        }
        FwSurroundings at{};
        at.structSize = sizeof at;
        result = fwWorld_SampleSurroundings(world_, place, &at);
        check(result);
        if (result == FW_OK) {
            EXPECT_TRUE(at.temperature >= 293.0f && at.temperature < 4000.0f);
            EXPECT_TRUE(at.heatFlux >= 0.0f && at.heatFlux <= 2e5f);
            EXPECT_TRUE(at.danger >= 0.0f && std::isfinite(at.smoke) && at.nearest >= 0.0f);
        }
        float other[3], seen = -1;
        for (float& x : other) x = random_.number();
        result = fwWorld_SampleVisibility(world_, place, other, &seen);
        check(result);
        if (result == FW_OK) {
            EXPECT_TRUE(seen >= 0.0f && seen <= 1.0f);
        }
        FwBudgetDef budget = fwDefaultBudgetDef();
        budget.gpuMilliseconds = random_.number();
        budget.measuredMilliseconds = random_.number();
        check(fwWorld_SetBudget(world_, &budget));
        std::array<uint8_t, 24> mask{};
        const uint32_t columns = random_.below(7), rows = random_.once(6) ? 5000 : random_.below(5);
        if (columns * rows <= mask.size() || rows > 4096)
            check(fwWorld_MakeSafetyMask(world_, place, other, place, columns, rows, mask.data()));
    }

    template <class Id>
    void destroy(Ids<Id>& ids, FwResult(FW_CALL* function)(FwWorld*, Id)) {
        const Id id = ids.any(random_);
        const FwResult result = function(world_, id);
        check(result);
        if (result == FW_OK) ids.gone(random_, id);
    }

    void call() {
        float values[16];
        for (float& value : values) value = random_.number();
        const FwBurnableMeshId object = objects_.any(random_);
        switch (random_.below(34)) {
            case 0: {
                FwMaterialDef def = fwDefaultMaterialDef();
                (void)fwInitMaterialPreset(&def, random_.below(16));
                garble(def);
                def.structSize = sizeof def;
                FwMaterialId id{};
                const FwResult result = fwWorld_CreateMaterial(world_, &def, &id);
                check(result);
                if (result == FW_OK) materials_.known.push_back(id);
                break;
            }
            case 1:
                if (random_.once(6)) destroy(materials_, fwWorld_DestroyMaterial);
                break;
            case 2: {
                uint32_t pixels[64] = {};
                FwImageDef def = fwDefaultImageDef();
                def.width = random_.below(9);
                def.height = random_.below(8);
                def.pixels = random_.once(9) ? nullptr : pixels;
                FwImageId id{};
                const FwResult result = fwWorld_CreateImage(world_, &def, &id);
                check(result);
                if (result == FW_OK) images_.known.push_back(id);
                break;
            }
            case 3:
                if (random_.once(4)) destroy(images_, fwWorld_DestroyImage);
                break;
            case 4:
                if (meshes_.known.size() < 12 || random_.once(8)) createMesh();
                break;
            case 5:
                createCooked();
                break;
            case 6:
                if (random_.once(3)) destroy(meshes_, fwWorld_DestroyMesh);
                break;
            case 7:
            case 8:
                if (objects_.known.size() < 24 || random_.once(8)) createObject();
                break;
            case 9:
                if (random_.once(5)) destroy(objects_, fwWorld_DestroyBurnableMesh);
                break;
            case 10: {
                float m[16] = {1, 0, 0, 0, 0,         1,         0,         0,
                               0, 0, 1, 0, values[0], values[1], values[2], 1};
                if (random_.once(4)) m[random_.below(16)] = values[3];
                check(fwWorld_SetTransform(world_, object, m));
                break;
            }
            case 11:
                check(fwWorld_SetHidden(world_, object, random_.below(2)));
                break;
            case 12:
            case 13:
            case 14: {
                FwIgnitionDef def = fwDefaultIgnitionDef();
                def.kind = random_.below(random_.once(9) ? 9 : 4);
                def.object = random_.once(4) ? FwBurnableMeshId{} : object;
                std::memcpy(def.position, values, sizeof def.position);
                def.radius = random_.unit() * 0.3f;
                def.delay = random_.once(3) ? random_.unit() : 0;
                garble(def);
                def.structSize = sizeof def;
                uint32_t texels = 0;
                check(fwWorld_Ignite(world_, &def, &texels));
                break;
            }
            case 15:
                check(fwWorld_SetWind(world_, values));
                break;
            case 16:
                if (random_.once(3)) {
                    check(fwWorld_UntagPoint(world_, object, random_.below(4)));
                    check(fwWorld_ShiftOrigin(world_, values, nullptr));
                    check(fwWorld_TransferBurn(world_, object, objects_.any(random_)));
                }
                check(fwWorld_TagPoint(world_, object, values, random_.below(4)));
                break;
            case 17: {
                FwQueryId id{};
                const auto request =
                    random_.once(2) ? fwWorld_RequestPoint : fwWorld_RequestArrival;
                const FwResult result = request(world_, object, values, &id);
                check(result);
                if (result == FW_OK) queries_.known.push_back(id);
                break;
            }
            case 18: {
                if (random_.once(5)) {
                    check(fwWorld_CancelQuery(world_, queries_.any(random_)));
                    check(fwWorld_CancelBurn(world_, object));
                    if (random_.once(9)) check(fwWorld_CancelSave(world_));
                }
                if (random_.once(2)) {
                    FwArrivalState arrival{};
                    arrival.structSize = sizeof arrival;
                    check(fwWorld_FetchArrival(world_, queries_.any(random_), &arrival));
                    break;
                }
                FwPointState state{};
                state.structSize = random_.once(9) ? random_.below(100) : uint32_t(sizeof state);
                if (state.structSize > sizeof state) state.structSize = sizeof state;
                check(fwWorld_FetchPoint(world_, queries_.any(random_), &state));
                break;
            }
            case 19: {
                FwObjectState state{};
                state.structSize = sizeof state;
                const FwResult result = fwWorld_GetObjectState(world_, object, &state);
                check(result);
                if (result == FW_OK) {
                    EXPECT_LE(state.ignited, state.texels);
                    EXPECT_LE(state.burning, state.texels);
                }
                break;
            }
            case 20: {
                FwEvent events[16];
                for (const FwEvent& event : std::vector<FwEvent>(
                         events, events + fwWorld_PollEvents(world_, events, random_.below(17)))) {
                    EXPECT_LE(uint32_t(FW_EVENT_IGNITED), event.type);
                    fires += event.type == FW_EVENT_IGNITED ? 1 : 0;
                    EXPECT_GE(uint32_t(FW_EVENT_STRUCTURE_BROKE), event.type);
                }
                break;
            }
            case 21: {
                if (random_.once(4)) useSaves();
                if (random_.once(2)) useTimeline();
                FwLight lights[8];
                EXPECT_GE(8u, fwWorld_GetLights(world_, lights, random_.below(9)));
                break;
            }
            case 22: {
                check(fwDebug_SetSwitches(world_, random_.once(3) ? random_.below(128) : 0));
                std::vector<uint32_t> ticks(random_.below(64));
                if (random_.once(2)) check(fwDebug_RequestBurnMap(world_, object));
                uint64_t count = 0, hash = 0, tick = 0;
                check(fwDebug_FetchBurnMap(world_, object, ticks.data(), ticks.size(), &count,
                                           &hash, &tick));
                break;
            }
            case 23: {
                uint32_t texels[4];
                for (uint32_t& texel : texels)
                    texel = random_.once(9) ? random_.next() : random_.below(64);
                check(
                    fwDebug_PushTexels(world_, object, random_.below(5), texels, random_.below(5)));
                break;
            }
            case 24:
                if (flames_.known.size() < 8 || random_.once(30)) createFlame();
                break;
            case 25:
                if (emitters_.known.size() < 8 || random_.once(30)) createEmitter();
                changeEmitter();
                if (random_.once(6)) destroy(emitters_, fwWorld_DestroyFireEmitter);
                changeFlame();
                break;
            case 26:
                if (random_.once(3)) destroy(flames_, fwWorld_DestroyVolumetricFire);
                break;
            case 27:
                if (profiles_.known.size() < 4 || random_.once(8)) createProfile();
                if (flipbooks_.known.size() < 3 || random_.once(20)) createBook();
                if (random_.once(3)) destroy(flipbooks_, fwWorld_DestroyFlipbook);
                if (random_.once(3)) destroy(profiles_, fwWorld_DestroyFireProfile);
                break;
            case 28:
                if (colliders_.known.size() < 6 || random_.once(8)) shapeCollider();
                if (random_.once(3)) destroy(colliders_, fwWorld_RemoveFireCollider);
                break;
            case 31:
                shapeWind();
                if (random_.once(2)) useBurn(object);
                if (random_.once(4)) destroy(zones_, fwWorld_DestroyWindZone);
                break;
            case 32:
                airRoom();
                if (random_.once(4)) destroy(rooms_, fwWorld_DestroyRoom);
                break;
            case 30:
                useField();
                break;
            case 29:
                if (random_.once(2))
                    scriptFlame();
                else
                    queryFlames();
                break;
            default:
                check(fwWorld_Step(world_, random_.once(30) ? values[0] : random_.unit() * 0.2f));
                break;
        }
        if (random_.once(1500)) {
            fwDestroyWorld(world_);
            makeWorld();
            materials_.known.clear();
            images_.known.clear();
            meshes_.known.clear();
            objects_.known.clear();
            flames_.known.clear();
            emitters_.known.clear();
            profiles_.known.clear();
            flipbooks_.known.clear();
            colliders_.known.clear();
            zones_.known.clear();
            rooms_.known.clear();
            fields_.known.clear();
            queries_.known.clear();
        }
    }

    Host host_;
    Random random_;
    FwContext* context_ = nullptr;
    FwWorld* world_ = nullptr;
    Ids<FwMaterialId> materials_;
    Ids<FwImageId> images_;
    Ids<FwMeshId> meshes_;
    Ids<FwBurnableMeshId> objects_;
    Ids<FwVolumetricFireId> flames_;
    Ids<FwFireEmitterId> emitters_;
    Ids<FwFireProfileId> profiles_;
    Ids<FwFlipbookId> flipbooks_;
    std::vector<unsigned char> saved_;  // the last save kept
    Ids<FwFireColliderId> colliders_;
    Ids<FwWindZoneId> zones_;
    Ids<FwRoomId> rooms_;
    Ids<FwBurnId> burns_;
    Ids<FwParticleFieldId> fields_;
    Ids<FwQueryId> queries_;
    std::vector<unsigned char> cooked_;
};

}  // namespace host
