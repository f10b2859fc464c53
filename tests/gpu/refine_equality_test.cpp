// The refinement passes on a device against the library: integers equal, floats near. A rig of its
// own: one object, buffers the host can see, a barrier after every phase.
#include "mesh/refine/table.h"
#include "support/refine_scene.h"
#include "support/vulkan_device.h"

#include "shaders_embedded.h"
#include "shared/burn.h"

#include <cstring>

namespace fw::test {
namespace {

// What the passes bind.
constexpr uint32_t kBindings[] = {
    FW_BIND_STATE,          FW_BIND_GRADIENT,         FW_BIND_REFINE_WORK,
    FW_BIND_REFINE_OBJECTS, FW_BIND_REFINE_TRIANGLES, FW_BIND_REFINE_EDGES,
    FW_BIND_REFINE_SLOTS,   FW_BIND_REFINE_WORDS,     FW_BIND_REFINE_ITEMS,
    FW_BIND_REFINE_HEAT,    FW_BIND_REFINE_LEVELS,    FW_BIND_REFINE_VERTICES,
    FW_BIND_REFINE_INDICES, FW_BIND_REFINE_DRAWS};

class RefineRig {
 public:
    RefineRig(TestDevice& device, const RefineScene& scene) : device_(device), scene_(scene) {
        const mesh::RefineModel& m = scene.model;
        const size_t items = m.edges.size() + m.triangles.size();
        const size_t full = size_t(m.fullCount());
        makeLayouts();
        make(FW_BIND_REFINE_WORDS, sizeof mesh::kRefineTable, mesh::kRefineTable.data());
        make(FW_BIND_REFINE_TRIANGLES, m.triangles.size() * sizeof m.triangles[0],
             m.triangles.data());
        make(FW_BIND_REFINE_EDGES, m.edges.size() * sizeof m.edges[0], m.edges.data());
        make(FW_BIND_REFINE_SLOTS, m.slots.size() * sizeof m.slots[0], m.slots.data());
        make(FW_BIND_REFINE_HEAT, items * 4);
        make(FW_BIND_REFINE_ITEMS, items * sizeof(gpu::RefineLevel));
        make(FW_BIND_REFINE_LEVELS, m.triangles.size() * 8);
        make(FW_BIND_REFINE_INDICES, full * 12);
        make(FW_BIND_REFINE_VERTICES, m.slots.size() * sizeof(gpu::RefineVertex));
        make(FW_BIND_REFINE_OBJECTS, sizeof(gpu::RefineObject));
        make(FW_BIND_REFINE_DRAWS, 8 * 20);
        make(FW_BIND_STATE, scene.ticks.size() * 4, scene.ticks.data());
        make(FW_BIND_GRADIENT, scene.ticks.size() * 4);
        push_.objects = push_.objectEnd = 1;
        push_.recede = mesh::RefineSettings{}.recede;
        lists_.assign(gpu::kRefineWorkLists, 0);
        lists_[1] = lists_[2] = lists_[5] = lists_[6] = 1;
        push_.edgeGroups = list(uint32_t(m.edges.size()));
        push_.triangleGroups = list(uint32_t(m.triangles.size()));
        push_.cornerGroups = list(m.cornerCount);
        lists_.push_back(0);
        lists_.push_back(0);
        push_.emitJobs = uint32_t(lists_.size());
        push_.placeJobs = push_.emitJobs + uint32_t(2 * (full / 64 + 1));
        make(FW_BIND_REFINE_WORK, (push_.placeJobs + 2 * m.triangles.size()) * 4);
        const char* names[4] = {"refine_levels.comp", "refine_scan.comp", "refine_emit.comp",
                                "refine_place.comp"};
        for (int k = 0; k < 4; ++k) pipelines_[k] = makePipeline(names[k]);
    }
    ~RefineRig() {
        for (VkPipeline p : pipelines_) vkDestroyPipeline(device_.device, p, nullptr);
        vkDestroyDescriptorPool(device_.device, pool_, nullptr);
        vkDestroyPipelineLayout(device_.device, layout_, nullptr);
        vkDestroyDescriptorSetLayout(device_.device, setLayout_, nullptr);
    }
    RefineRig(const RefineRig&) = delete;
    RefineRig& operator=(const RefineRig&) = delete;

