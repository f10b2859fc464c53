// Flames and the world: colliders, queries, forces on bodies, neighbours, light, and bounds during
// all of it.
#include "core/error.h"
#include "volume/depth_picture.h"
#include "volume/flame.h"
#include "volume_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <random>
#include <string>

namespace {

using namespace fw::volume;
using testing::HasSubstr;
using volume_scene::campFire;

Collider plane(vec3 point, vec3 normal) {
    Collider c;
    c.kind = ColliderKind::Plane;
    c.place = point, c.extent = normal;
    return c;
}

float wave(void*, const float p[3], float n[3]) {  // a ball of 0.5 m from a host callback
    const float l = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; ++k) n[k] = l > 0 ? p[k] / l : 0.0f;
    return l - 0.5f;
}
float broken(void*, const float[3], float n[3]) {
    n[0] = NAN;
    return NAN;
}

TEST(VolumeCollide, DistancesAndNormals) {
    Collider ball;
    ball.radius = 0.5f;
    Collider capsule;
    capsule.kind = ColliderKind::Capsule, capsule.radius = 0.2f;
    capsule.place = vec3(0, 0, 0), capsule.extent = vec3(2, 0, 0);
    Collider box;
    box.kind = ColliderKind::Box, box.extent = vec3(1, 0.5f, 0.25f);
    box.rotation = vec4(0, std::sin(0.3f), 0, std::cos(0.3f));
    const float heights[] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
    Collider field;
    field.kind = ColliderKind::HeightField, field.heights = heights, field.columns = 3,
    field.rows = 3;
    field.radius = 1.0f;
    Collider host;
    host.kind = ColliderKind::Callback, host.distance = wave;
    EXPECT_NEAR(surfaceOf(ball, vec3(2, 0, 0)).distance, 1.5f, 1e-5f);
    EXPECT_NEAR(surfaceOf(capsule, vec3(1, 1, 0)).distance, 0.8f, 1e-5f);
    EXPECT_NEAR(surfaceOf(capsule, vec3(3, 0, 0)).distance, 0.8f, 1e-5f);
    EXPECT_NEAR(surfaceOf(box, vec3(0, 2, 0)).distance, 1.5f, 1e-5f);
    EXPECT_NEAR(surfaceOf(box, vec3(0)).distance, -0.25f, 1e-5f);
    EXPECT_NEAR(surfaceOf(plane(vec3(0, 2, 0), vec3(0, -1, 0)), vec3(5, 1.5f, 3)).distance, 0.5f,
                1e-5f);
    EXPECT_NEAR(surfaceOf(field, vec3(1, 3, 1)).normal.z, -std::sqrt(0.5f), 1e-5f);
    EXPECT_NEAR(surfaceOf(field, vec3(1, 1, 1)).distance, 0.0f, 1e-5f);
    EXPECT_GT(surfaceOf(field, vec3(-1, 0, 0)).distance, 1e6f) << "beyond the field there is none";
    EXPECT_NEAR(surfaceOf(host, vec3(0, 1, 0)).distance, 0.5f, 1e-5f);
    // The normal is the gradient of the distance.
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(-1.5f, 1.5f);
    for (const Collider* c : {&ball, &capsule, &box, &host})
        for (int k = 0; k < 200; ++k) {
            const vec3 p(unit(random), unit(random), unit(random));
            const Surface s = surfaceOf(*c, p);
            if (s.distance < 0.05f) continue;
            EXPECT_NEAR(surfaceOf(*c, p + 0.02f * s.normal).distance - s.distance, 0.02f, 2e-3f);
            EXPECT_NEAR(surfaceOf(*c, p - s.distance * s.normal).distance, 0.0f, 1e-3f);
        }
}

// A depth image of shapes from a camera a little below a ceiling.
struct SeenShapes {
    DepthPicture picture{std::pmr::get_default_resource()};
    glm::mat4 view{1.0f}, projection{0.0f};
    std::vector<float> depths;

