// Heat transfer between objects: radiation and plume against their formulas, occluder boxes, spread
// limits, embers, contacts.
#include "components/exchange_object.h"
#include "fire/presets.h"
#include "flamewright/flamewright_debug.h"
#include "gpu/cpu/cpu_backend.h"
#include "mesh/exchange_tiles.h"
#include "support/meshes.h"
#include "support/world_defs.h"
#include "world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>

namespace fw::test {
namespace {

using gpu::ivec3;
using gpu::ivec4;

const ivec3 kUp(0, 4096, 0);

gpu::FireSource sourceOf(uint32_t watts, uint32_t diameter) {
    gpu::FireSource s{};
    s.watts = watts;
    s.diameter = diameter;
    s.scale = gpu::power04(watts);
    s.place = ivec4(0, 0, 0, int(gpu::flameHeight(s.scale, diameter)));
    return s;
}

TEST(Exchange, ComputesThePowerOfTwoFifths) {
    EXPECT_EQ(0u, gpu::power04(0));
    double worst = 0;
    for (double x = 1; x < 4.2e9; x *= 1.037) {
        const auto whole = uint32_t(x);
        const double expected = std::pow(double(whole), 0.4) * 256;
        worst = std::max(worst, std::fabs(double(gpu::power04(whole)) / expected - 1));
    }
    EXPECT_LT(worst, 0.006);
}

TEST(Exchange, FlameHeightMatchesHeskestad) {
    for (const double kilowatts : {2.0, 30.0, 500.0, 20000.0}) {
        for (const double diameter : {0.05, 0.3, 1.0}) {
            const double tall = 0.235 * std::pow(kilowatts, 0.4);
            const double expected = std::max(tall - 1.02 * diameter, tall / 3) * 1000;
            const uint32_t scale = gpu::power04(uint32_t(kilowatts * 1000));
            EXPECT_NEAR(expected, double(gpu::flameHeight(scale, uint32_t(diameter * 1000))),
                        3 + expected * 0.02);
        }
    }
    EXPECT_NEAR(1128.4, double(gpu::fireDiameter(1000000)), 1.0);
}

TEST(Exchange, RadiationFollowsInverseSquareAndCosine) {
    const gpu::FireSource s = sourceOf(100000, 400);
    for (const double metres : {3.0, 5.0, 10.0, 20.0}) {
        const double half = s.place.w / 2000.0;
        const double length = std::sqrt(metres * metres + half * half);
        const double expected =
            0.33 * 100000 / (4 * 3.14159265 * length * length) * metres / length;
        const ivec3 at(int(metres * 1000), 0, 0);
        EXPECT_NEAR(expected, gpu::radiantFlux(s, kUp, at, ivec3(-4096, 0, 0), false),
                    3 + expected * 0.02);
        const uint32_t slanted = gpu::radiantFlux(s, kUp, at, ivec3(-2048, 0, 3547), false);
        EXPECT_NEAR(expected / 2, slanted, 3 + expected * 0.02);
        EXPECT_EQ(0u, gpu::radiantFlux(s, kUp, at, ivec3(4096, 0, 0), false));
        EXPECT_NEAR(expected, gpu::radiantFlux(s, kUp, at, ivec3(4096, 0, 0), true),
                    3 + expected * 0.02);
    }
    // Near the fire, a row of four points, bounded by the least distance.
    double sum = 0;
    const double x = 0.35;
    for (int i = 0; i < 4; ++i) {
        const double y = s.place.w / 1000.0 * (2 * i + 1) / 8;
        const double length = std::sqrt(x * x + y * y);
        sum += 0.33 * 25000 / (4 * 3.14159265 * length * length) * x / length;
    }
    EXPECT_NEAR(sum, gpu::radiantFlux(s, kUp, ivec3(350, 0, 0), ivec3(-4096, 0, 0), false),
                sum * 0.03);
    EXPECT_LE(gpu::radiantFlux(s, kUp, ivec3(1, 10, 0), ivec3(-4096, 0, 0), true), 60000u);
    EXPECT_EQ(0u, gpu::radiantFlux(s, kUp, ivec3(40000, 0, 0), ivec3(-4096, 0, 0), false));
}

TEST(Exchange, PlumeTemperatureMatchesMcCaffrey) {
    for (const double kilowatts : {1.0, 30.0, 1000.0}) {
        const uint32_t scale = gpu::power04(uint32_t(kilowatts * 1000));
        double before = 1e9;
        for (double z = 0.01; z < 12; z *= 1.1) {
            const double q = z / std::pow(kilowatts, 0.4);
            const double expected = q < 0.08  ? 800
                                    : q < 0.2 ? 63 / q
                                              : 21.6 * std::pow(q, -5.0 / 3);
            const double rise = gpu::plumeRise(uint32_t(z * 1000), scale);
            EXPECT_NEAR(expected, rise, 2 + expected * 0.06) << z;
            EXPECT_LE(rise, before + 1);
            before = rise;
        }
    }
    // The plume has the right width, never cools a hotter surface, and stays above the fire.
    const gpu::FireSource s = sourceOf(50000, 300);
    const uint32_t ambient = 293 * 16;
    const auto flux = [&](int x, int y, uint32_t heat) {
        return gpu::plumeFlux(s, gpu::flameFrame(s, kUp, ivec3(x, y, 0)), heat, ambient);
    };
    const double axis = gpu::plumeRise(1000, s.scale) * 25.0;
    EXPECT_NEAR(axis, flux(0, 1000, ambient), axis * 0.02);
    const double b = 0.12 * 1000 + 150;
    EXPECT_NEAR(axis * std::exp(-1.0), flux(int(b), 1000, ambient), axis * 0.02);
    EXPECT_NEAR(axis - 25 * 100, flux(0, 1000, ambient + 1600), axis * 0.02);
    EXPECT_EQ(0u, flux(0, 1000, 65535));
    EXPECT_EQ(0u, flux(0, -50, ambient));
    EXPECT_EQ(0u, flux(900, 1000, ambient));
    EXPECT_TRUE(gpu::flameLights(s, gpu::flameFrame(s, kUp, ivec3(200, 100, 0))));
    EXPECT_FALSE(gpu::flameLights(s, gpu::flameFrame(s, kUp, ivec3(400, 100, 0))));
    EXPECT_FALSE(gpu::flameLights(s, gpu::flameFrame(s, kUp, ivec3(0, 5000, 0))));
}

components::Pose randomPose(std::mt19937& random, float reach) {
    const auto one = [&] { return float(random() % 20001) / 10000.0f - 1; };
    glm::vec4 q(one(), one(), one(), one());
    q /= std::max(glm::length(q), 1e-3f);
    const float x = q.x, y = q.y, z = q.z, w = q.w;
    const float m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                           {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                           {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    components::Pose pose;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) pose.rotation[r][c] = m[r][c];
        pose.translation[r] = one() * reach;
    }
    return pose;
}

TEST(Exchange, OccluderBoxesAgreeWithRealArithmetic) {
    std::mt19937 random(5);
    uint32_t cut = 0, open = 0, near = 0;
    for (int i = 0; i < 20000; ++i) {
        const components::Pose pose = randomPose(random, 1);
        const float half[3] = {float(random() % 4000) / 1000, float(random() % 2000) / 1000,
                               float(random() % 800) / 1000};
        gpu::HeatOccluder occluder{};
        components::placeHeatOccluder(pose, half, occluder);
        int end[2][3];
        for (auto& p : end)
            for (int& value : p) value = int(random() % 8000) - 4000;
        const bool isCut = gpu::occluderBlocks(occluder, ivec3(end[0][0], end[0][1], end[0][2]),
                                               ivec3(end[1][0], end[1][1], end[1][2]));
        // Clipped in doubles without the ray's ends; `slack` grows or shrinks the box.
        const auto cuts = [&](double slack) {
            double a[3], d[3], length = 0;
            for (int k = 0; k < 3; ++k) {
                d[k] = end[1][k] - end[0][k];
                length += d[k] * d[k];
            }
            length = std::sqrt(length);
            const double spare = std::min(60.0, length / 4) / std::max(length, 1e-9);
            double low = spare, high = 1 - spare;
            for (int axis = 0; axis < 3; ++axis) {
                double from = 0, along = 0;
                for (int k = 0; k < 3; ++k) {
                    a[k] = end[0][k] - double(pose.translation[k]) * 1000;
                    from += double(pose.rotation[k][axis]) * a[k];
                    along += double(pose.rotation[k][axis]) * d[k];
                }
                const double size = double(half[axis]) * 1000 + slack;
                if (size < 0) return false;
                if (std::fabs(along) < 1e-9) {
                    if (std::fabs(from) > size) return false;
                    continue;
                }
                const double u = (-size - from) / along, v = (size - from) / along;
                low = std::max(low, std::min(u, v));
                high = std::min(high, std::max(u, v));
            }
            return low <= high;
        };
        const bool surely = cuts(-25), perhaps = cuts(25);
        if (surely != perhaps) {
            ++near;
            continue;
        }
        EXPECT_EQ(surely, isCut) << i;
        ++(isCut ? cut : open);
    }
    EXPECT_GT(cut, 3000u);
    EXPECT_GT(open, 3000u);
    EXPECT_LT(near, 3000u);
}

TEST(Exchange, TheReportedSourceDoesNotDependOnOrder) {
    EXPECT_EQ(0u, gpu::hopsOf(0));
    EXPECT_EQ(gpu::kNoneTexel, gpu::igniterOf(gpu::kLitByHand));
    std::mt19937 random(7);
    for (int i = 0; i < 1000; ++i) {
        const uint32_t hops = random() % 200, from = random() % 100000;
        const uint32_t by = gpu::litBy(hops, from);
        EXPECT_EQ(hops + 1, gpu::hopsOf(by));
        EXPECT_EQ(from, gpu::igniterOf(by));
        EXPECT_GT(gpu::kLitByHand, by);
        EXPECT_GT(by, gpu::litBy(hops + 1, 0));
        EXPECT_GT(by, gpu::litBy(hops, from + 1));
    }
    uint32_t may = 0;
    for (uint32_t to = 0; to < 20000; ++to) {
        may += gpu::mayReach(9, 3, to, 128, gpu::kChanceOne / 4) ? 1 : 0;
        EXPECT_TRUE(gpu::mayReach(9, 3, to, 128, gpu::kChanceOne));
        EXPECT_FALSE(gpu::mayReach(9, 3, to, 128, 0));
    }
    EXPECT_NEAR(5000, may, 250);
}

TEST(Exchange, ContactTimeStartsAtTheLaterOfFireAndTouch) {
    const uint32_t now = 100000, never = gpu::kNever;
    EXPECT_EQ(never, gpu::contactTick(gpu::kNever, 8192, 400, 0, now));
    EXPECT_EQ(never, gpu::contactTick(gpu::kOutWet, 8192, 400, 0, now));
    EXPECT_EQ(99480u + 500, gpu::contactTick(99480, 8192, 500, 0, now));
    EXPECT_EQ(now, gpu::contactTick(99000, 8192, 400, 0, now));  // long overdue
    EXPECT_EQ(99550u + 400, gpu::contactTick(99000, 8192, 400, 99550, now));
    EXPECT_EQ(never, gpu::contactTick(99480, 8192, 600, 0, now));  // not yet
    EXPECT_EQ(never, gpu::contactTick(99500, 8192, 100, 0, now));  // lit since the last exchange
    EXPECT_EQ(never, gpu::contactTick(99400, 300, 400, 0, now));   // burnt out before
    EXPECT_EQ(never, gpu::contactTick(10000, 8192, 400, 99550, now));  // touched too late
}

TEST(Exchange, EmbersFollowTheirRateAndLandDownwind) {
    const gpu::FireSource s = sourceOf(30000, 300);
    // 0.06 per second, from 1/16 W eight times a second, in Q32.
    const double perExchange = 0.06 / 8;
    const auto brands = uint32_t(perExchange / (30000.0 * 16) * 4294967296.0);
    uint32_t sent = 0;
    double x = 0, downwind = 0, energy = 0;
    for (uint32_t i = 0; i < 400000; ++i) {
        const uint32_t hash = gpu::emberOf(1, 5, 2, i * 512, 30000 * 16, brands);
        if (hash == 0) continue;
        ++sent;
        const gpu::Ember still = gpu::flyingEmber(s, hash, kUp, ivec3(0, 0, 0));
        const gpu::Ember blown = gpu::flyingEmber(s, hash, kUp, ivec3(4000, 0, 0));
        EXPECT_EQ(still.flight, blown.flight);
        EXPECT_LE(std::abs(still.landing.x), s.place.w + 150);
        EXPECT_NEAR(4000.0 * still.flight / 4096, blown.landing.x - still.landing.x, 20);
        EXPECT_GE(still.landing.y, s.place.w - 1);
        EXPECT_LE(still.landing.y, s.place.w * 4);
        x += still.landing.x;
        downwind += blown.landing.x;
        energy += still.energy;
    }
    EXPECT_NEAR(400000 * perExchange, sent, 200);
    EXPECT_NEAR(0, x / sent, 20);
    EXPECT_GT(downwind / sent, 500);
    EXPECT_GT(energy / sent, 300);
    EXPECT_NEAR(65536 * (1 - std::exp(-1.0)), gpu::emberLights(200, 256), 200);
    EXPECT_NEAR(32768 * (1 - std::exp(-1.0)), gpu::emberLights(200, 128), 200);
    EXPECT_EQ(0u, gpu::emberLights(0, 256));
    EXPECT_EQ(0u, gpu::emberLights(1000, 0));
}

struct Placed {
    mesh::BurnDomain domain{std::pmr::get_default_resource()};
    gpu::ExchangeObject place{};
    Placed(const Mesh& mesh, double density, const components::Pose& pose)
        : domain(mesh::bake(mesh.input(density), std::pmr::get_default_resource())) {
        components::placeExchangeObject(pose, domain, place);
    }
    [[nodiscard]] glm::dvec3 real(const components::Pose& pose, uint32_t texel) const {
        const mesh::TexelPosition& p = domain.texels[texel];
        const float rest[3] = {domain.origin[0] + domain.quantum * float(p.x),
                               domain.origin[1] + domain.quantum * float(p.y),
                               domain.origin[2] + domain.quantum * float(p.z)};
        float out[3];
        components::toWorld(pose, rest, out);
        return {double(out[0]) * 1000, double(out[1]) * 1000, double(out[2]) * 1000};
    }
};

TEST(Exchange, PlacesAreExactToAMillimetre) {
    std::mt19937 random(3);
    for (int i = 0; i < 40; ++i) {
        components::Pose pose = randomPose(random, 100);
        pose.scale = i % 3 == 0 ? 1.0f : float(random() % 100 + 1) / 20;
        const Placed placed(makeCube(0.5, 2), 32, pose);
        for (uint32_t texel = 0; texel < placed.domain.texelCount(); texel += 7) {
            if (!placed.domain.real(texel)) continue;
            const mesh::TexelPosition& p = placed.domain.texels[texel];
            const ivec3 at = gpu::toWorldMm(placed.place, ivec3(p.x, p.y, p.z));
            const glm::dvec3 real = placed.real(pose, texel);
            const double allowed = 1.6 + double(pose.scale) * 0.2;
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(real[k], at[k], allowed);
                EXPECT_GE(at[k], (k == 0   ? placed.place.rotation0
                                  : k == 1 ? placed.place.rotation1
                                           : placed.place.rotation2)
                                         .w -
                                     2);
                EXPECT_LE(at[k], placed.place.high[k] + 2);
            }
        }
    }
}

TEST(Exchange, TilesHaveCentresNormalsAndCells) {
    const Placed placed(makeCube(0.6, 3), 64, {});
    std::pmr::vector<gpu::ExchangeTile> tiles;
    const uint32_t cells = mesh::exchangeTiles(placed.domain, tiles);
    EXPECT_EQ(cells, mesh::sourceCells(tiles));
    EXPECT_GE(cells, 20u);
    EXPECT_LE(cells, 27u);  // a hollow grid of 3 x 3 x 3
    uint32_t texels = 0, seen = 0;
    for (const gpu::ExchangeTile& tile : tiles) {
        texels += tile.texels;
        if (tile.texels < 64) continue;  // tiles that lie within one face
        ++seen;
        EXPECT_LT(gpu::tileCluster(tile), cells);
        const ivec3 n = gpu::decodeNormal(tile.normal);
        const ivec3 at = gpu::toWorldMm(placed.place, gpu::tileMiddle(tile));
        for (int k = 0; k < 3; ++k)
            if (std::abs(n[k]) > 16000) {
                EXPECT_NEAR(n[k] > 0 ? 300 : -300, at[k], 3);
            }
    }
    EXPECT_EQ(placed.domain.report.realTexels, texels);
    EXPECT_GT(seen, 10u);
}

// Two facing sheets of one mesh, and a third far away.
Mesh facing(double gap) {
    Mesh mesh = makePlane(0.4, 0.3, 0, 1, 0, 3);
    const auto add = [&](double z, double v) {
        const uint32_t base = mesh.vertexCount();
        const Mesh more = makePlane(0.4, 0.3, 0, 1, 0, 3);
        for (size_t i = 0; i < more.vertexCount(); ++i)
            mesh.addVertex(more.positions[3 * i], more.positions[3 * i + 1], z, more.uvs[2 * i],
                           more.uvs[2 * i + 1] + v);
        for (const uint32_t index : more.indices) mesh.indices.push_back(base + index);
    };
    add(gap, 0.5);
    add(2, 1);
    return mesh;
}

TEST(Exchange, PartsOfAMeshFindTheirNearParts) {
    for (const double density : {24.0, 64.0, 200.0})
        for (const double gap : {0.001, 0.02, 0.045, 0.06}) {
            const Placed placed(facing(gap), density, {});
            const mesh::BurnDomain& domain = placed.domain;
            if (gap > 0.05) {
                EXPECT_TRUE(domain.partLinks.empty()) << density;
                continue;
            }
            ASSERT_EQ(domain.tileCount() * 4, domain.partLinks.size()) << density << " " << gap;
            uint32_t links = 0, blocks = 0;
            for (uint32_t at = 0; at < domain.partLinks.size(); ++at) {
                const uint32_t tile = at / 4, block = at % 4;
                const uint32_t corner =
                    tile / domain.tilesX * 8 * domain.width + tile % domain.tilesX * 8;
                bool near = false;
                for (uint32_t lane = 0; lane < 16; ++lane) {
                    const uint32_t texel = corner + (block / 2 * 4 + lane / 4) * domain.width +
                                           block % 2 * 4 + lane % 4;
                    near = near || (domain.real(texel) && placed.real({}, texel).z < 1000);
                }
                blocks += near ? 1 : 0;
                const uint32_t link = domain.partLinks[at];
                if (link == mesh::kNone) continue;
                ++links;
                const uint32_t lane = gpu::partFrom(link, block);
                const uint32_t from = corner + lane / 8 * domain.width + lane % 8;
                const uint32_t to = link % gpu::kPartTexels;
                ASSERT_TRUE(domain.real(from) && domain.real(to));
                EXPECT_EQ(block, lane % 8 / 4 + lane / 32 * 2);
                const glm::dvec3 p = placed.real({}, from) / 1000.0,
                                 q = placed.real({}, to) / 1000.0;
                EXPECT_NEAR(gap, std::fabs(p.z - q.z), 2e-3);
                EXPECT_LT(glm::length(p - q), gap + 0.5 / density + 2e-3) << density << " " << gap;
            }
            EXPECT_EQ(blocks, links) << density << " " << gap;  // one link per block of both sheets
            EXPECT_GT(links, 15u);
        }
    // A single part links to nothing, however near its own sides are.
    EXPECT_TRUE(Placed(makeCube(0.03, 2), 200, {}).domain.partLinks.empty());
}

TEST(Exchange, FireCrossesAGapInTheTimeOfAnOrdinaryLink) {
    const uint32_t now = 100 * gpu::kExchangeTicks;
    EXPECT_FALSE(gpu::partCrossed(gpu::kNever, 9999, 10, now));
    EXPECT_FALSE(gpu::partCrossed(now - gpu::kExchangeTicks, 9999, 10, now));  // lit too recently
    EXPECT_TRUE(gpu::partCrossed(now - gpu::kExchangeTicks - 1, 9999, 10, now));
    EXPECT_FALSE(gpu::partCrossed(now - 2000, 9999, 2001, now));
    EXPECT_TRUE(gpu::partCrossed(now - 2000, 9999, 2000, now));
    EXPECT_FALSE(gpu::partCrossed(now - 2000, 1999, 2000, now));  // burnt out by then
    for (const uint32_t delay : {0u, 1u, 511u, 512u, 513u, 5000u})
        for (uint32_t lit = now; lit < now + 1024; lit += 37) {
            uint32_t at = now;
            while (!gpu::partCrossed(lit, 99999, delay, at)) at += gpu::kExchangeTicks;
            EXPECT_EQ(at, gpu::partArrives(lit, delay)) << lit - now << " " << delay;
        }
}

TEST(Exchange, ContactsAreTheNearestTexelsWithinTheGap) {
    std::mt19937 random(11);
    for (const float gap : {0.0f, 0.02f, 0.045f, 0.06f}) {
        components::Pose a = randomPose(random, 3), b = a;
        // Next to it along its own z.
        for (int r = 0; r < 3; ++r) b.translation[r] = a.translation[r] + a.rotation[r][2] * gap;
        const Placed one(makePlane(0.4, 0.3), 64, a), two(makePlane(0.4, 0.3), 64, b);
        mesh::Contacts search(std::pmr::get_default_resource());
        mesh::findContacts({{&one.domain, &one.place, 1}, {&two.domain, &two.place, 1}}, search);
        const std::pmr::vector<mesh::Contact>& contacts = search.found[0];
        if (gap > 0.05f) {
            EXPECT_TRUE(contacts.empty());
            EXPECT_TRUE(search.found[1].empty());
            continue;
        }
        EXPECT_GT(contacts.size(), 20u);
        EXPECT_EQ(contacts.size(), search.found[1].size()) << "the sheets are equal";
        for (const mesh::Contact& contact : contacts) {
            const glm::dvec3 p = one.real(a, contact.texel), q = two.real(b, contact.fromTexel);
            EXPECT_NEAR(glm::length(p - q), contact.gap, 4);
            EXPECT_NEAR(double(gap) * 1000, contact.gap, 8);
        }
        mesh::findContacts({{&one.domain, &one.place, 0}, {&two.domain, &two.place, 1}}, search);
        EXPECT_TRUE(contacts.empty());  // noncombustible
    }
}

// Each block of 4 x 4 texels has its nearest pair. Ties: the first texel of the block, then the
// first 50 mm cell of the other mesh, then its first texel.
TEST(Exchange, ContactsAreTheNearestOfAllPairs) {
    std::mt19937 random(17);
    const auto cellOf = [](int mm) { return mm >= 0 ? mm / 50 : -((49 - mm) / 50); };
    size_t contacts = 0, ties = 0;
    for (int round = 0; round < 8; ++round) {
        components::Pose poses[2];
        if (round < 4) {  // side by side, with many equally near pairs
            poses[1].translation[0] = 0.05f * float(round) - 0.02f;
        } else {
            for (components::Pose& pose : poses) pose = randomPose(random, 0.1f);
        }
        const Placed boxes[2] = {{makeCube(0.2, 1), 32, poses[0]},
                                 {makeCube(0.2, 1), 32, poses[1]}};
        mesh::Contacts search(std::pmr::get_default_resource());
        mesh::findContacts(
            {{&boxes[0].domain, &boxes[0].place, 1}, {&boxes[1].domain, &boxes[1].place, 1}},
            search);
        for (int side = 0; side < 2; ++side) {
            const Placed &to = boxes[side], &from = boxes[1 - side];
            const auto placeOf = [](const Placed& box, uint32_t texel) {
                const mesh::TexelPosition& p = box.domain.texels[texel];
                return gpu::toWorldMm(box.place, ivec3(p.x, p.y, p.z));
            };
            std::map<uint32_t, mesh::Contact> found;  // by block of its texel
            const auto blockOf = [&](uint32_t texel) {
                return texel / to.domain.width / 4 * 4096 + texel % to.domain.width / 4;
            };
            for (const mesh::Contact& contact : search.found[side])
                found[blockOf(contact.texel)] = contact;
            EXPECT_EQ(search.found[side].size(), found.size()) << "one contact per block";
            std::map<uint32_t, std::array<int64_t, 6>> nearest;  // square, texel, cell, texel
            for (uint32_t a = 0; a < to.domain.texelCount(); ++a) {
                if (!to.domain.real(a) || to.domain.slowness[a] == 0) continue;
                const ivec3 p = placeOf(to, a);
                for (uint32_t b = 0; b < from.domain.texelCount(); ++b) {
                    if (!from.domain.real(b) || from.domain.slowness[b] == 0) continue;
                    const ivec3 q = placeOf(from, b), d = q - p;
                    const int64_t square = d.x * d.x + d.y * d.y + d.z * d.z;
                    if (square > 2500) continue;
                    const std::array<int64_t, 6> one = {square,      a,           cellOf(q.x),
                                                        cellOf(q.y), cellOf(q.z), b};
                    const auto [at, first] = nearest.emplace(blockOf(a), one);
                    if (!first && one[0] == at->second[0]) ++ties;
                    if (!first) at->second = std::min(at->second, one);
                }
            }
            EXPECT_EQ(nearest.size(), found.size());
            contacts += nearest.size();
            for (const auto& [block, one] : nearest) {
                EXPECT_EQ(one[1], int64_t(found[block].texel));
                EXPECT_EQ(one[5], int64_t(found[block].fromTexel));
                EXPECT_EQ(gpu::isqrtNear(uint32_t(one[0])), found[block].gap);
            }
        }
    }
    EXPECT_GT(contacts, 100u);
    EXPECT_GT(ties, 100u);
}

// Twelve fiercely burning sheets upwind of coarse ones on which many embers land at once.
class EmberRain {
 public:
    explicit EmberRain(uint32_t switches) {
        FwWorldDef def = plainWorldDef(FW_WORLD_EMBERS);
        def.paceFactor = 30;
        def.wind[0] = 3;
        world_ = std::make_unique<world::World>(def, backend, log_, memory_);
        world_->setSwitches(switches);
        FwMaterialDef hot = fire::presetDef(FW_MATERIAL_PAPER);
        hot.spreadRate = 0.0005f;
        hot.burnTime = 600;
        hot.heatOfCombustion = 4e7f;
        hot.burningFlux = 0.1f;
        const FwMaterialId material = world_->scene().createMaterial(hot);
        const Mesh sheet = makePlane(0.4, 0.4), ground = makePlane(2, 2);
        for (int i = 0; i < 12; ++i)
            add(sheet, 24, material, 0.5f * float(i / 6), 0, 0.5f * float(i % 6 + 1));
        for (int i = 0; i < 8; ++i)
            add(ground, 6, material, 1.5f + 2.1f * float(i / 2), -0.5f, 2.1f * float(i % 2 + 1));
        FwIgnitionDef ball{};
        ball.position[0] = 0.4f;
        ball.position[2] = 1.5f;
        ball.radius = 2;
        EXPECT_LT(0u, world_->burn().ignite(ball));
    }
    void step() { world_->advance(++frame_, 1.0f / 32); }

