// See rays.h.
#include "rays.h"

#include <algorithm>
#include <atomic>
#include <thread>

namespace tower {

using village::Vec3;

RayTree::RayTree(std::vector<Vec3> corners) {
    const uint32_t count = uint32_t(corners.size() / 3);
    std::vector<uint32_t> order(count);
    for (uint32_t i = 0; i < count; ++i) order[i] = i;
    corners_ = std::move(corners);
    nodes_.reserve(size_t(count) * 2 + 1);
    nodes_.push_back({});
    split(0, order, 0, count);
    std::vector<Vec3> sorted;
    sorted.reserve(corners_.size());
    for (uint32_t i : order)
        for (uint32_t k = 0; k < 3; ++k) sorted.push_back(corners_[i * 3 + k]);
    corners_ = std::move(sorted);
}

void RayTree::split(uint32_t node, std::vector<uint32_t>& order, uint32_t first, uint32_t count) {
    Vec3 low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
    for (uint32_t i = first; i < first + count; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
            low = village::minimum(low, corners_[order[i] * 3 + k]);
            high = village::maximum(high, corners_[order[i] * 3 + k]);
        }
    }
    nodes_[node] = {low, high, first, count};
    if (count <= 4) return;
    const Vec3 size = high - low;
    const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    auto key = [&](uint32_t i) {
        const Vec3 sum = corners_[i * 3] + corners_[i * 3 + 1] + corners_[i * 3 + 2];
        return axis == 0 ? sum.x : axis == 1 ? sum.y : sum.z;
    };
    const uint32_t half = count / 2;
    std::nth_element(order.begin() + first, order.begin() + first + half,
                     order.begin() + first + count,
                     [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    const uint32_t left = uint32_t(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first = left;
    nodes_[node].count = 0;
    split(left, order, first, half);
    split(left + 1, order, first + half, count - half);
}

float RayTree::reach(Vec3 o, Vec3 d, float limit) const {
    const Vec3 inverse{1 / d.x, 1 / d.y, 1 / d.z};
    uint32_t stack[64], top = 0;
    stack[top++] = 0;
    while (top) {
        const Node& n = nodes_[stack[--top]];
        const Vec3 a = (n.low - o) * inverse, b = (n.high - o) * inverse;
        const float enter =
            std::max({std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z), 0.0f});
        const float leave =
            std::min({std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z), limit});
        if (!(enter <= leave)) continue;
        if (n.count == 0) {
            stack[top++] = n.first;
            stack[top++] = n.first + 1;
            continue;
        }
        for (uint32_t i = n.first; i < n.first + n.count; ++i) {
            const Vec3 corner = corners_[i * 3];
            const Vec3 e1 = corners_[i * 3 + 1] - corner, e2 = corners_[i * 3 + 2] - corner;
            const Vec3 p = village::cross(d, e2);
            const float det = village::dot(e1, p);
            if (std::fabs(det) < 1e-12f) continue;
            const Vec3 s = o - corner;
            const float u = village::dot(s, p) / det;
            if (u < 0 || u > 1) continue;
            const Vec3 q = village::cross(s, e1);
            const float v = village::dot(d, q) / det;
            if (v < 0 || u + v > 1) continue;
            const float t = village::dot(e2, q) / det;
            if (t > 1e-3f && t < limit) limit = t;
        }
    }
    return limit;
}

float openSky(const RayTree& tree, Vec3 point, Vec3 normal, int rays, float metres) {
    constexpr float kStart = 0.14f;  // m off the surface; a shorter offset lets thin trim blacken
                                     // its base
    constexpr float kFloor = 0.22f;
    const village::Frame f = village::along({}, normal);
    float open = 0;
    for (int s = 0; s < rays; ++s) {
        const float u = (float(s) + 0.5f) / float(rays), a = 2.39996f * float(s);
        const float r = std::sqrt(u);
        const Vec3 d = f.direction({r * std::cos(a), std::sqrt(1 - u), r * std::sin(a)});
        const float t = tree.reach(point + normal * kStart, d, metres);
        open += t < metres ? 0.6f * t / metres : 1;
    }
    return std::max(kFloor, open / float(rays));
}

void inParallel(int count, const std::function<void(int)>& body) {
    std::atomic<int> next{0};
    auto work = [&] {
        for (int i = next++; i < count; i = next++) body(i);
    };
    std::vector<std::thread> threads;
    const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
    for (unsigned i = 1; i < cores; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
}

}  // namespace tower