    SeenShapes(std::span<const Collider> shapes, vec3 eye, vec3 to, bool perspective = true,
               bool reversed = false, float closer = 1.0f) {
        constexpr uint32_t kColumns = 160, kRows = 90;
        constexpr float kFar = 50.0f;
        view = glm::lookAt(eye, to, vec3(0, 1, 0));
        projection[0][0] = (perspective ? 1.6f : 0.5f) * 9.0f / 16.0f;
        projection[1][1] = perspective ? -1.6f : -0.5f;
        projection[0][0] *= closer, projection[1][1] *= closer;
        if (perspective) {  // infinite far plane, near at 0.02 m
            projection[2][2] = reversed ? 0.0f : -1.0f;
            projection[2][3] = -1.0f;
            projection[3][2] = reversed ? 0.02f : -0.02f;
        } else {
            projection[2][2] = -1.0f / kFar;
            projection[3][3] = 1.0f;
        }
        const glm::mat4 clip = projection * view, back = glm::inverse(clip);
        for (uint32_t row = 0; row < kRows; ++row)
            for (uint32_t column = 0; column < kColumns; ++column) {
                const auto at = [&](float depth) {
                    const vec4 p = back * vec4((float(column) + 0.5f) / kColumns * 2 - 1,
                                               (float(row) + 0.5f) / kRows * 2 - 1, depth, 1);
                    return vec3(p) / p.w;
                };
                const vec3 from = perspective ? eye : at(0.0f);
                const vec3 way = glm::normalize(at(0.5f) - from);
                float t = 0.0f;
                for (int k = 0; k < 400 && t < kFar; ++k)
                    t += std::max(nearestSurface(shapes, from + t * way).distance, 1e-5f);
                const vec4 seen = clip * vec4(from + t * way, 1);
                depths.push_back(t < kFar ? seen.z / seen.w : reversed ? 0.0f : 1.0f);
            }
        setDepthPicture(picture, depths, kColumns, kRows, glm::value_ptr(view),
                        glm::value_ptr(projection));
    }
    [[nodiscard]] Collider collider() const {
        Collider c;
        c.kind = ColliderKind::Depth, c.picture = &picture;
        return c;
    }
};

TEST(VolumeCollide, ADepthImageGivesTheVisibleSurface) {
    Collider shapes[3];
    shapes[0].kind = ColliderKind::Box;  // a ceiling with an edge
    shapes[0].place = vec3(0, 1.1f, 0), shapes[0].extent = vec3(0.8f, 0.1f, 0.6f);
    shapes[1] = plane(vec3(0, 0, -0.7f), vec3(0, 0, 1));
    shapes[2].place = vec3(0.9f, 0.4f, 0), shapes[2].radius = 0.3f;
    const vec3 eye(0.3f, 0.1f, 3.5f);
    for (const bool perspective : {true, false})
        for (const bool reversed : {false, true}) {
            if (!perspective && reversed) continue;
            const SeenShapes seen(shapes, eye, vec3(0, 0.6f, 0), perspective, reversed);
            const Collider picture = seen.collider();
            const vec3 ahead = glm::normalize(vec3(0, 0.6f, 0) - eye);
            std::mt19937 random(5);
            std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
            int near = 0, wrong = 0;
            for (int k = 0; k < 4000; ++k) {
                const vec3 p(1.2f * unit(random), 0.6f + 0.6f * unit(random), 0.7f * unit(random));
                const Surface wanted = nearestSurface(shapes, p);
                if (wanted.distance < 0.01f || wanted.distance > 0.2f) continue;
                // A depth image knows neither surfaces that face away nor hidden ones.
                const vec3 way = perspective ? glm::normalize(p - eye) : ahead;
                if (glm::dot(wanted.normal, way) > -0.15f) continue;
                bool open = true;
                for (float t = 0.02f; open && t < 3.0f; t += 0.02f)
                    open = nearestSurface(shapes, p - t * way).distance > 0.0f;
                if (!open) continue;
                const Surface is = surfaceOf(picture, p);  // from texels 5 cm wide
                ++near;
                wrong += std::abs(is.distance - wanted.distance) > 0.02f ||
                         glm::dot(is.normal, wanted.normal) < 0.9f;
            }
            EXPECT_GT(near, 200);
            EXPECT_LT(wrong, near / 20)
                << "perspective " << perspective << ", reversed " << reversed;
            // Gas slightly inside the ceiling is pushed back down, not out of the far side.
            const Surface inside = surfaceOf(picture, vec3(0, 1.03f, 0.1f));
            EXPECT_NEAR(inside.distance, -0.03f, 0.01f);
            EXPECT_LT(inside.normal.y, -0.98f);
            EXPECT_GT(surfaceOf(picture, vec3(0.9f, 0.4f, -0.5f)).distance, 0.15f)
                << "behind a ball";
            EXPECT_GT(surfaceOf(picture, vec3(0.3f, 0.5f, 4.5f)).distance, 1e6f)
                << "behind the camera";
            EXPECT_GT(surfaceOf(picture, vec3(40, 0.5f, 0)).distance, 1e6f) << "beside the picture";
        }
    const SeenShapes nothing({}, eye, vec3(0));
    EXPECT_GT(surfaceOf(nothing.collider(), vec3(0)).distance, 1e6f);
    DepthPicture picture(std::pmr::get_default_resource());
    const float none[16] = {}, depths[4] = {};
    EXPECT_THAT(volume_scene::failure([&] { setDepthPicture(picture, depths, 2, 2, none, none); }),
                HasSubstr("have no inverse"));
}

