// The refinement passes on a device against the library: integers equal, floats near. A rig of its
// own: one object, buffers the host can see, a barrier after every phase.
#include "mesh/refine/table.h"
#include "support/pass_rig.h"
#include "support/refine_scene.h"

#include <array>
#include <map>

namespace fw::test {
namespace {

// What the passes bind.
constexpr uint32_t kBindings[] = {
    FW_BIND_PREDICT,        FW_BIND_GRADIENT,         FW_BIND_REFINE_WORK,
    FW_BIND_REFINE_OBJECTS, FW_BIND_REFINE_TRIANGLES, FW_BIND_REFINE_EDGES,
    FW_BIND_REFINE_SLOTS,   FW_BIND_REFINE_WORDS,     FW_BIND_REFINE_ITEMS,
    FW_BIND_REFINE_HEAT,    FW_BIND_REFINE_LEVELS,    FW_BIND_REFINE_VERTICES,
    FW_BIND_REFINE_INDICES, FW_BIND_REFINE_DRAWS,     FW_BIND_VERTICES,
    FW_BIND_REFINE_CUTS,    FW_BIND_REFINE_CUT_DRAWS, FW_BIND_OBJECT_COUNTERS};

class RefineRig {
 public:
    // cutTriangles: room for; 0: nothing is cut.
    RefineRig(TestDevice& device, const RefineScene& scene, uint32_t cutTriangles = 0)
        : device_(device),
          scene_(scene),
          rig_(device, kBindings, sizeof push_),
          cutTriangles_(cutTriangles) {
        const mesh::RefineModel& m = scene.model;
        const size_t items = m.edges.size() + m.triangles.size();
        const size_t full = size_t(m.fullCount());
        rig_.make(FW_BIND_REFINE_WORDS, sizeof mesh::kRefineTable, mesh::kRefineTable.data());
        rig_.make(FW_BIND_REFINE_TRIANGLES, m.triangles.size() * sizeof m.triangles[0],
                  m.triangles.data());
        rig_.make(FW_BIND_REFINE_EDGES, m.edges.size() * sizeof m.edges[0], m.edges.data());
        rig_.make(FW_BIND_REFINE_SLOTS, m.slots.size() * sizeof m.slots[0], m.slots.data());
        rig_.make(FW_BIND_REFINE_HEAT, items * 4);
        rig_.make(FW_BIND_REFINE_ITEMS, items * sizeof(gpu::RefineLevel));
        rig_.make(FW_BIND_REFINE_LEVELS, m.triangles.size() * 8);
        rig_.make(FW_BIND_REFINE_INDICES, full * 12);
        rig_.make(FW_BIND_REFINE_VERTICES, m.slots.size() * sizeof(gpu::RefineVertex));
        rig_.make(FW_BIND_REFINE_OBJECTS, sizeof(gpu::RefineObject));
        rig_.make(FW_BIND_REFINE_DRAWS, 8 * 20);
        rig_.make(FW_BIND_OBJECT_COUNTERS, sizeof(gpu::ObjectCounters));
        std::vector<mesh::RenderVertex> vertices(m.draws.size());
        for (uint32_t d = 0; d < m.draws.size(); ++d) {
            if (m.draws[d].triangle != mesh::kNone)
                vertices[d] = mesh::refineRenderVertex(scene.domain, m, d);
            vertices[d].material = m.draws[d].slot;
        }
        rig_.make(FW_BIND_VERTICES, vertices.size() * sizeof vertices[0], vertices.data());
        rig_.make(FW_BIND_REFINE_CUTS, std::max(cutTriangles, 1u) * 3 * sizeof(mesh::RenderVertex));
        rig_.make(FW_BIND_REFINE_CUT_DRAWS, 8 * 16);
        rig_.make(FW_BIND_PREDICT, scene.ticks.size() * 4, scene.ticks.data());
        rig_.make(FW_BIND_GRADIENT, scene.ticks.size() * 4);
        push_.objects = push_.objectEnd = 1;
        push_.recede = mesh::RefineSettings{}.recede;
        lists_.assign(gpu::kRefineWorkLists, 0);
        for (const uint32_t at : {gpu::kRefineWorkEmit, gpu::kRefineWorkPlace, gpu::kRefineWorkCut})
            lists_[at + 1] = lists_[at + 2] = 1;
        push_.edgeGroups = list(uint32_t(m.edges.size()));
        push_.triangleGroups = list(uint32_t(m.triangles.size()));
        push_.cornerGroups = list(m.cornerCount);
        lists_.push_back(0);
        lists_.push_back(0);
        lists_.insert(lists_.end(), gpu::kMaterialsPerObject, 0);
        lists_.insert(lists_.end(), gpu::kMaterialsPerObject, gpu::kNoneTexel);
        push_.emitJobs = uint32_t(lists_.size());
        push_.placeJobs = push_.emitJobs + uint32_t(2 * (full / 64 + 1));
        push_.cutJobs = push_.placeJobs + uint32_t(4 * m.triangles.size());
        rig_.make(FW_BIND_REFINE_WORK,
                  (push_.cutJobs + 2 * (m.triangles.size() + m.edges.size())) * 4);
        const char* names[5] = {"refine_levels.comp", "refine_scan.comp", "refine_emit.comp",
                                "refine_place.comp", "refine_cut.comp"};
        for (int k = 0; k < 5; ++k) pipelines_[k] = rig_.add(names[k]);
    }
    template <typename T>
    [[nodiscard]] std::span<T> of(uint32_t binding) const {
        return rig_.of<T>(binding);
    }

