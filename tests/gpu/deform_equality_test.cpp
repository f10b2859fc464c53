// The deformation passes on a device against the library: the same mesh and fire, step by step.
// Devices store bends and burnt shares in fewer bits, so results agree within stated tolerances.
#include "mesh/bake.h"
#include "mesh/refine/model.h"
#include "reference/deform_solver.h"
#include "support/meshes.h"
#include "support/pass_rig.h"

#include <bit>
#include <string>

namespace fw::test::deform_equality_test {
namespace {

using gpu::vec3;

constexpr uint32_t kBindings[] = {FW_BIND_STATE,
                                  FW_BIND_OBJECTS,
                                  FW_BIND_DEFORM_OBJECTS,
                                  FW_BIND_DEFORM_GROUPS,
                                  FW_BIND_DEFORM_PARTICLES,
                                  FW_BIND_DEFORM_EMBEDDINGS,
                                  FW_BIND_SHOWN,
                                  FW_BIND_SOFT,
                                  FW_BIND_EXTENSION_WORDS,
                                  FW_BIND_VERTICES};
constexpr uint32_t kTexels[] = {FW_BIND_DEFORM_PARTICLES, FW_BIND_DEFORM_EMBEDDINGS, FW_BIND_SHOWN,
                                FW_BIND_SOFT};
constexpr float kStep = float(gpu::kSoftTicks) / float(gpu::kTicksPerSecond);
constexpr float kSide = 0.2f;  // m

// One object on both sides.
struct Pair {
    // `words`: as on devices with few texels per buffer.
    Pair(TestDevice& testDevice, const Mesh& mesh, const gpu::DeformObject& what,
         bool words = false)
        : device(testDevice),
          domain(mesh::bake(mesh.input(64), std::pmr::new_delete_resource())),
          model(mesh::makeDeformModel(domain, std::pmr::new_delete_resource())),
          state(std::pmr::new_delete_resource()),
          object(what),
          states(domain.texelCount(), gpu::kInert),
          rig(testDevice, kBindings, sizeof(gpu::DeformPush),
              words ? std::span<const uint32_t>() : kTexels) {
        object.particleCount = uint32_t(model.particles.size());
        object.vertexCount = uint32_t(domain.vertices.size());
        object.ground = -1e9f;
        object.scale = 1;
        mesh::resetDeform(model, state);
        mesh::resetSoft(model, object, state);
        std::vector<gpu::DeviceParticle> nodes(model.particles.size());
        for (uint32_t i = 0; i < nodes.size(); ++i)
            mesh::putQuads(mesh::deviceParticle(model, i), i, nodes.size(),
                           reinterpret_cast<std::byte*>(nodes.data()));
        std::vector<gpu::DeformEmbedding> embeddings(model.embeddings.size());
        for (size_t i = 0; i < embeddings.size(); ++i)
            mesh::putQuads(model.embeddings[i], i, embeddings.size(),
                           reinterpret_cast<std::byte*>(embeddings.data()));
        groups = (std::max(object.particleCount, object.vertexCount) + gpu::kDeformGroup - 1) /
                 gpu::kDeformGroup;
        const gpu::vec4 rows[10] = {{}, {}, {}, {}, {}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
        rig.make(FW_BIND_STATE, states.size() * 4);
        rig.make(FW_BIND_OBJECTS, sizeof rows, rows);
        rig.make(FW_BIND_DEFORM_OBJECTS, sizeof object, &object);
        rig.make(FW_BIND_DEFORM_GROUPS, groups * 8);
        rig.make(FW_BIND_DEFORM_PARTICLES, nodes.size() * sizeof nodes[0], nodes.data());
        rig.make(FW_BIND_DEFORM_EMBEDDINGS, embeddings.size() * sizeof embeddings[0],
                 embeddings.data());
        // The second half is the inner skin, if there is one.
        rig.make(FW_BIND_SHOWN, 2 * domain.vertices.size() * sizeof(gpu::ShownVertex));
        skin = domain.vertices;
        if (object.wall > 0) {
            const auto places =
                mesh::innerSkin(domain, object.wall, std::pmr::new_delete_resource());
            for (size_t i = 0; i < places.size(); ++i)
                std::copy_n(&places[i].x, 3, skin[i].position);
        }
        rig.make(FW_BIND_VERTICES, skin.size() * sizeof skin[0], skin.data());
        rig.make(FW_BIND_SOFT, nodes.size() * 16 * gpu::kSoftQuads);
        far = reference::makeFarLinks(domain, model, std::pmr::new_delete_resource());
        std::vector<gpu::DeviceLinks> links(far.size() * gpu::kDeformLinkPasses);
        reference::packFarLinks(model, far, links);
        rig.make(FW_BIND_EXTENSION_WORDS, links.size() * sizeof links[0], links.data());
        for (const std::string pass :
             {"recede", "link_cache", "soft", "springs", "skin_to_mesh", "inner"})
            rig.add((pass + (words ? ".comp" : "_texels.comp")).c_str());
        push.up = {0, 1, 0, 0};
        push.step = kStep;
    }

    // Burns each texel since tick 1 at the time (s after ignition) that `when` gives.
    template <class When>
    void burn(When when) {
        for (uint32_t i = 0; i < states.size(); ++i)
            if (domain.real(i)) states[i] = 1 + when(i);
        std::copy(states.begin(), states.end(), rig.of<uint32_t>(FW_BIND_STATE).begin());
    }

    // A frame at `now` with `steps` solver steps.
    void frame(uint32_t now, uint32_t steps) {
        const bool soft = (object.flags & gpu::kDeformRecede) == 0;
        const bool springs = (object.flags & gpu::kDeformExtended) != 0;
        const auto marks = (fresh ? gpu::kDeformReset : 0) | (odd ? gpu::kDeformOdd : 0);
        for (uint32_t i = 0; i < groups; ++i)
            rig.of<gpu::uvec2>(FW_BIND_DEFORM_GROUPS)[i] = {0, (i * gpu::kDeformGroup) | marks};
        push.now = now;
        device.run([&](VkCommandBuffer commands) {
            rig.begin(commands);
            push.parity = steps << 1;
            rig.dispatch(commands, 0, &push, groups);
            for (uint32_t i = 0; i < steps && soft; ++i) {
                const uint32_t way = (state.way + i) % gpu::kBendSets;
                push.parity = (i & 1) | way << 1;
                if (!springs && (gpu::updatesLinkCache(way) || (i == 0 && !state.tied)))
                    rig.dispatch(commands, 1, &push, groups);
                rig.dispatch(commands, springs ? 3 : 2, &push, groups);
            }
            push.parity = 0;
            rig.dispatch(commands, 4, &push, groups);
            if (object.wall > 0) rig.dispatch(commands, 5, &push, groups);
        });
        if (soft && (steps & 1)) odd = !odd;

        const std::pmr::vector<gpu::ShownVertex> before = state.shown;
        mesh::recede(model, object, states, now, state);
        std::vector<float> lost;
        for (const gpu::DeformParticle& node : model.particles) {
            gpu::ShownVertex& shown = state.shown[node.vertex];
            const gpu::ShownVertex& last = before[node.vertex];
            const float more = fresh ? 0 : shown.burnt - last.burnt;
            lost.push_back(more * object.materials[node.flags & 7u].depth / float(steps));
            if (!soft) continue;
            if (!springs)
                shown.burnt = std::floor(shown.burnt * 255) / 255;  // at the device's precision
            shown.x = last.x;
            shown.y = last.y;
            shown.z = last.z;
        }
        drive.wind = vec3(push.wind);
        for (uint32_t i = 0; i < steps && soft; ++i) {
            if (springs)
                mesh::springStep(model, far, gpu::springStiffness(), kStep, lost,
                                 gpu::kSpringDamping, state);
            else
                mesh::sheetStep(model, object, drive, state);
        }
        mesh::skinVertices(model, state, soft && !springs);
        fresh = false;
    }

    // The device continues from the library's state.
    void sync() {
        const auto shown = rig.of<gpu::ShownVertex>(FW_BIND_SHOWN);
        const auto soft = rig.of<gpu::uvec4>(FW_BIND_SOFT);
        for (size_t i = 0; i < model.particles.size(); ++i) {
            const uint32_t vertex = model.particles[i].vertex;
            const mesh::DeformState::Soft& own = state.soft[vertex];
            const vec3 at = own.place[state.parity];
            const auto unpackBendShare = [&](int kind) {
                return gpu::packBendShare(own.share[state.parity][kind] * gpu::kBendUnit);
            };
            const uint32_t way = gpu::packPathLength(own.reach[state.parity], own.known);
            soft[i + (odd ? model.particles.size() : 0)] = {
                gpu::packPathBits(std::bit_cast<uint32_t>(at.x), way, gpu::kPathLowMask),
                gpu::packPathBits(std::bit_cast<uint32_t>(at.y), way >> 5, gpu::kPathLowMask),
                gpu::packPathBits(std::bit_cast<uint32_t>(at.z), way >> 10, gpu::kPathHighMask),
                unpackBendShare(0)};
            soft[i + 3 * model.particles.size()] = {
                gpu::packParticleFacts(own.burnt, own.reach[state.parity] == 0), 0,
                unpackBendShare(1), unpackBendShare(1)};
            shown[vertex].x = state.shown[vertex].x;
            shown[vertex].y = state.shown[vertex].y;
            shown[vertex].z = state.shown[vertex].z;
        }
        state.tied = false;  // and rebuilds its link cache, as the library does
    }

    struct Apart {
        double place = 0;   // m, largest
        double mean = 0;    // m, mean
        double normal = 0;  // degrees, mean
        double lead = 0;    // s
        double moved = 0;   // m from rest, largest
    };
    [[nodiscard]] Apart apart() const {
        Apart worst;
        const auto shown = rig.of<gpu::ShownVertex>(FW_BIND_SHOWN).first(domain.vertices.size());
        for (size_t i = 0; i < shown.size(); ++i) {
            const gpu::ShownVertex &a = shown[i], &b = state.shown[i];
            const auto* rest = domain.vertices[i].position;
            const vec3 at(a.x, a.y, a.z);
            const double off = double(gpu::length(at - vec3(b.x, b.y, b.z)));
            worst.place = std::max(worst.place, off);
            worst.mean += off / double(shown.size());
            worst.moved =
                std::max(worst.moved, double(gpu::length(at - vec3(rest[0], rest[1], rest[2]))));
            const float c =
                gpu::dot(gpu::unpackDirection(a.normal), gpu::unpackDirection(b.normal));
            worst.normal +=
                std::acos(double(std::clamp(c, -1.0f, 1.0f))) * 57.3 / double(shown.size());
            worst.lead = std::max(worst.lead, double(std::fabs(a.burnThrough - b.burnThrough)));
        }
        return worst;
    }

    TestDevice& device;
    mesh::BurnDomain domain;
    mesh::DeformModel model;
    mesh::DeformState state;
    std::pmr::vector<reference::FarLinks> far;
    gpu::DeformObject object;
    std::vector<uint32_t> states;
    std::pmr::vector<mesh::RenderVertex> skin;
    PassRig rig;
    gpu::DeformPush push{};
    mesh::SheetDrive drive;
    uint32_t groups = 0;
    bool fresh = true, odd = false;
};

class DeformEquality : public GpuTest {
 protected:
    static gpu::DeformObject object(uint32_t tier) {
        gpu::DeformObject made{};
        made.flags = tier;
        for (gpu::DeformMaterial& m : made.materials) {
            m.charTicks = 8 * gpu::kTicksPerSecond;
            m.depth = 0.004f;
            m.curl = 40;
            m.shrink = 0.05f;
            m.bend = 0.5f;
            m.drag = 8;
            m.holeTicks = 12 * gpu::kTicksPerSecond;
            m.holeSeconds = 3;
        }
        return made;
    }
    static gpu::DeformObject sheet() {
        gpu::DeformObject made = object(gpu::kDeformShell);
        made.pinCount = 2;
        made.pins[0] = {0, kSide, 0, 0.012f};
        made.pins[1] = {0.05f, kSide, 0, 0};
        made.pins[2] = made.pins[3] = {kSide, kSide, 0, 0.012f};
        return made;
    }
    // A front that climbs in some 4 s.
    static void light(Pair& pair) {
        pair.burn([&](uint32_t texel) { return texel / pair.domain.width * 512u; });
        pair.push.wind = {0.4f, 0, 0.7f, 0};
    }
};

TEST_F(DeformEquality, RecedingSolidsAgree) {
    Pair pair(*device_, makeCube(kSide, 10, true), object(gpu::kDeformRecede));
    pair.burn([&](uint32_t texel) { return (texel * 37u) % 9000u; });
    for (uint32_t now = 100; now < 60000; now += 9000) {
        pair.frame(now, 0);
        const Pair::Apart apart = pair.apart();
        ASSERT_LT(apart.place, 1e-6);
        ASSERT_LT(apart.normal, 0.2);
        ASSERT_LT(apart.lead, 1e-4);
    }
    EXPECT_GT(pair.apart().moved, 0.003);
    EXPECT_LT(0, std::count_if(pair.model.particles.begin(), pair.model.particles.end(),
                               [](const auto& n) { return n.opposite != mesh::kNone; }));
}

// The inner skin of a receding solid stays while there is a wall in front and never comes in front
// of it. Holes open in both at once.
TEST_F(DeformEquality, InnerSkinsOfRecedingSolidsAgree) {
    constexpr float kWall = 0.004f;
    gpu::DeformObject made = object(gpu::kDeformRecede);
    made.wall = kWall;
    for (gpu::DeformMaterial& m : made.materials) m.depth = kWall;  // all of it burns away
    Pair pair(*device_, makeCube(kSide, 10, true), made);
    pair.burn([&](uint32_t texel) { return (texel * 37u) % 9000u; });
    size_t still = 0, gone = 0;
    for (uint32_t now = 100; now < 60000; now += 9000) {
        pair.frame(now, 0);
        const size_t count = pair.domain.vertices.size();
        const auto shown = pair.rig.of<gpu::ShownVertex>(FW_BIND_SHOWN);
        for (size_t i = 0; i < count; ++i) {
            const gpu::ShownVertex &out = shown[i], &in = shown[count + i];
            const vec3 outside(out.x, out.y, out.z), inside(in.x, in.y, in.z);
            const vec3 depth = outside - inside, normal = gpu::unpackDirection(out.normal);
            ASSERT_GT(gpu::dot(depth, normal), 0.5f * gpu::kThinnestWall * kWall)
                << now << ' ' << i;
            ASSERT_EQ(out.burnThrough, in.burnThrough);
            ASSERT_EQ(out.normal, in.normal);
            const float* place = pair.skin[i].position;
            const bool stays = gpu::length(inside - vec3(place[0], place[1], place[2])) < 1e-7f;
            const float burnt = shown[pair.model.embeddings[i].particle].burnt;
            ASSERT_TRUE(stays || burnt > 1 - 2.01f * gpu::kThinnestWall) << now << ' ' << i;
            (stays ? still : gone) += 1;
        }
    }
    EXPECT_GT(still, 100u);
    EXPECT_GT(gone, 100u);
}

// A sheet hangs, blows, chars, curls and tears for ten seconds. Flapping doubles any difference
// some ten times a second, so every twelve steps are compared by themselves. The median counts,
// because a piece may tear off a step earlier on one side.
constexpr double kApart = 1e-4;  // m, mean
Pair::Apart apartAfter12(Pair& pair) {
    pair.frame(100, 1);
    std::vector<double> means, normals;
    Pair::Apart made;
    for (uint32_t frame = 1; frame < 160; ++frame) {
        if (frame % 4 == 1) pair.sync();
        pair.frame(100 + frame * 256, 3);
        if (frame % 4 != 0) continue;
        const Pair::Apart apart = pair.apart();
        means.push_back(apart.mean);
        normals.push_back(apart.normal);
        made.place = std::max(made.place, apart.place);
        made.moved = std::max(made.moved, apart.moved);
    }
    for (std::vector<double>* all : {&means, &normals})
        std::nth_element(all->begin(), all->begin() + std::ptrdiff_t(all->size() / 2), all->end());
    made.mean = means[means.size() / 2];
    made.normal = normals[normals.size() / 2];
    return made;
}

TEST_F(DeformEquality, SheetsAgree) {
    Pair pair(*device_, makeSheet(double(kSide), 20), sheet());
    light(pair);
    const Pair::Apart apart = apartAfter12(pair);
    std::printf("[   FIGURE ] %.6f m in the mean, %.6f at most, %.3f degrees; moved %.3f m\n",
                apart.mean, apart.place, apart.normal, apart.moved);
    EXPECT_GT(apart.moved, 0.05);
    EXPECT_GT(std::count_if(pair.state.shown.begin(), pair.state.shown.end(),
                            [](const gpu::ShownVertex& v) { return v.burnt > 0.97f; }),
              20);
    EXPECT_LT(apart.mean, kApart);
    EXPECT_LT(apart.place, 0.01);
    EXPECT_LT(apart.normal, 1);
}

TEST_F(DeformEquality, WordsAndTexelsGiveEqualBits) {
    for (const gpu::DeformObject& what :
         {sheet(), object(gpu::kDeformRecede), object(gpu::kDeformExtended)}) {
        const Mesh mesh = makeSheet(double(kSide), 10);
        Pair texels(*device_, mesh, what), words(*device_, mesh, what, true);
        for (Pair* pair : {&texels, &words}) {
            light(*pair);
            for (uint32_t frame = 0; frame < 20; ++frame) pair->frame(100 + frame * 1024, 3);
        }
        const auto a = texels.rig.of<uint32_t>(FW_BIND_SHOWN);
        const auto b = words.rig.of<uint32_t>(FW_BIND_SHOWN);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin())) << what.flags;
        EXPECT_GT(texels.apart().moved, 1e-4) << what.flags;
    }
}

// The comparison must notice a difference in curl, weight, pin, shrinking or drag.
TEST_F(DeformEquality, ComparisonCatchesMutants) {
    for (uint32_t what = 0; what < 5; ++what) {
        Pair pair(*device_, makeSheet(double(kSide), 20), sheet());
        light(pair);
        if (what == 1) pair.drive.gravity = 9.0f;
        if (what == 2) pair.object.pinCount = 1;
        for (gpu::DeformMaterial& m : pair.object.materials) {
            if (what == 0) m.curl = 0;
            if (what == 3) m.shrink = 0.10f;
            if (what == 4) m.drag = 4;
        }
        const double apart = apartAfter12(pair).mean;
        std::printf("[   FIGURE ] %u: %.6f m\n", what, apart);
        EXPECT_GT(apart, 3 * kApart) << what;
    }
}

TEST_F(DeformEquality, ReferenceSpringsAgree) {
    Pair pair(*device_, makeCube(kSide, 10, true), object(gpu::kDeformExtended));
    pair.burn([&](uint32_t texel) { return (texel * 37u) % 9000u; });
    for (uint32_t frame = 0; frame < 100; ++frame) {
        pair.frame(100 + frame * 256, 2);
        ASSERT_LT(pair.apart().place, 1e-5) << frame;
    }
    EXPECT_GT(pair.apart().moved, 1e-3);
}

}  // namespace
}  // namespace fw::test::deform_equality_test
