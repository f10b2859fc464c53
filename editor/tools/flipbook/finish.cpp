#include "finish.h"

#include "sample.h"
#include "shared/black_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace fwtools {
namespace {

using namespace fw;

struct Plane {  // one scalar channel
    uint32_t width = 0, height = 0;
    std::vector<float> values;
    [[nodiscard]] float at(int x, int y) const {
        if (x < 0 || y < 0 || x >= int(width) || y >= int(height)) return 0;
        return values[size_t(y) * width + size_t(x)];
    }
    [[nodiscard]] float at(float x, float y) const {
        const float i = std::floor(x), j = std::floor(y), a = x - i, b = y - j;
        const int m = int(i), n = int(j);
        return (at(m, n) * (1 - a) + at(m + 1, n) * a) * (1 - b) +
               (at(m, n + 1) * (1 - a) + at(m + 1, n + 1) * a) * b;
    }
};

Plane seenOf(const Frame& frame, uint32_t width, uint32_t height) {
    Plane plane{width, height, {}};
    for (const vec4& t : frame.texels) {
        const float shows = t.z > 0 ? t.z : t.y;  // pure emission occludes nothing
        plane.values.push_back(shows * (0.4f + 0.6f * t.x) + 0.5f * t.w);
    }
    return plane;
}

Plane halved(const Plane& p) {
    Plane half{p.width / 2, p.height / 2, {}};
    for (uint32_t y = 0; y < half.height; ++y)
        for (uint32_t x = 0; x < half.width; ++x) {
            const int i = int(2 * x), j = int(2 * y);
            half.values.push_back(
                0.25f * (p.at(i, j) + p.at(i + 1, j) + p.at(i, j + 1) + p.at(i + 1, j + 1)));
        }
    return half;
}

constexpr int kBlock = 4;  // texels in each direction

float difference(const Plane& a, const Plane& b, float x, float y, vec2 by) {
    float sum = 0;
    for (int j = -kBlock; j <= kBlock; ++j)
        for (int i = -kBlock; i <= kBlock; ++i) {
            const float d =
                a.at(x + float(i), y + float(j)) - b.at(x + float(i) + by.x, y + float(j) + by.y);
            sum += d * d;
        }
    return sum;
}
float energy(const Plane& a, float x, float y) {
    float sum = 0;
    for (int j = -kBlock; j <= kBlock; j += 2)
        for (int i = -kBlock; i <= kBlock; i += 2) sum += a.at(x + float(i), y + float(j));
    return sum;
}

// Block matching from `guess`: best whole step within `reach`, then subtexel refinement.
vec2 search(const Plane& a, const Plane& b, float x, float y, vec2 guess, int reach) {
    vec2 best = guess;
    float least = 1e30f;
    for (int j = -reach; j <= reach; ++j)
        for (int i = -reach; i <= reach; ++i) {
            const vec2 by = guess + vec2(float(i), float(j));
            const float cost = difference(a, b, x, y, by) + 0.03f * float(i * i + j * j);
            if (cost < least) least = cost, best = by;
        }
    for (const int axis : {0, 1}) {
        vec2 one(0.0f);
        one[axis] = 1;
        const float low = difference(a, b, x, y, best - one),
                    high = difference(a, b, x, y, best + one);
        const float curve = low + high - 2 * difference(a, b, x, y, best);
        if (curve > 1e-5f) best[axis] += std::clamp(0.5f * (low - high) / curve, -0.5f, 0.5f);
    }
    return best;
}

// Median filter over 3 x 3 blocks, against outliers.
void removeOutliers(std::vector<vec2>& motion, int width, int height) {
    const std::vector<vec2> from = motion;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int part : {0, 1}) {
                float around[9];
                for (int k = 0; k < 9; ++k) {
                    const int i = std::clamp(x + k % 3 - 1, 0, width - 1);
                    const int j = std::clamp(y + k / 3 - 1, 0, height - 1);
                    around[k] = from[size_t(j * width + i)][part];
                }
                std::nth_element(around, around + 4, around + 9);
                motion[size_t(y * width + x)][part] = around[4];
            }
}