TEST(VolumeCollide, RefusesBadCollidersAndIgnoresBadCallbackResults) {
    const auto why = [](const Collider& c) -> std::string {
        try {
            checkCollider(c);
        } catch (const fw::core::Error& e) {
            return e.message;
        }
        return "fine";
    };
    Collider c;
    EXPECT_EQ(why(c), "fine");
    c.radius = -1.0f;
    EXPECT_THAT(why(c), HasSubstr("radius of the collider is -1 m"));
    EXPECT_THAT(why(plane(vec3(0), vec3(0))), HasSubstr("normal of the plane is (0, 0, 0)"));
    c = {}, c.place.x = INFINITY;
    EXPECT_THAT(why(c), HasSubstr("must be finite"));
    c = {}, c.kind = ColliderKind::HeightField;
    EXPECT_THAT(why(c), HasSubstr("null pointer"));
    c = {}, c.kind = ColliderKind::Box, c.rotation = vec4(0, 0, 0, 2);
    EXPECT_THAT(why(c), HasSubstr("squared length 4"));
    c = {}, c.kind = ColliderKind::Callback;
    EXPECT_THAT(why(c), HasSubstr("must be a function"));
    c.distance = broken;
    EXPECT_EQ(why(c), "fine");
    Flame f;
    FlameAir air;
    air.colliders = std::span(&c, 1);
    startFlame(f, campFire(), air);
    for (int k = 0; k < 60; ++k) advanceFlame(f, air, 1.0 / 60.0);
    EXPECT_TRUE(std::isfinite(f.bounds.high.y));
}

void expectJetUnder(const Collider& ceiling, float height) {
    FlameAir air;
    air.colliders = std::span(&ceiling, 1);
    Flame f;
    startFlame(f, campFire(), {});
    float most = 0.0f, far = 0.0f, contact = 0.0f;
    double flat = 0;
    int along = 0;
    for (int k = 0; k < 300; ++k) {
        advanceFlame(f, air, 1.0 / 60.0);
        if (k < 120) continue;
        for (const auto& n : f.nodes) {
            most = std::max(most, n.centre.y);
            if (n.along.w > f.record.high.w * fw::gpu::kFlameTop) break;
            far = std::max(far, std::hypot(n.centre.x, n.centre.z));
            if (std::abs(n.along.y) < 0.3f) flat += double(n.squeeze.w), ++along;
        }
        contact = std::max(contact, f.motion.contactPower);
    }
    EXPECT_LT(most, height);
    EXPECT_GT(far, 0.25f) << "blocked gas spreads";
    ASSERT_GT(along, 20);
    EXPECT_GT(flat / along, 0.4) << "and is flattened";
    EXPECT_GT(contact, 5.0f) << "kW into the ceiling";
    EXPECT_LT(f.motion.contactNormal.y, -0.9f);
}