    template <typename T>
    [[nodiscard]] std::span<T> of(uint32_t binding) const {
        return {static_cast<T*>(data_[binding]), size_t(sizes_[binding]) / sizeof(T)};
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
        fresh_ = false;
        of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0] = object;
        std::copy(lists_.begin(), lists_.end(), of<uint32_t>(FW_BIND_REFINE_WORK).begin());
        push_.nowTick = nowTick;
        push_.dt = dt;
        push_.budget = budget;
        device_.run([&](VkCommandBuffer commands) {
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set_,
                                    0, nullptr);
            for (uint32_t phase = 0; phase < 4; ++phase)
                dispatch(commands, 0, phase, push_.edgeGroups + push_.triangleGroups);
            dispatch(commands, 1, 0, 1);
            dispatch(commands, 2, 0, 32);
            dispatch(commands, 3, 0, push_.cornerGroups);
            dispatch(commands, 3, 1, push_.edgeGroups);
            dispatch(commands, 3, 2, 32);
        });
    }

 private:
    void must(VkResult result) { ASSERT_EQ(VK_SUCCESS, result); }

    uint32_t list(uint32_t count) {
        for (uint32_t k = 0; k < count; k += 64) {
            lists_.push_back(0);
            lists_.push_back(k);
        }
        return (count + 63) / 64;
    }

    void makeLayouts() {
        constexpr auto kCount = uint32_t(std::size(kBindings));
        VkDescriptorSetLayoutBinding bindings[kCount]{};
        for (uint32_t k = 0; k < kCount; ++k)
            bindings[k] = {kBindings[k], VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                           VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
        VkDescriptorSetLayoutCreateInfo set{};
        set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        set.bindingCount = kCount;
        set.pBindings = bindings;
        must(vkCreateDescriptorSetLayout(device_.device, &set, nullptr, &setLayout_));
        const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push_};
        VkPipelineLayoutCreateInfo layout{};
        layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
        layout.setLayoutCount = 1;
        layout.pSetLayouts = &setLayout_;
        layout.pushConstantRangeCount = 1;
        layout.pPushConstantRanges = &push;
        must(vkCreatePipelineLayout(device_.device, &layout, nullptr, &layout_));
        const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kCount};
        VkDescriptorPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
        pool.maxSets = 1;
        pool.poolSizeCount = 1;
        pool.pPoolSizes = &size;
        must(vkCreateDescriptorPool(device_.device, &pool, nullptr, &pool_));
        VkDescriptorSetAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        allocate.descriptorPool = pool_;
        allocate.descriptorSetCount = 1;
        allocate.pSetLayouts = &setLayout_;
        must(vkAllocateDescriptorSets(device_.device, &allocate, &set_));
    }

    void make(uint32_t binding, size_t bytes, const void* content = nullptr) {
        const TestBuffer made = device_.makeBuffer(bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        data_[binding] = made.mapped;
        sizes_[binding] = bytes;
        std::memset(data_[binding], 0, bytes);
        if (content != nullptr) std::memcpy(data_[binding], content, bytes);
        const VkDescriptorBufferInfo buffer{made.buffer, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set_;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &buffer;
        vkUpdateDescriptorSets(device_.device, 1, &write, 0, nullptr);
    }

    VkPipeline makePipeline(const char* name) {
        const gpu::ShaderCode* code = gpu::findShader(name);
        if (code == nullptr) {
            ADD_FAILURE() << name << " is not embedded";
            return VK_NULL_HANDLE;
        }
        VkShaderModuleCreateInfo module{};
        module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        module.codeSize = code->words.size_bytes();
        module.pCode = code->words.data();
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.pName = "main";
        info.layout = layout_;
        must(vkCreateShaderModule(device_.device, &module, nullptr, &info.stage.module));
        VkPipeline pipeline = VK_NULL_HANDLE;
        must(
            vkCreateComputePipelines(device_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
        vkDestroyShaderModule(device_.device, info.stage.module, nullptr);
        return pipeline;
    }

    void dispatch(VkCommandBuffer commands, int pipeline, uint32_t phase, uint32_t groups) {
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[pipeline]);
        push_.phase = phase;
        vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof push_, &push_);
        vkCmdDispatch(commands, groups, 1, 1);
        VkMemoryBarrier barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
        barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT;
        barrier.dstAccessMask =
            VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                             VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                             1, &barrier, 0, nullptr, 0, nullptr);
    }

    TestDevice& device_;
    const RefineScene& scene_;
    std::vector<uint32_t> lists_;  // of the work plane, as a frame begins
    gpu::RefinePush push_{};
    bool fresh_ = true;
    VkDescriptorSetLayout setLayout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    VkPipeline pipelines_[4] = {};
    void* data_[FW_BIND_COUNT] = {};
    size_t sizes_[FW_BIND_COUNT] = {};
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
        std::copy(s.edgeHeat.begin(), s.edgeHeat.end(), heat.begin());
        std::copy(s.interiorHeat.begin(), s.interiorHeat.end(),
                  heat.begin() + long(s.edgeHeat.size()));
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

}  // namespace
}  // namespace fw::test
