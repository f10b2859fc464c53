// Meshes with chosen coarse triangle counts, a fire on them, and a test for closed surfaces, shared
// by refinement tests and benches. The fire is a formula (distance over speed, with noise), so a
// test costs refinement only.
#pragma once
#include "reference/refine_cut.h"
#include "support/front_rig.h"

#include <algorithm>
#include <map>
#include <random>

namespace fw::test {

// Flat sides, one chart each, placed in a row.
class SideBuilder {
 public:
    Mesh mesh;
    // A grid of nx x ny quads from `origin` along `ux` and `uy`, rotated in the atlas by degrees.
    void side(Vec3 origin, Vec3 ux, Vec3 uy, int nx, int ny, double turn = 0) {
        const uint32_t base = mesh.vertexCount();
        const double w = length(ux), h = length(uy), angle = turn * 3.14159265358979 / 180;
        const double span = std::hypot(w, h), left = at_ + (turn != 0 ? span : 0);
        for (int j = 0; j <= ny; ++j)
            for (int i = 0; i <= nx; ++i) {
                const double u = w * i / nx, v = h * j / ny;
                const Vec3 p = origin + ux * (double(i) / nx) + uy * (double(j) / ny);
                mesh.addVertex(p.x, p.y, p.z, left + u * std::cos(angle) - v * std::sin(angle),
                               u * std::sin(angle) + v * std::cos(angle));
            }
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                const uint32_t q = base + uint32_t(j * (nx + 1) + i), up = uint32_t(nx) + 1;
                mesh.addTriangle(q, q + 1, q + up + 1);
                mesh.addTriangle(q, q + up + 1, q + up);
            }
        at_ = left + (turn != 0 ? span : w) + 0.06;
    }
    void gable(Vec3 a, Vec3 b, Vec3 c, Vec3 apex) {
        const uint32_t q = mesh.vertexCount();
        const double w = length(c - a), h = length(apex - b);
        mesh.addVertex(a.x, a.y, a.z, at_, 0);
        mesh.addVertex(b.x, b.y, b.z, at_ + w / 2, 0);
        mesh.addVertex(c.x, c.y, c.z, at_ + w, 0);
        mesh.addVertex(apex.x, apex.y, apex.z, at_ + w / 2, h);
        mesh.addTriangle(q, q + 1, q + 3);
        mesh.addTriangle(q + 1, q + 2, q + 3);
        at_ += w + 0.06;
    }

 private:
    double at_ = 0;
};

// X x Y x Z m with a, b, c quads along them: 4 (ab + bc + ca) triangles.
inline Mesh gridBox(double X, double Y, double Z, int a, int b, int c, double turn = 0) {
    SideBuilder s;
    s.side({0, 0, Z}, {X, 0, 0}, {0, Y, 0}, a, b, turn);
    s.side({X, 0, 0}, {-X, 0, 0}, {0, Y, 0}, a, b, turn * 2);
    s.side({X, 0, Z}, {0, 0, -Z}, {0, Y, 0}, c, b, turn * 3);
    s.side({0, 0, 0}, {0, 0, Z}, {0, Y, 0}, c, b);
    s.side({0, Y, Z}, {X, 0, 0}, {0, 0, -Z}, a, c, turn);
    s.side({0, 0, 0}, {X, 0, 0}, {0, 0, Z}, a, c);
    return s.mesh;
}

// Ridge along z; 8 ny + 4 + 4 ny nz + 8 nz triangles.
inline Mesh house(double X, double Y, double Z, double roof, int ny, int nz) {
    SideBuilder s;
    s.side({0, 0, Z}, {X, 0, 0}, {0, Y, 0}, 2, ny);
    s.side({X, 0, 0}, {-X, 0, 0}, {0, Y, 0}, 2, ny);
    s.side({X, 0, Z}, {0, 0, -Z}, {0, Y, 0}, nz, ny);
    s.side({0, 0, 0}, {0, 0, Z}, {0, Y, 0}, nz, ny);
    s.side({X, Y, Z}, {0, 0, -Z}, {-X / 2, roof, 0}, nz, 1);
    s.side({0, Y, 0}, {0, 0, Z}, {X / 2, roof, 0}, nz, 1);
    s.side({0, 0, 0}, {X, 0, 0}, {0, 0, Z}, 2, nz);
    s.gable({0, Y, Z}, {X / 2, Y, Z}, {X, Y, Z}, {X / 2, Y + roof, Z});
    s.gable({X, Y, 0}, {X / 2, Y, 0}, {0, Y, 0}, {X / 2, Y + roof, 0});
    return s.mesh;
}

// Two boxes that share an edge with four owners.
inline Mesh boxesOnAnEdge() {
    Mesh mesh = gridBox(1, 1, 1, 1, 1, 1);
    const Mesh other = mesh;
    const uint32_t base = mesh.vertexCount();
    for (uint32_t i = 0; i < base; ++i)
        mesh.addVertex(double(other.positions[i * 3]) + 1, double(other.positions[i * 3 + 1]) + 1,
                       double(other.positions[i * 3 + 2]), double(other.uvs[i * 2]),
                       double(other.uvs[i * 2 + 1]) + 2);
    for (uint32_t i : other.indices) mesh.indices.push_back(i + base);
    return mesh;
}