// Weighted mean of the neighbourhood; visible texels weigh more.
void smooth(std::vector<vec2>& motion, const std::vector<float>& weights, int width, int height) {
    std::vector<vec2> out(motion.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            vec2 sum(0.0f);
            float all = 1e-9f;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
                    const auto k = size_t(j * width + i);
                    sum += weights[k] * motion[k], all += weights[k];
                }
            out[size_t(y * width + x)] = all > 1e-8f ? sum / all : motion[size_t(y * width + x)];
        }
    motion.swap(out);
}

// Unknown texels take the motion of their neighbours.
void spread(std::vector<vec2>& motion, std::vector<float> known, int width, int height) {
    for (int turn = 0; turn < std::max(width, height); ++turn) {
        const std::vector<vec2> from = motion;
        const std::vector<float> was = known;
        bool more = false;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const auto k = size_t(y * width + x);
                if (was[k] > 0) continue;
                vec2 sum(0.0f);
                float all = 0;
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i)
                        if (was[size_t(j * width + i)] > 0)
                            sum += from[size_t(j * width + i)], ++all;
                if (all == 0) continue;
                motion[k] = sum / all;
                known[k] = 1;
                more = true;
            }
        if (!more) return;
    }
}

void fade(const flipbook::Facts& facts, std::vector<Frame>& frames) {
    const auto extra = uint32_t(frames.size()) - facts.frames;
    for (uint32_t i = 0; i < extra; ++i) {
        // Frame 0 blends from the frame that follows the last one.
        const float part = (float(i) + 0.5f) / float(extra);
        Frame& frame = frames[i];
        const Frame& past = frames[facts.frames + i];
        for (size_t k = 0; k < frame.texels.size(); ++k)
            frame.texels[k] = gpu::mixFlipbookTexels(past.texels[k], frame.texels[k],
                                                     glm::smoothstep(0.0f, 1.0f, part));
    }
    frames.resize(facts.frames);
}

// A loop may start anywhere: choose the frame with the smallest change.
void startAtSmallestChange(std::vector<Frame>& frames) {
    size_t best = 0;
    double least = 1e30;
    for (size_t i = 0; i < frames.size(); ++i) {
        const Frame &now = frames[i], &before = frames[(i + frames.size() - 1) % frames.size()];
        double sum = 0;
        for (size_t k = 0; k < now.texels.size(); ++k) {
            const vec4 d = now.texels[k] - before.texels[k];
            sum += double(d.y * d.y + d.z * d.z);
        }
        if (sum < least) least = sum, best = i;
    }
    std::rotate(frames.begin(), frames.begin() + std::ptrdiff_t(best), frames.end());
}

uint8_t byteOf(float value) { return uint8_t(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f); }

flipbook::Rect rectOf(const Frame& frame, uint32_t width, uint32_t height, flipbook::Rect rect) {
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const vec4& t = frame.texels[size_t(y) * width + x];
            if (byteOf(t.y) == 0 && byteOf(t.z) == 0) continue;
            rect.left = std::min(rect.left, uint16_t(x > 1 ? x - 2 : 0));
            rect.low = std::min(rect.low, uint16_t(y > 1 ? y - 2 : 0));
            rect.right = std::max(rect.right, uint16_t(std::min(x + 3, width)));
            rect.high = std::max(rect.high, uint16_t(std::min(y + 3, height)));
        }
    return rect;
}