TEST(VolumeCollide, ACeilingMakesAJet) {
    const Collider ceiling = plane(vec3(0, 0.45f, 0), vec3(0, -1, 0));
    {
        SCOPED_TRACE("a plane");
        expectJetUnder(ceiling, 0.45f);
    }
    SCOPED_TRACE("a depth image of it");
    const SeenShapes seen(std::span(&ceiling, 1), vec3(0.4f, 0.1f, 2.5f), vec3(0, 0.3f, 0));
    expectJetUnder(seen.collider(), 0.45f);
}

// A slab that the camera sees from above together with the room below, but never its underside.
TEST(VolumeCollide, ASlabSeenFromAboveMakesAJet) {
    Collider shapes[2] = {{}, plane(vec3(0), vec3(0, 1, 0))};
    shapes[0].kind = ColliderKind::Box;
    shapes[0].place = vec3(0, 0.49f, 0), shapes[0].extent = vec3(1.2f, 0.04f, 0.8f);
    const SeenShapes seen(shapes, vec3(0.85f, 1.25f, 6.5f), vec3(0, 0.45f, 0), true, false, 4.0f);
    expectJetUnder(seen.collider(), 0.53f);
    const Collider picture = seen.collider();
    for (const float x : {-0.4f, 0.0f, 0.4f}) {
        const Surface under = surfaceOf(picture, vec3(x, 0.4f, 0));
        EXPECT_NEAR(under.distance, 0.07f, 0.03f) << x;
        EXPECT_LT(under.normal.y, -0.98f) << x;
    }
    EXPECT_GT(surfaceOf(picture, vec3(0, -0.02f, 0)).normal.y, 0.9f) << "ground is no slab";
}

TEST(VolumeCollide, AWallDeflectsTheFlameAndHoldsNoGas) {
    Collider ball;
    ball.place = vec3(0.05f, 0.5f, 0.02f), ball.radius = 0.18f;
    FlameAir air;
    air.colliders = std::span(&ball, 1);
    Flame f;
    startFlame(f, campFire(), air);
    for (int k = 0; k < 300; ++k) {
        advanceFlame(f, air, 1.0 / 60.0);
        for (uint32_t p = 0; p < f.motion.count; ++p)
            ASSERT_GE(surfaceOf(ball, f.motion.particles[p].position).distance, -1e-4f);
        for (const auto& n : f.nodes)
            for (int c = 0; c < 4; ++c)
                ASSERT_TRUE(std::isfinite(n.centre[c]) && std::isfinite(n.squeeze[c]));
    }
}

// Bounds contain all visible parts, also when squeezed, leaning or teleported.
TEST(VolumeCollide, BoundsStayConservative) {
    Collider shapes[2] = {plane(vec3(0, 0.5f, 0), vec3(0, -1, 0)),
                          plane(vec3(0.3f, 0, 0), vec3(-1, 0, 0))};
    FlameAir air;
    air.colliders = shapes, air.wind = vec3(1.5f, 0, 0.5f);
    Flame f;
    startFlame(f, campFire(), air);
    Profile profile;
    paintDefaultProfile(f.def.appearance, profile);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    int lit = 0;
    for (int frame = 0; frame < 20; ++frame) {
        for (int k = 0; k < 9; ++k) advanceFlame(f, air, 1.0 / 60.0);
        const vec3 size = f.bounds.high - f.bounds.low;
        for (int k = 0; k < 6000; ++k) {
            const vec3 x = f.bounds.low - 0.4f * size +
                           1.8f * size * vec3(unit(random), unit(random), unit(random));
            const auto at = locate(f.nodes, x);
            if (!at) continue;
            const auto m = sampleFlame(f.record, profile, at->place, 0.001f, true);
            if (m.soot + m.smoke + m.emission.r + m.emission.b <= 0.0f) continue;
            ++lit;
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(x, f.bounds.low)) &&
                        glm::all(glm::lessThanEqual(x, f.bounds.high)));
        }
    }
    EXPECT_GT(lit, 100);
}

