// Motion of a flame: rising gas, wind, walls, scripts, host points; repeatable by seed and finite
// for any input.
#include "core/error.h"
#include "volume/flame.h"
#include "volume_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

namespace {

using namespace fw::volume;
using testing::HasSubstr;
using volume_scene::campFire;
using volume_scene::failure;

void expectSoundFlame(const Flame& f) {
    for (const auto& n : f.nodes)
        for (int c = 0; c < 4; ++c)
            ASSERT_TRUE(std::isfinite(n.centre[c]) && std::isfinite(n.along[c]) &&
                        std::isfinite(n.side[c]) && std::isfinite(n.squeeze[c]));
    float words[sizeof(f.record) / 4];
    std::memcpy(words, &f.record, sizeof(f.record));
    for (size_t k = 0; k < 60; ++k)
        ASSERT_TRUE(std::isfinite(words[k])) << "word " << k << " of the record";
    for (int c = 0; c < 3; ++c) ASSERT_LE(f.bounds.low[c], f.bounds.high[c]);
    ASSERT_TRUE(std::isfinite(f.light.flux) &&
                std::isfinite(f.light.position.x + f.light.colour.g));
}

// Degrees from vertical of the visible axis.
float tilt(const Flame& f) {
    for (const auto& n : f.nodes)
        if (n.along.w >= f.size.height) {
            const vec3 d = vec3(n.centre) - f.def.position;
            return glm::degrees(std::atan2(std::hypot(d.x, d.z), d.y));
        }
    return 90.0f;
}

TEST(VolumeMotion, SameSeedSameFlame) {
    Flame a, b, c;
    FlameDef other = campFire();
    other.seed = 2;
    startFlame(a, campFire(), {}), startFlame(b, campFire(), {}), startFlame(c, other, {});
    for (int k = 0; k < 300; ++k)
        for (Flame* f : {&a, &b, &c}) advanceFlame(*f, {}, 1.0 / 60.0);
    EXPECT_EQ(std::memcmp(&a.nodes, &b.nodes, sizeof a.nodes), 0);
    EXPECT_EQ(std::memcmp(&a.record, &b.record, sizeof a.record), 0);
    EXPECT_NE(std::memcmp(&a.nodes, &c.nodes, sizeof a.nodes), 0);
    EXPECT_NE(a.record.place, c.record.place);
    EXPECT_NE(a.scroll.puff, c.scroll.puff) << "no two flames puff in phase";
}

TEST(VolumeMotion, MovesContinuously) {
    Flame f;
    startFlame(f, campFire(), {});
    float most = 0.0f;
    for (int k = 0; k < 600; ++k) {
        const FlameNodes before = f.nodes;
        advanceFlame(f, {}, 1.0 / 60.0);
        for (size_t n = 0; n < f.nodes.size(); ++n)  // 0.6 m along the curve
            if (f.nodes[n].along.w < f.size.height)
                most =
                    std::max(most, glm::length(vec3(f.nodes[n].centre) - vec3(before[n].centre)));
    }
    EXPECT_LT(most, 0.04f) << "gas rises 0.06 m a frame; its axis must not jump as gas is born";
    EXPECT_GT(most, 0.0005f) << "but it sways";
}

TEST(VolumeMotion, LeansInWindAndRecovers) {
    float last = 0.0f;
    for (const float wind : {0.0f, 0.5f, 1.5f, 3.0f, 6.0f, 12.0f}) {
        Flame f;
        FlameAir air;
        air.wind = vec3(wind, 0, 0);
        startFlame(f, campFire(), air);
        double sum = 0;
        for (int k = 0; k < 240; ++k)
            advanceFlame(f, air, 1.0 / 60.0), sum += double(tilt(f)) / 240.0;
        expectSoundFlame(f);
        if (wind == 0.0f) {
            EXPECT_LT(sum, 8.0);
        }
        EXPECT_GT(sum, double(last) - 1.0) << wind << " m/s";
        if (wind == 3.0f) {
            EXPECT_GT(sum, 25.0);
            EXPECT_LT(sum, 65.0);
        }
        last = float(sum);
        air.wind = vec3(0);
        for (int k = 0; k < 120; ++k) advanceFlame(f, air, 1.0 / 60.0);
        EXPECT_LT(tilt(f), 12.0f);
    }
    EXPECT_GT(last, 45.0f);
}

TEST(VolumeMotion, SurvivesFastMotionAndTeleports) {
    Flame f;
    FlameDef d = campFire();
    d.appearance = presetDef(FlamePreset::Torch).appearance;
    d.power = 5.0f, d.diameter = 0.13f;
    startFlame(f, d, {});
    double time = 0;
    for (int k = 0; k < 600; ++k) {
        const double dt = k % 7 == 0 ? 1.0 / 15.0 : 1.0 / 90.0;
        time += dt;
        // A torch swung in a circle of 1 m at 10 m/s and teleported at times.
        const float a = float(10.0 * time);
        f.def.position = vec3(std::cos(a), 1.5f + 0.2f * std::sin(3.0f * a), std::sin(a));
        if (k % 200 == 150) f.def.position += vec3(500, 0, -300);
        advanceFlame(f, {}, dt);
        expectSoundFlame(f);
        ASSERT_NEAR(glm::length(vec3(f.nodes[0].centre) - f.def.position), 0.0f, 1e-3f);
    }
}

TEST(VolumeMotion, ExtremeDefsGiveFiniteNumbers) {
    for (const float power : {0.0f, 1e-6f, 0.08f, 1e6f})
        for (const float diameter : {1e-3f, 0.6f, 100.0f})
            for (const float height : {0.0f, 1e-5f, 200.0f})
                for (const float wind : {0.0f, 60.0f}) {
                    FlameDef d = campFire();
                    d.power = power, d.diameter = diameter, d.height = height;
                    Flame f;
                    FlameAir air;
                    air.wind = vec3(0, wind, 0);  // straight up too
                    startFlame(f, d, air);
                    for (const double dt : {0.0, 1e-9, 1.0 / 60.0, 10.0, double(NAN)})
                        advanceFlame(f, air, dt);
                    expectSoundFlame(f);
                }
}

TEST(VolumeMotion, GoesOutAndRelights) {
    Flame f;
    startFlame(f, campFire(), {});
    const float full = f.size.height;
    f.def.power = 0.0f;
    for (int k = 0; k < 240; ++k) advanceFlame(f, {}, 1.0 / 60.0);
    EXPECT_LT(f.record.air.w, 0.1f);
    EXPECT_LT(f.light.flux, 1.0f);
    f.def.power = 60.0f;
    for (int k = 0; k < 240; ++k) advanceFlame(f, {}, 1.0 / 60.0);
    EXPECT_NEAR(f.size.height, full, 0.02f * full);
    EXPECT_EQ(f.record.air.w, 1.0f);
}

TEST(VolumeMotion, TracksPlayLoopAndBlendBack) {
    Track track(std::pmr::get_default_resource());
    const float times[] = {0.0f, 1.0f, 2.0f};
    std::vector<ControlPoint> points;
    for (const float x : {0.0f, 1.0f, 0.0f})
        for (int k = 0; k < 4; ++k)
            points.push_back({{x * 0.2f * float(k), 0.3f * float(k), 0}, 0.2f});
    setTrack(track, times, points, 4, true);
    std::array<ControlPoint, kMaxControlPoints> at;
    for (const double t : {0.0, 2.0, 4.0, -2.0}) {
        ASSERT_EQ(sampleTrack(track, t, at), 4u);
        EXPECT_NEAR(at[3].position.x, 0.0f, 1e-4f) << t;
    }
    sampleTrack(track, 5.0, at);
    EXPECT_NEAR(at[3].position.x, 0.6f, 1e-4f);
    sampleTrack(track, 0.5, at);
    const float before = at[3].position.x;
    EXPECT_GT(before, 0.2f);
    EXPECT_LT(before, 0.4f);

    FlameDef d = campFire();
    d.position = vec3(10, 0, 0);
    FlameAir air;
    air.track = &track;
    Flame f;
    startFlame(f, d, air);
    f.def.driver = FlameDriver::Track;
    vec3 last = vec3(f.nodes[12].centre);
    float most = 0.0f;
    for (int k = 0; k < 240; ++k) {
        if (k == 120) f.def.driver = FlameDriver::Live;
        advanceFlame(f, air, 1.0 / 60.0);
        expectSoundFlame(f);
        if (k == 60) {  // fully the track's
            EXPECT_EQ(f.tracked, 1.0f);
            sampleTrack(track, f.trackTime, at);
            Curve curve;
            for (int p = 0; p < 4; ++p) at[size_t(p)].position += d.position;
            curve.set(std::span(at).first(4), d.up);
            EXPECT_NEAR(
                glm::length(curve.at(f.nodes[8].along.w).position - vec3(f.nodes[8].centre)), 0.0f,
                1e-3f);
        }
        most = std::max(most, glm::length(vec3(f.nodes[12].centre) - last));
        last = vec3(f.nodes[12].centre);
    }
    EXPECT_EQ(f.tracked, 0.0f);
    EXPECT_LT(most, 0.08f) << "the blend does not jump";
}

TEST(VolumeMotion, FollowsTheHostsPoints) {
    FlameDef d = campFire();
    d.driver = FlameDriver::Host;
    Flame f;
    startFlame(f, d, {});
    f.given[0] = {{3, 0, 0}, 0.3f}, f.given[1] = {{3, 0.5f, 1}, 0.2f},
    f.given[2] = {{3, 0.6f, 3}, 0.1f};
    f.givenCount = 3;
    advanceFlame(f, {}, 1.0 / 60.0);
    EXPECT_NEAR(vec3(f.nodes[0].centre).x, 3.0f, 1e-4f);
    EXPECT_NEAR(f.nodes[0].centre.w, 0.3f, 0.05f);
    f.givenCount = 1;  // a single point still gives a flame
    advanceFlame(f, {}, 1.0 / 60.0);
    expectSoundFlame(f);
    f.givenCount = 0;
    for (int k = 0; k < 60; ++k) advanceFlame(f, {}, 1.0 / 60.0);
    EXPECT_NEAR(vec3(f.nodes[0].centre).x, 0.0f, 1e-4f) << "without points it moves by itself";
}

TEST(VolumeMotion, RefusesBadInputByName) {
    Track t(std::pmr::get_default_resource());
    const float times[] = {0.0f, 0.0f};
    const std::vector<ControlPoint> points(4);
    EXPECT_THAT(failure([&] { setTrack(t, times, points, 2, true); }),
                HasSubstr("time of key 1 is 0 s"));
    EXPECT_THAT(failure([&] { setTrack(t, times, points, 3, true); }),
                HasSubstr("2 keys of 3 need 6"));
    const ControlPoint bad[] = {{{0, NAN, 0}, 1.0f}};
    EXPECT_THAT(failure([&] { checkControlPoints(bad); }),
                HasSubstr("position of control point 0 is (0, nan, 0)"));
    const ControlPoint thin[] = {{{0, 0, 0}, -1.0f}};
    EXPECT_THAT(failure([&] { checkControlPoints(thin); }),
                HasSubstr("radius of control point 0 is -1 m"));
}

}  // namespace