    gpu::cpu::CpuBackend backend{std::pmr::get_default_resource(), 4};
    uint32_t objects = 0;

 private:
    void add(const Mesh& mesh, float texels, FwMaterialId material, float x, float y, float z) {
        FwBurnableMeshDef def =
            plainBurnableDef(world_->scene().createMesh(plainMeshDef(mesh, texels)));
        def.materials[0] = material;
        def.transform[0] = def.transform[9] = def.transform[15] = 1;  // lies face up
        def.transform[6] = -1;
        def.transform[12] = x, def.transform[13] = y, def.transform[14] = z;
        (void)world_->createBurnableMesh(def);
        ++objects;
    }

    std::pmr::memory_resource* memory_ = std::pmr::get_default_resource();
    core::Log log_{FwCallbacks{}};
    std::unique_ptr<world::World> world_;
    uint64_t frame_ = 0;
};

// Devices run the threads of a dispatch in any order, and hosts hear the source and place of each
// ember.
TEST(Exchange, EmbersDoNotDependOnTheirOrder) {
    EmberRain inOrder(0), shuffled(FW_DEBUG_SHUFFLE);
    uint32_t spots = 0;
    for (int step = 0; step < 320; ++step) {
        inOrder.step();
        shuffled.step();
        spots = 0;
        for (uint32_t slot = 0; slot < inOrder.objects; ++slot) {
            const gpu::ObjectCounters& a = inOrder.backend.counters(slot);
            const gpu::ObjectCounters& b = shuffled.backend.counters(slot);
            ASSERT_EQ(a.spots, b.spots) << step << ", object " << slot;
            ASSERT_EQ(a.spotTexel, b.spotTexel) << step << ", object " << slot;
            ASSERT_EQ(a.litBy, b.litBy) << step << ", object " << slot;
            ASSERT_EQ(a.ignited, b.ignited) << step << ", object " << slot;
            spots += a.spots;
        }
    }
    EXPECT_GT(spots, 40u);
}

}  // namespace
}  // namespace fw::test