    void frame(gpu::RefineObject object, uint32_t nowTick, float dt, uint32_t budget) {
        const mesh::RefineModel& m = scene_.model;
        object.edgeCount = uint32_t(m.edges.size());
        object.triangleCount = uint32_t(m.triangles.size());
        object.cornerCount = m.cornerCount;
        object.textureWidth = m.textureWidth;
        object.flags = gpu::kRefineIsActive | (fresh_ ? gpu::kRefineIsFresh : 0);
        object.materialEnd0 = object.materialEnd1 = gpu::uvec4(
            object.triangleCount, object.triangleCount, object.triangleCount, object.triangleCount);
        if (cutTriangles_ > 0) object.flags |= gpu::kRefineIsCut;
        object.cutTriangles = cutTriangles_;
        fresh_ = false;
        of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0] = object;
        std::copy(lists_.begin(), lists_.end(), of<uint32_t>(FW_BIND_REFINE_WORK).begin());
        push_.nowTick = nowTick;
        of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0].dt = dt;
        push_.budget = budget;
        device_.run([&](VkCommandBuffer commands) {
            rig_.begin(commands);
            for (uint32_t phase = 0; phase < 4; ++phase)
                dispatch(commands, 0, phase, push_.edgeGroups + push_.triangleGroups);
            dispatch(commands, 1, 0, 1);
            dispatch(commands, 2, 0, 32);
            dispatch(commands, 3, 0, push_.cornerGroups);
            dispatch(commands, 3, 1, 4);
            dispatch(commands, 3, 2, 32);
            dispatch(commands, 3, 3, 32);
            if (cutTriangles_ == 0) return;
            dispatch(commands, 4, 0, push_.triangleGroups);
            dispatch(commands, 4, 1, 32);
            dispatch(commands, 4, 2, 1);
        });
    }

 private:
    uint32_t list(uint32_t count) {
        for (uint32_t k = 0; k < count; k += 64) {
            lists_.push_back(0);
            lists_.push_back(k);
        }
        return (count + 63) / 64;
    }

    void dispatch(VkCommandBuffer commands, int pipeline, uint32_t phase, uint32_t groups) {
        push_.phase = phase;
        rig_.dispatch(commands, pipelines_[pipeline], &push_, groups);
    }

    TestDevice& device_;
    const RefineScene& scene_;
    PassRig rig_;
    std::vector<uint32_t> lists_;  // of the work plane, as a frame begins
    gpu::RefinePush push_{};
    uint32_t cutTriangles_ = 0;
    bool fresh_ = true;
    uint32_t pipelines_[5] = {};
};

class RefineEquality : public GpuTest {
 protected:
    static gpu::RefineObject objectOf(const RefinePlayer& player, float now, float dt) {
        const mesh::RefineFrame frame = player.frameAt(now, dt);
        gpu::RefineObject o{};
        o.epochTick = frame.epochTick;
        o.now = now;
        o.pixelsPerEdge = player.settings.pixelsPerEdge;
        if (!frame.views.empty()) {
            const mesh::RefineView& view = frame.views[0];
            o.eye = {view.eye[0], view.eye[1], view.eye[2], view.focal};
        }
        for (size_t m = 0; m < std::min<size_t>(4, frame.burnSeconds.size()); ++m)
            o.burnSeconds0[int(m)] = frame.burnSeconds[m];
        return o;
    }