// Where nothing glows, copy the temperature of the nearest glowing texel. Otherwise filtering would
// draw cold rims around hot regions.
void extendTemperatures(Frame& frame, uint32_t width, uint32_t height) {
    std::vector<uint8_t> known;
    for (const vec4& t : frame.texels) known.push_back(t.y > 0.02f);
    for (int turn = 0; turn < 4; ++turn) {
        const std::vector<uint8_t> was = known;
        for (int y = 0; y < int(height); ++y)
            for (int x = 0; x < int(width); ++x) {
                const size_t k = size_t(y) * width + size_t(x);
                if (was[k]) continue;
                float sum = 0, count = 0;
                for (int j = std::max(y - 1, 0); j <= std::min(y + 1, int(height) - 1); ++j)
                    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, int(width) - 1); ++i) {
                        const size_t there = size_t(j) * width + size_t(i);
                        if (was[there]) sum += frame.texels[there].x, ++count;
                    }
                if (count > 0) frame.texels[k].x = sum / count, known[k] = 1;
            }
    }
}

}  // namespace

void inParallel(uint32_t count, uint32_t threads, const std::function<void(uint32_t)>& work) {
    std::atomic<uint32_t> next{0};
    const auto run = [&] {
        for (uint32_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::thread> others;
    for (uint32_t i = 1; i < std::min(threads, count); ++i) others.emplace_back(run);
    run();
    for (std::thread& other : others) other.join();
}

std::vector<vec2> findMotion(const Frame& now, const Frame& next, uint32_t width, uint32_t height,
                             uint32_t motionWidth, uint32_t motionHeight) {
    std::vector<Plane> as{seenOf(now, width, height)}, bs{seenOf(next, width, height)};
    while (std::min(as.back().width, as.back().height) >= 24) {
        as.push_back(halved(as.back()));
        bs.push_back(halved(bs.back()));
    }
    const auto w = int(motionWidth), h = int(motionHeight);
    std::vector<vec2> motion(size_t(w) * size_t(h), vec2(0.0f));
    std::vector<float> weights(motion.size());
    for (size_t level = as.size(); level-- > 0;) {
        const Plane &a = as[level], &b = bs[level];
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const auto k = size_t(y * w + x);
                const float i = (float(x) + 0.5f) * float(a.width) / float(w) - 0.5f;
                const float j = (float(y) + 0.5f) * float(a.height) / float(h) - 0.5f;
                if (level + 1 < as.size()) motion[k] *= 2;
                weights[k] = std::max(energy(a, i, j) - 0.05f, 0.0f);
                if (weights[k] > 0)
                    motion[k] = search(a, b, i, j, motion[k], level + 1 == as.size() ? 2 : 1);
            }
        spread(motion, weights, w, h);
        removeOutliers(motion, w, h);
        smooth(motion, weights, w, h);
    }
    for (vec2& m : motion) m /= vec2(float(width), float(height));
    spread(motion, weights, w, h);
    return motion;
}

flipbook::Flipbook finishFlipbook(const flipbook::Facts& facts, std::vector<Frame>& frames,
                                  uint32_t threads, std::pmr::memory_resource* memory) {
    fade(facts, frames);
    if (facts.loops != 0) startAtSmallestChange(frames);
    for (Frame& frame : frames) extendTemperatures(frame, facts.width, facts.height);
    flipbook::Flipbook made(memory);
    made.facts = facts;
    const uint32_t w = facts.width, h = facts.height, mw = facts.motionWidth,
                   mh = facts.motionHeight;
    std::vector<std::vector<vec2>> motions(facts.frames);
    inParallel(facts.frames, threads, [&](uint32_t i) {
        const uint32_t next = i + 1 < facts.frames ? i + 1 : facts.loops ? 0 : i;
        if (frames[i].motion.empty()) {
            motions[i] = findMotion(frames[i], frames[next], w, h, mw, mh);
            return;
        }
        std::vector<float> known(size_t(mw) * mh);
        motions[i].assign(known.size(), vec2(0.0f));
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w; ++x) {
                const size_t to = size_t(y * mh / h) * mw + x * mw / w, from = size_t(y) * w + x;
                const float share = frames[i].texels[from].z;
                motions[i][to] += share * frames[i].motion[from];
                known[to] += share;
            }
        for (size_t k = 0; k < known.size(); ++k)
            if (known[k] > 0) motions[i][k] /= known[k];
        spread(motions[i], known, int(mw), int(mh));
    });
    float most = 1e-4f;
    for (const auto& motion : motions)
        for (const vec2& m : motion) most = std::max({most, std::abs(m.x), std::abs(m.y)});
    most = std::min(most, 0.25f);
    made.facts.maxMotion = most;
    for (uint32_t i = 0; i < facts.frames; ++i) {
        for (const vec4& t : frames[i].texels)
            for (int c = 0; c < 4; ++c) made.texels.push_back(byteOf(t[c]));
        for (const vec2& m : motions[i])
            for (int c = 0; c < 2; ++c)
                made.motion.push_back(uint8_t(128.5f + 127 * std::clamp(m[c] / most, -1.0f, 1.0f)));
        const uint32_t next = i + 1 < facts.frames ? i + 1 : facts.loops ? 0 : i;
        const flipbook::Rect none{uint16_t(w), uint16_t(h), 0, 0};
        flipbook::Rect rect = rectOf(frames[next], w, h, rectOf(frames[i], w, h, none));
        if (rect.left > rect.right) rect = {};
        made.rects.push_back(rect);
    }
    return made;
}

