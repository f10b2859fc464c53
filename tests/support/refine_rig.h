// The refinement passes on a device for one object of a RefineScene: host-visible buffers, a
// barrier after every phase. of() reads results back.
#pragma once
#include "mesh/refine/table.h"
#include "support/pass_rig.h"
#include "support/refine_scene.h"

namespace fw::test {

// Bindings of the passes.
constexpr uint32_t kRefineBindings[] = {
    FW_BIND_PREDICT,        FW_BIND_GRADIENT,         FW_BIND_REFINE_WORK,
    FW_BIND_REFINE_OBJECTS, FW_BIND_REFINE_TRIANGLES, FW_BIND_REFINE_EDGES,
    FW_BIND_REFINE_SLOTS,   FW_BIND_REFINE_WORDS,     FW_BIND_REFINE_ITEMS,
    FW_BIND_REFINE_HEAT,    FW_BIND_REFINE_LEVELS,    FW_BIND_REFINE_VERTICES,
    FW_BIND_REFINE_INDICES, FW_BIND_REFINE_DRAWS,     FW_BIND_VERTICES,
    FW_BIND_REFINE_CUTS,    FW_BIND_REFINE_CUT_DRAWS, FW_BIND_OBJECT_COUNTERS};

class RefineRig {
 public:
    // cutTriangles: capacity; 0: nothing is cut. thick: with an inner skin.
    RefineRig(TestDevice& device, const RefineScene& scene, uint32_t cutTriangles = 0,
              bool thick = false)
        : device_(device),
          scene_(scene),
          rig_(device, kRefineBindings, sizeof push_),
          cutTriangles_(cutTriangles),
          inner_(thick ? uint32_t(scene.model.slots.size()) : 0) {
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
        rig_.make(FW_BIND_REFINE_LEVELS, (m.triangles.size() + gpu::kRefineSums) * 8);
        rig_.make(FW_BIND_REFINE_INDICES, full * 12);
        rig_.make(FW_BIND_REFINE_VERTICES, 2 * m.slots.size() * sizeof(gpu::RefineVertex));
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

    bool morph = true;  // false: a mutant whose new vertices jump to their place

    void frame(gpu::RefineObject object, uint32_t nowTick, float dt, uint32_t budget) {
        const mesh::RefineModel& m = scene_.model;
        object.edgeCount = uint32_t(m.edges.size());
        object.triangleCount = uint32_t(m.triangles.size());
        object.cornerCount = m.cornerCount;
        object.textureWidth = m.textureWidth;
        object.flags =
            gpu::kRefineIsActive | gpu::kRefineIsCounted | (fresh_ ? gpu::kRefineIsFresh : 0);
        object.materialEnd0 = object.materialEnd1 = gpu::uvec4(
            object.triangleCount, object.triangleCount, object.triangleCount, object.triangleCount);
        if (cutTriangles_ > 0) object.flags |= gpu::kRefineIsCut;
        object.cutTriangles = cutTriangles_;
        object.inner = inner_;
        fresh_ = false;
        of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0] = object;
        std::copy(lists_.begin(), lists_.end(), of<uint32_t>(FW_BIND_REFINE_WORK).begin());
        push_.nowTick = nowTick;
        of<gpu::RefineObject>(FW_BIND_REFINE_OBJECTS)[0].dt = dt;
        push_.budget = budget;
        device_.run([&](VkCommandBuffer commands) {
            rig_.begin(commands);
            for (uint32_t phase = 0; phase < 5; ++phase)
                dispatch(commands, 0, phase,
                         phase == 2 ? 1 : push_.edgeGroups + push_.triangleGroups);
        });
        for (gpu::RefineLevel& item : of<gpu::RefineLevel>(FW_BIND_REFINE_ITEMS))
            if (!morph) item.level = float(gpu::topLevel(item.level));
        device_.run([&](VkCommandBuffer commands) {
            rig_.begin(commands);
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
    std::vector<uint32_t> lists_;  // of the work buffer at the start of a frame
    gpu::RefinePush push_{};
    uint32_t cutTriangles_ = 0, inner_ = 0;
    bool fresh_ = true;
    uint32_t pipelines_[5] = {};
};

}  // namespace fw::test