constexpr float kBurnSeconds = 4;  // burn time of a wall

struct RefineScene {
    mesh::BurnDomain domain;
    mesh::RefineModel model;
    std::vector<uint32_t> ticks;
    std::vector<float> sorted;  // s, arrivals
    float end = 0;              // s, last arrival
    std::vector<float> tileFirst, tileLast;
    std::vector<float> burn = std::vector<float>(8, kBurnSeconds);

    RefineScene(const Mesh& mesh, const mesh::RefineOptions& options, double density = 128)
        : domain(bakeDomain(mesh, density)),
          model(mesh::bakeRefine(domain, options, std::pmr::new_delete_resource())),
          ticks(domain.texelCount(), gpu::kNever),
          tileFirst(domain.tileCount(), 1e30f),
          tileLast(domain.tileCount(), -1e30f) {}

    static mesh::BurnDomain bakeDomain(const Mesh& mesh, double density) {
        mesh::BakeInput input = mesh.input(density, 4096);
        return mesh::bake(input, std::pmr::new_delete_resource());
    }

    // A disc of 1 cm at `start` (m) is lit at 0 s; speed in m/s; noise: 60 mm lattice.
    void light(Vec3 start, double speed, double noise = 0) {
        sorted.clear();
        end = 0;
        warning = domain.texelSide / float(speed);
        std::fill(tileFirst.begin(), tileFirst.end(), 1e30f);
        std::fill(tileLast.begin(), tileLast.end(), -1e30f);
        const auto lattice = [](int x, int y, int z) {
            return gpu::hash32(uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^
                               uint32_t(z) * 83492791u) /
                   4294967296.0;
        };
        for (uint32_t i = 0; i < domain.texelCount(); ++i) {
            if (!domain.real(i)) continue;
            const Vec3 p = texelPosition(domain, i);
            double seconds = std::max(0.0, length(p - start) - 0.01) / speed;
            if (noise > 0) {
                const Vec3 q = p * (1 / 0.06);
                const double fx = std::floor(q.x), fy = std::floor(q.y), fz = std::floor(q.z);
                double v = 0;
                for (int k = 0; k < 8; ++k)
                    v += lattice(int(fx) + (k & 1), int(fy) + (k >> 1 & 1), int(fz) + (k >> 2)) *
                         (k & 1 ? q.x - fx : fx + 1 - q.x) * (k & 2 ? q.y - fy : fy + 1 - q.y) *
                         (k & 4 ? q.z - fz : fz + 1 - q.z);
                seconds = std::max(0.0, seconds + noise * 0.06 / speed * (2 * v - 1) * 2);
            }
            ticks[i] = kStartTick + uint32_t(seconds * 4096);
            const float t = float(seconds);
            sorted.push_back(t);
            end = std::max(end, t);
            const uint32_t tile = i / domain.width / mesh::kTileSide * domain.tilesX +
                                  i % domain.width / mesh::kTileSide;
            tileFirst[tile] = std::min(tileFirst[tile], t);
            tileLast[tile] = std::max(tileLast[tile], t);
        }
        std::sort(sorted.begin(), sorted.end());
    }

    [[nodiscard]] float timeAt(double share) const {
        return sorted[std::min(sorted.size() - 1, size_t(share * double(sorted.size())))];
    }
    // Tile lists as in the simulation: on the front list from when fire is one texel away, on the
    // burn list until the last texel burnt out.
    void flagsAt(float now, std::vector<uint32_t>& flags, bool keepBurnt = false) const {
        flags.assign(domain.tileCount(), 0);
        for (uint32_t t = 0; t < domain.tileCount(); ++t) {
            if (tileFirst[t] - warning <= now && now <= tileLast[t]) flags[t] |= gpu::kTileListed;
            if (tileFirst[t] <= now && (keepBurnt || now <= tileLast[t] + kBurnSeconds))
                flags[t] |= gpu::kTileBurning;
        }
    }
    void heat(float now, std::vector<uint8_t>& tiles, bool keepBurnt = false,
              bool ahead = false) const {
        std::vector<uint32_t> flags;
        flagsAt(now, flags, keepBurnt);
        tiles.resize(domain.tileCount());
        mesh::refineHeat(domain, flags, ahead, tiles);
    }
    float warning = 0;  // s that fire takes for one texel
};

// Plays one object's refinement. `settings` and `views` may change at any time.
struct RefinePlayer {
    const RefineScene& scene;
    mesh::RefineSettings settings;
    std::vector<mesh::RefineView> views;
    mesh::RefineState state;
    bool keepBurnt = false, ahead = false;
    std::vector<uint8_t> tiles;

    explicit RefinePlayer(const RefineScene& s)
        : scene(s), state(s.model, std::pmr::new_delete_resource()) {}