Picture makeSheet(const std::vector<flipbook::Flipbook>& flipbooks) {
    constexpr uint32_t kShown = 8, kSide = 144;
    Picture picture;
    picture.width = kShown * kSide;
    picture.height = uint32_t(flipbooks.size()) * kSide;
    picture.rgb.resize(size_t(3) * picture.width * picture.height);
    for (size_t row = 0; row < flipbooks.size(); ++row) {
        const flipbook::Flipbook& book = flipbooks[row];
        const bool smoke = book.facts.kind == flipbook::Kind::Smoke;
        for (uint32_t k = 0; k < kShown; ++k)
            for (uint32_t y = 0; y < kSide; ++y)
                for (uint32_t x = 0; x < kSide; ++x) {
                    const vec2 uv((float(x) + 0.5f) / kSide, 1 - (float(y) + 0.5f) / kSide);
                    const float time = (float(k) + 0.37f) / float(kShown);
                    const vec4 t = flipbook::sampleFlipbook(book, time, uv);
                    // Burnt-out parts cool.
                    const float cooled = book.facts.loops ? 0.0f : 160.0f * time;
                    vec3 light =
                        smoke ? vec3(0.16f, 0.19f, 0.24f) * (1 - t.z) +
                                    t.z * mix(vec3(0.055f, 0.05f, 0.045f), vec3(0.012f), t.w)
                              : 1.25f * t.y *
                                    gpu::sootRadiance(1650 + 600 * (t.x - 0.5f) - 1.5f * cooled);
                    if (!smoke && book.facts.loops)
                        light = 0.9f * t.y * gpu::sootRadiance(gpu::flipbookKelvin(t.x));
                    uint8_t* out =
                        &picture
                             .rgb[3 * ((row * kSide + y) * size_t(picture.width) + k * kSide + x)];
                    // Like film: overexposed colours become white.
                    const float bright = 0.2126f * light.x + 0.7152f * light.y + 0.0722f * light.z;
                    if (!smoke) light += 0.22f * std::max(bright - 0.25f, 0.0f);
                    for (int c = 0; c < 3; ++c) {
                        const float balanced = light[c] * (smoke ? 1.0f
                                                                 : (c == 0   ? 1.0f
                                                                    : c == 1 ? 1.25f
                                                                             : 1.6f));
                        const float shown = smoke ? balanced : 1 - std::exp(-1.5f * balanced);
                        out[c] = byteOf(std::pow(std::clamp(shown, 0.0f, 1.0f), 1 / 2.2f));
                    }
                }
    }
    return picture;
}

}  // namespace fwtools
