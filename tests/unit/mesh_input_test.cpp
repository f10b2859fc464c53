// Unusable input is refused with a message; failed allocations leave nothing behind.
#include <cstdio>
#include <limits>
#include <new>

#include "unit/mesh_checks.h"

namespace {

using namespace fw;
using namespace fw::test;

class MeshInput : public testing::Test {
 protected:
    Mesh mesh_ = makePlane(1, 1);
};

TEST_F(MeshInput, RefusesEmptyMeshes) {
    EXPECT_EQ("positions is empty; a mesh needs at least 3 vertices.", refusal({}));
    mesh_.indices.clear();
    EXPECT_EQ("indices is empty; a mesh needs at least 1 triangle.", refusal(mesh_.input()));
}

TEST_F(MeshInput, RefusesMismatchedSizes) {
    mesh_.indices.pop_back();
    EXPECT_EQ("indices has 5 elements; it must be a multiple of 3.", refusal(mesh_.input()));
    mesh_ = makePlane(1, 1);
    mesh_.positions.pop_back();
    EXPECT_EQ("positions has 11 elements; it must be a multiple of 3.", refusal(mesh_.input()));
    mesh_ = makePlane(1, 1);
    mesh_.uvs.pop_back();
    EXPECT_EQ("uvs has 7 elements; the vertices need 8 (or none).", refusal(mesh_.input()));
    mesh_.uvs.clear();
    mesh_.normals = {0, 0, 1};
    EXPECT_EQ("normals has 3 elements; the vertices need 12 (or none).", refusal(mesh_.input()));
    mesh_.normals.clear();
    mesh::BakeInput input = mesh_.input();
    const std::vector<uint8_t> materials{0, 1, 2};
    input.triangleMaterials = materials;
    EXPECT_EQ("triangleMaterials has 3 elements; the triangles need 2 (or none).", refusal(input));
}

TEST_F(MeshInput, RefusesNonFiniteNumbers) {
    const float infinity = std::numeric_limits<float>::infinity();
    mesh_.positions[7] = std::nanf("");
    EXPECT_EQ("Position of vertex 2, component 1, is nan; it must be finite and within +-1e+06.",
              refusal(mesh_.input()));
    mesh_.positions[7] = 2e6f;
    EXPECT_EQ("Position of vertex 2, component 1, is 2e+06; it must be finite and within +-1e+06.",
              refusal(mesh_.input()));
    mesh_.positions[7] = 1;
    mesh_.uvs[5] = -infinity;
    EXPECT_EQ("UV of vertex 2, component 1, is -inf; it must be finite and within +-1e+06.",
              refusal(mesh_.input()));
    mesh_.uvs[5] = 0;
    mesh_.normals.assign(12, 0);
    mesh_.normals[0] = infinity;
    EXPECT_EQ("Normal of vertex 0, component 0, is inf; it must be finite and within +-1e+06.",
              refusal(mesh_.input()));
    mesh_.normals.clear();
    mesh::BakeInput input = mesh_.input();
    const std::vector<float> details{0, 0, 0, 0, 0, 0, std::nanf(""), 0};
    input.details = details;
    EXPECT_EQ(
        "Detail coordinate of vertex 3, component 0, is nan; it must be finite and within "
        "+-1e+06.",
        refusal(input));
}

TEST_F(MeshInput, RefusesIndicesAndMaterialsOutOfRange) {
    mesh_.indices[4] = 4;
    EXPECT_EQ("Index 4 (corner 1 of triangle 1) is 4; the mesh has 4 vertices.",
              refusal(mesh_.input()));
    mesh_.indices[4] = kNone;
    EXPECT_NE("", refusal(mesh_.input()));
    mesh_ = makePlane(1, 1);
    mesh::BakeInput input = mesh_.input();
    const std::vector<uint8_t> materials{7, 8};
    input.triangleMaterials = materials;
    EXPECT_EQ("Material of triangle 1 is 8; it must be less than 8.", refusal(input));
}

TEST_F(MeshInput, RefusesZeroAreaAndExtremeSizes) {
    Mesh line;
    for (int i = 0; i < 3; ++i) line.addVertex(i, 0, 0);
    line.addTriangle(0, 1, 2);
    line.addTriangle(0, 0, 1);
    EXPECT_EQ(
        "The mesh's area is 0 m^2: all 2 triangles are degenerate; at least 1 must have area.",
        refusal(line.input()));
    Mesh point;
    for (int i = 0; i < 3; ++i) point.addVertex(1, 1, 1);
    point.addTriangle(0, 1, 2);
    EXPECT_EQ("The mesh's longest side is 0 m; it must lie in [0.0001, 100000] m.",
              refusal(point.input()));
    EXPECT_NE("", refusal(makePlane(1e-5, 1e-5).input()));
    EXPECT_NE("", refusal(makePlane(2e5, 1).input()));
    EXPECT_EQ("", refusal(makePlane(9e4, 10).input())) << "long and thin is fine";
    EXPECT_EQ("", refusal(makePlane(2e-4, 2e-4).input()));
}

TEST_F(MeshInput, RefusesSettingsOutOfRange) {
    mesh::BakeInput input = mesh_.input();
    for (double bad : {0.0, -1.0, 5000.0, double(std::nanf("")), 1e300}) {
        input.texelsPerMetre = bad;
        EXPECT_NE(std::string::npos, refusal(input).find("must lie in (0, 4096]")) << bad;
    }
    input = mesh_.input();
    input.maxSide = 7;
    EXPECT_EQ("maxSide is 7; it must lie in [8, 4096].", refusal(input));
    input.maxSide = 4097;
    EXPECT_NE("", refusal(input));
    input = mesh_.input();
    input.noiseAmplitude = 0.6f;
    EXPECT_EQ("noiseAmplitude is 0.6; it must lie in [0, 0.5].", refusal(input));
    input.noiseAmplitude = std::nanf("");
    EXPECT_NE("", refusal(input));
    input = mesh_.input();
    input.noiseFeature = 0;
    EXPECT_NE("", refusal(input));
}

TEST_F(MeshInput, RefusesMoreChartsThanTheAtlasHolds) {
    Mesh soup;  // 400 separate triangles for 8 x 8 texels
    for (uint32_t i = 0; i < 400; ++i) {
        for (int k = 0; k < 3; ++k) soup.addVertex(i % 20 + (k == 1) * 0.5, i / 20, (k == 2) * 0.5);
        soup.addTriangle(i * 3, i * 3 + 1, i * 3 + 2);
    }
    soup.uvs.clear();
    EXPECT_EQ("The mesh falls into 400 charts; an atlas of 8 x 8 texels has no room for them.",
              refusal(soup.input(128, 8)));
    expectSound(bakeOf(soup.input(128, 128)));
}

TEST_F(MeshInput, IgnoresUvsWithoutArea) {
    std::fill(mesh_.uvs.begin(), mesh_.uvs.end(), 0.5f);
    for (bool trust : {false, true}) {
        mesh::BakeInput input = mesh_.input(32);
        input.trustUvs = trust;
        const BurnDomain d = bakeOf(input);
        expectSound(d);
        EXPECT_EQ(0u, d.report.usedOwnUv);
        EXPECT_EQ(1024u, d.report.realTexels);
    }
}

// Fails from the n-th allocation on and counts unreturned bytes.
class LimitedMemory final : public std::pmr::memory_resource {
 public:
    explicit LimitedMemory(uint64_t limit) : limit_(limit) {}
    [[nodiscard]] uint64_t made() const { return made_; }
    [[nodiscard]] int64_t bytes() const { return bytes_; }