    [[nodiscard]] mesh::RefineFrame frameAt(float now, float dt) const {
        mesh::RefineFrame frame;
        frame.now = now;
        frame.dt = dt;
        frame.epochTick = kStartTick;
        frame.nowTick = kStartTick + uint32_t(std::max(0.0f, now) * 4096);
        frame.tiles = tiles;
        frame.views = views;
        frame.ticks = scene.ticks;
        frame.burnSeconds = scene.burn;
        return frame;
    }
    void frame(float now, float dt) {
        scene.heat(now, tiles, keepBurnt, ahead);
        mesh::refineFrame(scene.model, settings, frameAt(now, dt), state);
    }
    // Levels only over a span of time, then one frame.
    void runTo(float from, float now, float dt) {
        for (float t = from; t < now; t += dt) {
            scene.heat(t, tiles, keepBurnt, ahead);
            mesh::refineLevels(scene.model, settings, frameAt(t, dt), state);
        }
        frame(now, dt);
    }
    [[nodiscard]] uint32_t triangles() const { return state.starts.back(); }
};

// Coarse triangles without a first split.
inline mesh::RefineOptions unsplit(uint32_t depth, float cellTexels = 0) {
    mesh::RefineOptions o;
    o.depth = depth;
    o.cellTexels = cellTexels;
    o.splitTexels = 0;
    return o;
}

inline uint32_t levelOf(const mesh::RefineModel& model, const mesh::RefineState& state, uint32_t i,
                        uint32_t interior) {
    const gpu::RefineTriangle& t = model.triangles[i];
    const auto top = [&](uint32_t k) { return gpu::topLevel(state.edges[t.edge[k]].level); };
    return gpu::refinePack(top(0), top(1), top(2),
                           gpu::fitInterior(top(0), top(1), top(2), interior));
}

// Sets random levels; returns the number of output edges that must have no partner.
inline uint32_t randomLevels(const mesh::RefineModel& model, std::mt19937& random,
                             mesh::RefineState& state) {
    uint32_t open = 0;
    for (uint32_t e = 0; e < model.edges.size(); ++e) {
        const uint32_t level = uint32_t(random()) % ((model.edges[e].flags & 15) + 1);
        state.edges[e].level = float(level);
        int turns = 0;  // owners along the edge less those against it
        for (uint32_t o = model.ownerStart[e]; o < model.ownerStart[e + 1]; ++o)
            turns +=
                gpu::refineFlipped(model.triangles[model.owners[o] >> 2].flags, model.owners[o] & 3)
                    ? -1
                    : 1;
        if (turns != 0) open += 1u << level;
    }
    for (uint32_t i = 0; i < model.triangles.size(); ++i)
        state.levels[i] =
            levelOf(model, state, i,
                    uint32_t(random()) % (gpu::refineInteriorDepth(model.triangles[i].flags) + 1));
    mesh::refineScan(model, state);
    mesh::refineEmit(model, state);
    return open;
}

// Each directed edge once, and its reverse once.
struct Closedness {
    uint32_t open = 0;        // edges without their reverse
    uint32_t shared = 0;      // used more than twice
    uint32_t degenerate = 0;  // triangles with a repeated corner
};
// ids: 3 per triangle, arbitrary numbers.
inline Closedness closedness(std::span<const uint64_t> ids) {
    struct Use {
        uint64_t low, high;
        int turn;
        bool operator<(const Use& o) const { return low != o.low ? low < o.low : high < o.high; }
    };
    std::vector<Use> uses;
    uses.reserve(ids.size());
    Closedness result;
    for (size_t i = 0; i < ids.size(); i += 3) {
        if (ids[i] == ids[i + 1] || ids[i + 1] == ids[i + 2] || ids[i + 2] == ids[i])
            ++result.degenerate;
        for (size_t k = 0; k < 3; ++k) {
            const uint64_t a = ids[i + k], b = ids[i + (k + 1) % 3];
            uses.push_back(a < b ? Use{a, b, 1} : Use{b, a, -1});
        }
    }
    std::sort(uses.begin(), uses.end());
    for (size_t i = 0; i < uses.size();) {
        size_t j = i;
        int sum = 0;
        while (j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high)
            sum += uses[j++].turn;
        result.open += sum != 0;
        result.shared += j - i > 2;
        i = j;
    }
    return result;
}
inline std::vector<uint64_t> slotIds(const mesh::RefineModel& model,
                                     const mesh::RefineState& state) {
    std::vector<uint64_t> ids(state.indices.size());
    for (size_t i = 0; i < ids.size(); ++i) ids[i] = model.draws[state.indices[i]].slot;
    return ids;
}
inline std::vector<uint64_t> shellIds(const mesh::RefineShell& shell) {
    std::vector<uint64_t> ids(shell.corners.size());
    for (size_t i = 0; i < ids.size(); ++i)
        ids[i] = uint64_t(shell.corners[i].high) << 32 | shell.corners[i].low;
    return ids;
}

}  // namespace fw::test