    struct Difference {
        uint32_t levels = 0, starts = 0, indices = 0, holes = 0;
        double level = 0, place = 0;
    };
    // One frame on both. A level that lies on a whole number to the last bit may be told apart by
    // the device's log2, so the library takes the device's levels for what follows from them.
    static Difference frame(RefinePlayer& player, RefineRig& rig, float now, float dt) {
        Difference d;
        const RefineScene& scene = player.scene;
        mesh::RefineState& s = player.state;
        const mesh::RefineFrame at = player.frameAt(now, dt);
        mesh::refineLevels(scene.model, player.settings, at, s);
        const auto heat = rig.of<uint32_t>(FW_BIND_REFINE_HEAT);
        // The library's heat, and which items have holes; that rims stay refined is the device's
        // own.
        for (size_t i = 0; i < heat.size(); ++i)
            heat[i] =
                (heat[i] & gpu::kRefineGone) |
                (i < s.edgeHeat.size() ? s.edgeHeat[i] : s.interiorHeat[i - s.edgeHeat.size()]);
        rig.frame(objectOf(player, now, dt), at.nowTick, dt, player.settings.budget);
        const auto items = rig.of<gpu::RefineLevel>(FW_BIND_REFINE_ITEMS);
        for (size_t i = 0; i < items.size(); ++i) {
            gpu::RefineLevel& own =
                i < s.edges.size() ? s.edges[i] : s.interiors[i - s.edges.size()];
            d.level = std::max(d.level, double(std::abs(own.level - items[i].level)));
            own.level = items[i].level;
        }
        for (size_t i = 0; i < s.levels.size(); ++i) {
            const gpu::RefineTriangle& t = scene.model.triangles[i];
            uint32_t top[3];
            for (int k = 0; k < 3; ++k) top[k] = gpu::refineTop(s.edges[t.edge[k]].level);
            s.levels[i] = gpu::refinePack(
                top[0], top[1], top[2],
                gpu::refineFit(top[0], top[1], top[2], gpu::refineTop(s.interiors[i].level)));
        }
        mesh::refineScan(scene.model, s);
        mesh::refineEmit(scene.model, s);
        mesh::refinePlace(scene.model, player.settings, at, s);

        const auto differ = [](std::span<const uint32_t> a, std::span<const uint32_t> b) {
            uint32_t count = 0;
            for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
            return count;
        };
        const auto levels = rig.of<gpu::uvec2>(FW_BIND_REFINE_LEVELS);
        for (size_t i = 0; i < levels.size(); ++i) {
            d.levels += levels[i].x != s.levels[i];
            d.starts += levels[i].y != s.starts[i];
        }
        d.starts += rig.of<uint32_t>(FW_BIND_REFINE_DRAWS)[0] != s.starts.back() * 3;
        d.indices = differ(s.indices, rig.of<uint32_t>(FW_BIND_REFINE_INDICES));
        const auto vertices = rig.of<gpu::RefineVertex>(FW_BIND_REFINE_VERTICES);
        for (const uint32_t draw : s.indices) {  // those in use
            const uint32_t slot = scene.model.draws[draw].slot;
            const gpu::RefineVertex &a = s.vertices[slot], &b = vertices[slot];
            const float apart =
                std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
            d.place = std::max(d.place, double(apart));
            d.holes += std::abs(a.hole - b.hole) > 1e-3f;
        }
        return d;
    }
};

