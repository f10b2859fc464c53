// Deformation of one object on the CPU, in object axes: the reference for the passes recede,
// link_cache, soft, springs and skin_to_mesh.
#pragma once
#include "reference/far_links.h"

#include <span>

namespace fw::mesh {

struct DeformState {  // of one object; per vertex of the domain
    explicit DeformState(std::pmr::memory_resource* memory) : shown(memory), soft(memory) {}
    std::pmr::vector<gpu::ShownVertex> shown;
    struct Soft {            // of moving vertices; only vertices with a particle of their own count
        gpu::vec3 place[2];  // m: where it would be without constraints, now and next
        gpu::vec3 normal;    // unit
        float reach[2] = {};      // m to a pin along links that hold; 0: pinned
        bool known = false;       // see nextPath
        gpu::vec3 bend[2]{};      // m, correction by neighbours and by bending constraints
        gpu::vec3 share[2][2]{};  // m, of both, in the step before and in this one
        // As of the last update of the link cache.
        float burnt = 0;
        uint32_t holds =
            0;  // bits of holding links: neighbours, bending constraints of all sets << 8
        uint32_t pinned = 0;  // bits of neighbours
        gpu::vec4 anchor{0};  // m, the nearest point of a pin, and its radius
        bool whole = false;   // no link to a neighbour has parted
    };
    std::pmr::vector<Soft> soft;
    uint32_t parity = 0;  // of the next step: which positions are current
    uint32_t way = 0;     // and which bending constraints it uses
    bool tied = false;    // the link cache is up to date
};

struct SheetDrive {  // object axes
    gpu::vec3 up{0, 1, 0};
    gpu::vec3 wind{0};                           // m/s
    float gravity = 9.81f;                       // m/s^2
    float step = float(gpu::kSoftTicks) / 4096;  // s
    float time = 0;                              // s, of its gusts
    float updraft = 1;                           // factor of the fire's updraft, 0: none
};

// In its rest pose.
void resetDeform(const DeformModel& model, DeformState& state);
// Of moving vertices, after resetDeform: each vertex inside a pin is pinned.
void resetSoft(const DeformModel& model, const gpu::DeformObject& object, DeformState& state);
// `states`: the object's burn map (ticks or codes).
void recede(const DeformModel& model, const gpu::DeformObject& object,
            std::span<const uint32_t> states, uint32_t now, DeformState& state);
// `tears`: a sheet, whose holes are where it was torn.
void skinVertices(const DeformModel& model, DeformState& state, bool tears = false);
// One step of a sheet: pass soft, and before every fourth pass link_cache.
void sheetStep(const DeformModel& model, const gpu::DeformObject& object, const SheetDrive& drive,
               DeformState& state);
// One step of springs of `stiffness` (1/s^2); `lost`: m that every particle recedes in it.
void springStep(const DeformModel& model, std::span<const reference::FarLinks> far, float stiffness,
                float step, std::span<const float> lost, float damping, DeformState& state);

}  // namespace fw::mesh