 private:
    void* do_allocate(size_t size, size_t alignment) override {
        if (made_ >= limit_) throw std::bad_alloc();
        ++made_;
        bytes_ += int64_t(size);
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* memory, size_t size, size_t alignment) override {
        bytes_ -= int64_t(size);
        std::pmr::new_delete_resource()->deallocate(memory, size, alignment);
    }
    bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
        return this == &other;
    }
    uint64_t limit_, made_ = 0;
    int64_t bytes_ = 0;
};

void cookAndRead(const mesh::BakeInput& input, std::pmr::memory_resource* memory) {
    const BurnDomain d = mesh::bake(input, memory);
    const auto bytes = mesh::writeCooked(d, mesh::bakeKey(input), memory);
    const BurnDomain again = mesh::readCooked(bytes, memory);
    std::pmr::vector<uint32_t> near(memory);
    mesh::texelsNear(again, d.boundsLow, 0.1f, near);
}

TEST_F(MeshInput, SurvivesFailureAtEveryAllocation) {
    for (bool own : {true, false}) {
        Mesh mesh = makeCube(0.5, 2);
        if (!own) mesh.uvs.clear();
        if (own)  // overlapping islands: the longest path through the bake
            for (uint32_t v = 0; v < mesh.vertexCount(); ++v)
                for (uint32_t c = 0; c < 2; ++c) mesh.uvs[v * 2 + c] = mesh.uvs[(v % 9) * 2 + c];
        const mesh::BakeInput input = mesh.input(24);
        LimitedMemory plenty(kNone);
        cookAndRead(input, &plenty);
        EXPECT_EQ(0, plenty.bytes());
        EXPECT_GT(plenty.made(), 50u);
        for (uint64_t limit = 0; limit < plenty.made(); ++limit) {
            LimitedMemory memory(limit);
            EXPECT_THROW(cookAndRead(input, &memory), std::bad_alloc) << limit;
            ASSERT_EQ(0, memory.bytes()) << "leaked when allocation " << limit << " failed";
        }
        std::printf("[   FIGURE ] each of %llu allocations failed in turn\n",
                    static_cast<unsigned long long>(plenty.made()));
    }
}

TEST_F(MeshInput, AllMemoryComesFromTheGivenResource) {
    std::pmr::memory_resource* before =
        std::pmr::set_default_resource(std::pmr::null_memory_resource());
    LimitedMemory memory(kNone);
    const Mesh sphere = makeCube(0.5, 8, true);
    EXPECT_NO_THROW(cookAndRead(sphere.input(32), &memory));
    std::pmr::set_default_resource(before);
    EXPECT_EQ(0, memory.bytes());
}

}  // namespace