TEST_F(RefineEquality, LevelsTrianglesAndPlacesAreTheLibrarys) {
    if (!device_) return;
    mesh::RefineOptions options;
    options.depth = 4;
    RefineScene scene(gridBox(0.8, 0.6, 0.02, 2, 2, 1, 11), options, 96);
    scene.light({0.2, 0.2, 0.02}, 0.05, 0.15);
    RefinePlayer player(scene);
    player.settings.skipStill = false;
    RefineRig rig(*device_, scene);
    uint32_t most = 0, frames = 0, biased = 0;
    double place = 0;
    // Instrumented, a frame takes a hundred times as long.
    const float first = gpuAssisted() ? scene.end - 1 : 0,
                last = scene.end + (gpuAssisted() ? 1 : 8);
    for (float now = first; now < last; now += 0.21f, ++frames) {
        // Far and near, plenty and little.
        player.views = {{{0.4f, 0.3f, 1 + float(frames % 9)}, 900}};
        player.settings.budget = frames % 7 < 4 ? 50000 : 3000;
        scene.heat(now, player.tiles);
        const Difference d = frame(player, rig, now, 0.21f);
        ASSERT_LT(d.level, 1e-4) << "frame " << frames;
        ASSERT_EQ(0u, d.levels + d.starts + d.indices) << "frame " << frames;
        ASSERT_LT(d.place, 1e-5) << "m, frame " << frames;
        ASSERT_EQ(0u, d.holes) << "frame " << frames;
        most = std::max(most, player.triangles());
        biased += player.state.bias > 0;
        place = std::max(place, d.place);
    }
    if (!gpuAssisted()) {
        EXPECT_GT(most, 4000u);
        EXPECT_GT(biased, 0u);
    }
    std::printf(
        "refinement: %u frames equal, at most %u triangles, places within %.1e m, %u frames "
        "with fewer levels for the budget\n",
        frames, most, place, biased);
}

// The comparison must notice a wrong table and a wrong flip bit.
TEST_F(RefineEquality, MutantsAreCaught) {
    if (!device_) return;
    mesh::RefineOptions options;
    options.depth = 3;
    RefineScene scene(gridBox(0.4, 0.3, 0.2, 1, 1, 1), options, 64);
    scene.light({0.1, 0.1, 0.2}, 0.05);
    RefinePlayer player(scene);
    player.settings.skipStill = false;
    scene.heat(1, player.tiles);
    for (const int mutant : {0, 1, 2}) {
        RefineRig rig(*device_, scene);
        if (mutant == 1)
            for (uint32_t& word : rig.of<uint32_t>(FW_BIND_REFINE_WORDS)) word ^= 0x00020002u;
        if (mutant == 2)
            for (auto& t : rig.of<gpu::RefineTriangle>(FW_BIND_REFINE_TRIANGLES)) t.flags ^= 7u;
        const Difference d = frame(player, rig, 1, 0.1f);
        EXPECT_EQ(0u, d.levels) << "mutant " << mutant;
        EXPECT_EQ(mutant != 0, d.indices != 0) << "mutant " << mutant;
    }
}

// --- Holes

using Place = std::array<float, 3>;

struct CutPiece {  // a triangle that the device wrote
    Place corners[3];
    float left[3];  // last words
    [[nodiscard]] bool wall() const { return left[0] < -0.5f; }
};

std::vector<CutPiece> cutPieces(const RefineRig& rig) {
    const auto draws = rig.of<uint32_t>(FW_BIND_REFINE_CUT_DRAWS);
    const auto vertices = rig.of<mesh::RenderVertex>(FW_BIND_REFINE_CUTS);
    std::vector<CutPiece> pieces(draws[0] / 3);
    for (size_t i = 0; i < pieces.size(); ++i)
        for (size_t v = 0; v < 3; ++v) {
            const mesh::RenderVertex& from = vertices[draws[2] + i * 3 + v];
            std::copy(std::begin(from.position), std::end(from.position),
                      pieces[i].corners[v].begin());
            std::memcpy(&pieces[i].left[v], &from.material, 4);
        }
    return pieces;
}

// Slots of the triangles that stay in the index list.
std::vector<uint32_t> plainSlots(const RefineRig& rig, const RefineScene& scene) {
    const auto indices = rig.of<uint32_t>(FW_BIND_REFINE_INDICES);
    const uint32_t count = rig.of<uint32_t>(FW_BIND_REFINE_DRAWS)[0];
    std::vector<uint32_t> slots;
    for (uint32_t i = 0; i < count; i += 3) {
        if (indices[i] == indices[i + 1]) continue;
        for (uint32_t v = 0; v < 3; ++v) slots.push_back(scene.model.draws[indices[i + v]].slot);
    }
    return slots;
}