TEST(VolumeQuery, IsHotInsideTheFlameOnly) {
    Flame f;
    startFlame(f, campFire(), {});
    Profile profile;
    paintDefaultProfile(f.def.appearance, profile);
    const FlameAnswer core = queryFlame(f, profile, vec3(0, 0.15f, 0));
    EXPECT_TRUE(core.inside);
    EXPECT_GT(core.kelvin, 900.0f);
    EXPECT_LT(core.kelvin, 1500.0f);
    EXPECT_GT(core.heatFlux, 3e4f);
    EXPECT_LT(core.heatFlux, 2e5f);
    EXPECT_GT(core.gas.y, 1.0f) << "up-wind";
    const FlameAnswer above = queryFlame(f, profile, vec3(0, 1.1f, 0));
    EXPECT_FALSE(above.inside);
    EXPECT_GT(above.kelvin, 350.0f);
    EXPECT_GT(above.gas.y, 1.0f);
    float last = 1e9f;
    for (float x = 0.6f; x < 6.0f; x += 0.2f) {
        const FlameAnswer side = queryFlame(f, profile, vec3(x, 0.3f, 0));
        EXPECT_FALSE(side.inside);
        EXPECT_LT(side.heatFlux, last);
        last = side.heatFlux;
    }
    // 60 kW, 35 % radiated, at 3 m: 21000 / (4 pi 9) = 186 W/m^2.
    EXPECT_NEAR(queryFlame(f, profile, vec3(3, 0.3f, 0)).heatFlux, 186.0f, 25.0f);
    const FlameAnswer far = queryFlame(f, profile, vec3(1e6f, 0, 0));
    EXPECT_NEAR(far.kelvin, kAmbientKelvin, 0.1f);
    EXPECT_TRUE(std::isfinite(queryFlame(f, profile, f.def.position).heatFlux));
}

TEST(VolumeQuery, PushesAndIgnitesBodies) {
    Flame f;
    startFlame(f, campFire(), {});
    Profile profile;
    paintDefaultProfile(f.def.appearance, profile);
    const FlamePush paper = pushOf(f, profile, vec3(0, 0.4f, 0), 0.05f);
    EXPECT_GT(paper.force.y, 0.002f);
    EXPECT_LT(paper.force.y, 0.1f) << "a flame lifts ash and paper, not stones";
    EXPECT_GT(paper.ignition, 50.0f) << "W";
    EXPECT_EQ(glm::length(pushOf(f, profile, vec3(50, 0, 0), 0.05f).force), 0.0f);
    EXPECT_EQ(pushOf(f, profile, vec3(0, 0.4f, 0), 0.0f).ignition, 0.0f);
}