// The library's shell from the device's vertices: what crosses a hole, and what does not.
struct WantedCut {
    std::vector<CutPiece> pieces;
    std::vector<uint32_t> plain;
};
WantedCut wantedCut(RefinePlayer& player, const RefineRig& rig, float now) {
    const RefineScene& scene = player.scene;
    const auto vertices = rig.of<gpu::RefineVertex>(FW_BIND_REFINE_VERTICES);
    for (const uint32_t draw : player.state.indices) {
        const uint32_t slot = scene.model.draws[draw].slot;
        player.state.vertices[slot] = vertices[slot];
    }
    mesh::RefineShell shell(std::pmr::new_delete_resource());
    mesh::refineShell(scene.model, player.state, now, true, shell);
    WantedCut wanted;
    for (size_t i = 0; i < shell.corners.size(); i += 3) {
        int inner = 0, cut = 0;
        for (size_t v = 0; v < 3; ++v) {
            const gpu::RefineCorner& c = shell.corners[i + v];
            inner += (c.high & gpu::kRefineInside) != 0 ? 1 : 0;
            cut += (c.high & ~gpu::kRefineInside) != c.low ? 1 : 0;
        }
        if (inner == 3) continue;
        if (cut == 0) {
            for (size_t v = 0; v < 3; ++v) wanted.plain.push_back(shell.corners[i + v].low);
            continue;
        }
        CutPiece piece{};
        for (size_t v = 0; v < 3; ++v) {
            const gpu::RefineCorner& c = shell.corners[i + v];
            const glm::vec3 p = mesh::refineCornerPlace(scene.model, player.state, now, c);
            piece.corners[v] = {p.x, p.y, p.z};
            piece.left[v] = inner == 0                           ? 0
                            : (c.high & gpu::kRefineInside) != 0 ? gpu::kRefineCutDeep
                                                                 : gpu::kRefineCutRim;
        }
        wanted.pieces.push_back(piece);
    }
    return wanted;
}

// Of both as sets: pieces without a partner within 10 um.
size_t unmatched(std::vector<CutPiece> a, std::vector<CutPiece> b) {
    const auto before = [](const CutPiece& x, const CutPiece& y) {
        return x.corners[0][0] < y.corners[0][0];
    };
    std::sort(a.begin(), a.end(), before);
    std::sort(b.begin(), b.end(), before);
    std::vector<bool> used(b.size());
    size_t alone = 0, first = 0;
    for (const CutPiece& x : a) {
        while (first < b.size() && b[first].corners[0][0] < x.corners[0][0] - 1e-5f) ++first;
        bool found = false;
        for (size_t i = first;
             !found && i < b.size() && b[i].corners[0][0] <= x.corners[0][0] + 1e-5f; ++i) {
            if (used[i]) continue;
            bool same = true;
            for (size_t v = 0; v < 3; ++v) {
                for (size_t k = 0; k < 3; ++k)
                    same &= std::abs(x.corners[v][k] - b[i].corners[v][k]) < 1e-5f;
                const bool wall = x.left[v] < -0.5f;
                same &= wall ? x.left[v] == b[i].left[v] : b[i].left[v] >= 0;
            }
            if (same) used[i] = found = true;
        }
        alone += found ? 0 : 1;
    }
    return alone + size_t(std::count(used.begin(), used.end(), false));
}

// Edges of what is drawn that no neighbour closes, but those deep inside, where walls end. Places
// are joined where they are equal to the bit.
size_t openEdges(const RefineRig& rig, const RefineScene& scene, std::span<const CutPiece> pieces) {
    using Key = std::array<uint32_t, 4>;  // place, whether deep
    std::map<std::pair<Key, Key>, int> edges;
    const auto edge = [&](const Key& a, const Key& b) {
        if (a[3] && b[3]) return;
        if (a < b)
            ++edges[{a, b}];
        else
            --edges[{b, a}];
    };
    const auto key = [](const float* place, bool deep) {
        Key k{};
        std::memcpy(k.data(), place, 12);
        k[3] = deep ? 1 : 0;
        return k;
    };
    const auto vertices = rig.of<gpu::RefineVertex>(FW_BIND_REFINE_VERTICES);
    const std::vector<uint32_t> plain = plainSlots(rig, scene);
    for (size_t i = 0; i < plain.size(); i += 3)
        for (size_t v = 0; v < 3; ++v)
            edge(key(&vertices[plain[i + v]].x, false),
                 key(&vertices[plain[i + (v + 1) % 3]].x, false));
    for (const CutPiece& piece : pieces)
        for (size_t v = 0; v < 3; ++v) {
            const size_t w = (v + 1) % 3;
            edge(key(piece.corners[v].data(), piece.left[v] < -1.5f),
                 key(piece.corners[w].data(), piece.left[w] < -1.5f));
        }
    return size_t(
        std::count_if(edges.begin(), edges.end(), [](const auto& one) { return one.second != 0; }));
}

TEST_F(RefineEquality, HolesAreCutAsTheLibraryDoes) {
    if (!device_) return;
    mesh::RefineOptions options;
    options.depth = 4;
    RefineScene scene(gridBox(0.8, 0.6, 0.3, 2, 2, 1, 11), options, 96);
    scene.light({0.2, 0.2, 0.3}, 0.05, 0.15);
    RefinePlayer player(scene);
    player.settings.skipStill = false;
    RefineRig rig(*device_, scene, 6000);
    size_t most = 0, walls = 0, frames = 0, holed = 0;
    const float first = gpuAssisted() ? scene.end : 0,
                last = scene.end + (gpuAssisted() ? 1 : kBurnSeconds + 3);
    for (float now = first; now < last; now += 0.43f, ++frames) {
        player.views = {{{0.4f, 0.3f, 1 + float(frames % 5)}, 900}};
        scene.heat(now, player.tiles);
        const Difference d = frame(player, rig, now, 0.43f);
        ASSERT_EQ(0u, d.levels + d.starts) << "frame " << frames;
        const std::vector<CutPiece> pieces = cutPieces(rig);
        const WantedCut wanted = wantedCut(player, rig, now);
        ASSERT_EQ(wanted.pieces.size(), pieces.size()) << "frame " << frames;
        ASSERT_EQ(wanted.plain, plainSlots(rig, scene)) << "frame " << frames;
        ASSERT_EQ(0u, unmatched(wanted.pieces, pieces)) << "frame " << frames;
        ASSERT_EQ(0u, openEdges(rig, scene, pieces)) << "frame " << frames;
        most = std::max(most, pieces.size());
        size_t rim = 0;
        for (const CutPiece& piece : pieces) rim += piece.wall() ? 1 : 0;
        walls = std::max(walls, rim);
        holed += rim > 0;
        if (frames % 16 == 7 && rim > 0) {  // the test must notice missing walls
            std::vector<CutPiece> bare;
            for (const CutPiece& piece : pieces)
                if (!piece.wall()) bare.push_back(piece);
            EXPECT_GE(openEdges(rig, scene, bare), rim / 2);
        }
    }
    std::printf("holes: %zu frames, %zu of them with holes, at most %zu cut triangles, %zu walls\n",
                frames, holed, most, walls);
    if (!gpuAssisted()) {
        EXPECT_GT(holed, frames / 4);
        EXPECT_GT(walls, 200u);
    }
}

// Without room for all of them some small triangles stay whole: nothing is missing, nothing is
// written where it must not be.
TEST_F(RefineEquality, WithoutRoomWhatACutWouldNeedStaysWhole) {
    if (!device_) return;
    constexpr uint32_t kRoom = 50;
    mesh::RefineOptions options;
    options.depth = 4;
    RefineScene scene(gridBox(0.8, 0.6, 0.3, 2, 2, 1, 11), options, 96);
    scene.light({0.2, 0.2, 0.3}, 0.05, 0.15);
    RefinePlayer player(scene);
    player.settings.skipStill = false;
    RefineRig rig(*device_, scene, kRoom);
    uint32_t full = 0;
    for (float now = 4; now < scene.end; now += 1.1f) {
        scene.heat(now, player.tiles);
        (void)frame(player, rig, now, 1.1f);
        const std::vector<CutPiece> pieces = cutPieces(rig);
        const WantedCut wanted = wantedCut(player, rig, now);
        ASSERT_LE(pieces.size(), kRoom);
        if (wanted.pieces.size() <= kRoom) continue;
        ++full;
        EXPECT_GT(pieces.size(), kRoom - 4);
        // Every one of them is a piece of the whole cut.
        EXPECT_EQ(wanted.pieces.size() - pieces.size(), unmatched(wanted.pieces, pieces));
        EXPECT_GT(plainSlots(rig, scene).size(), wanted.plain.size());
    }
    EXPECT_GT(full, 5u);
}

}  // namespace
}  // namespace fw::test