TEST(VolumeNeighbours, LeanMergeAndNeverPop) {
    const float height = flameHeight(60.0f, 0.6f);
    std::array<Neighbourhood, 2> out, last;
    bool were = false;
    for (float distance = 4.0f; distance >= 0.0f; distance -= 0.01f) {
        const NeighbourFlame pair[] = {{vec3(0), 60, 0.6f, height},
                                       {vec3(distance, 0, 0), 60, 0.6f, height}};
        updateNeighbours(pair, vec3(0, 1, 0), out);
        EXPECT_GE(out[0].pull.x, 0.0f);
        EXPECT_NEAR(out[0].pull.x, -out[1].pull.x, 1e-5f);
        const float gap = distance - 0.6f;
        if (gap < 0.98f * height) {
            EXPECT_GT(out[0].merged, 0.0f) << distance;
            EXPECT_GT(out[0].height, height * 0.999f);
        } else if (gap > height) {
            EXPECT_EQ(out[0].merged, 0.0f);
            EXPECT_FLOAT_EQ(out[0].height, height);
        }
        if (were && distance > 0.05f) {
            EXPECT_LT(std::abs(out[0].height - last[0].height), 0.02f) << distance;
            EXPECT_LT(glm::length(out[0].pull - last[0].pull), 0.05f) << distance;
        }
        last = out, were = true;
    }
    const NeighbourFlame near[] = {{vec3(0), 60, 0.6f, height},
                                   {vec3(1.0f, 0, 0), 60, 0.6f, height}};
    updateNeighbours(near, vec3(0, 1, 0), out);
    Flame f;
    FlameAir air;
    air.neighbours = out[0];
    startFlame(f, campFire(), air);
    double lean = 0;
    for (int k = 0; k < 240; ++k) {
        advanceFlame(f, air, 1.0 / 60.0);
        for (const auto& n : f.nodes)
            if (n.along.w >= f.size.height) {
                lean += double(n.centre.x) / 240.0;
                break;
            }
    }
    EXPECT_GT(lean, 0.01) << "towards each other";
    EXPECT_GT(f.size.height, height) << "together they are taller";
}

TEST(VolumeNeighbours, FlamesOfAChainMerge) {
    std::vector<NeighbourFlame> row;
    for (int k = 0; k < 40; ++k)
        row.push_back(
            {vec3(0.9f * float((k * 7) % 20) + (k >= 20 ? 100.0f : 0.0f), 0, 0), 60, 0.6f, 0.6f});
    std::vector<Neighbourhood> out(row.size());
    updateNeighbours(row, vec3(0, 1, 0), out);
    for (size_t k = 0; k < row.size(); ++k) EXPECT_GT(out[k].merged, 0.0f) << k;
    updateNeighbours({}, vec3(0, 1, 0), {});
    std::vector<NeighbourFlame> same(3, NeighbourFlame{vec3(1), 60, 0.6f, 0.6f});
    updateNeighbours(same, vec3(0, 1, 0), std::span(out).first(3));
    EXPECT_TRUE(std::isfinite(out[0].pull.x) && std::isfinite(out[0].height));
}

TEST(VolumeLight, CandleAndCampFireHaveMeasuredLight) {
    FlameDef d;
    const FlamePresetDef candle = presetDef(FlamePreset::Candle);
    d.appearance = candle.appearance, d.power = candle.power, d.diameter = candle.diameter;
    Flame f;
    startFlame(f, d, {});
    double sum = 0;
    float low = 1e9f, high = 0.0f;
    for (int k = 0; k < 600; ++k) {
        advanceFlame(f, {}, 1.0 / 60.0);
        sum += double(f.light.flux) / 600.0;
        low = std::min(low, f.light.flux), high = std::max(high, f.light.flux);
    }
    EXPECT_NEAR(sum, 12.6, 4.0) << "lm of a candle of 80 W";
    EXPECT_GT(high / low, 1.01f) << "it flickers";
    EXPECT_GT(f.light.colour.r, f.light.colour.g);
    // Two flames flicker independently.
    FlameDef a = campFire(), b = campFire();
    b.seed = 77;
    Flame fa, fb;
    startFlame(fa, a, {}), startFlame(fb, b, {});
    double ab = 0, aa = 0, bb = 0, ma = 0, mb = 0;
    std::vector<std::pair<double, double>> seen;
    for (int k = 0; k < 1200; ++k) {
        advanceFlame(fa, {}, 1.0 / 60.0), advanceFlame(fb, {}, 1.0 / 60.0);
        seen.push_back({double(fa.light.flux), double(fb.light.flux)});
        ma += seen.back().first / 1200, mb += seen.back().second / 1200;
    }
    for (const auto& [x, y] : seen)
        ab += (x - ma) * (y - mb), aa += (x - ma) * (x - ma), bb += (y - mb) * (y - mb);
    EXPECT_LT(ab / std::sqrt(aa * bb), 0.9);
    EXPECT_GT(fa.light.position.y, 0.1f);
}

}  // namespace
