// The compute passes, in the order of a frame (vk/frame.cpp). A row: the pass' name, the struct of
// its push constants. The name is also the name of its shader, its debug label and its timer.
//
// A pass binds what its shader declares in set 0 (shader_interface.h), so nothing else is listed
// here. A shader `name_texels.comp` runs instead of `name.comp` where the device has texel buffers.
//
// frame.cpp dispatches these passes. A row FW_PLAIN_PASS(name, part) needs no line there: one group
// of it begins that FramePart, without push constants.

// Objects created, moved or restored since the last frame.
FW_COMPUTE_PASS(reset, StepPush)
FW_COMPUTE_PASS(restore, StepPush)
FW_COMPUTE_PASS(field_mask, FieldPush)
FW_COMPUTE_PASS(field, FieldPush)
FW_COMPUTE_PASS(skin, SkinPush)
// The simulation, step by step. `burn_budget` runs before every pass that lights texels.
FW_COMPUTE_PASS(burn_budget, StepPush)
FW_COMPUTE_PASS(wake, StepPush)
FW_COMPUTE_PASS(events, StepPush)
FW_COMPUTE_PASS(events_all, StepPush)
FW_COMPUTE_PASS(rooms, StepPush)
FW_COMPUTE_PASS(heat, StepPush)
FW_COMPUTE_PASS(schedule, StepPush)
FW_COMPUTE_PASS(gather, StepPush)
FW_COMPUTE_PASS(arrival, StepPush)
FW_COMPUTE_PASS(arrival_rim, StepPush)
FW_COMPUTE_PASS(commit, StepPush)
FW_COMPUTE_PASS(reduce_clear, StepPush)
FW_COMPUTE_PASS(reduce_front, StepPush)
FW_COMPUTE_PASS(reduce, StepPush)
FW_COMPUTE_PASS(fire_cells, ExchangePush)
FW_COMPUTE_PASS(fire_sources, ExchangePush)
FW_COMPUTE_PASS(receivers, ExchangePush)
FW_COMPUTE_PASS(exchange, ExchangePush)
FW_COMPUTE_PASS(exchange_occlusion, ExchangePush)
FW_COMPUTE_PASS(ember_paths, ExchangePush)
FW_COMPUTE_PASS(contacts, ExchangePush)
FW_COMPUTE_PASS(parts, ExchangePush)
FW_COMPUTE_PASS(embers, ExchangePush)
// Arrival ahead of the front, and which burnt pieces fall: cosmetic.
FW_COMPUTE_PASS(predict_restart, StepPush)
FW_COMPUTE_PASS(predict_states, StepPush)
FW_COMPUTE_PASS(predict_gather, StepPush)
FW_COMPUTE_PASS(predict, StepPush)
FW_COMPUTE_PASS(predict_rim, StepPush)
FW_COMPUTE_PASS(predict_commit, StepPush)
FW_COMPUTE_PASS(support, StepPush)
// Deformation.
FW_COMPUTE_PASS(recede, DeformPush)
FW_COMPUTE_PASS(link_cache, DeformPush)
FW_COMPUTE_PASS(soft, DeformPush)
FW_COMPUTE_PASS(skin_to_mesh, DeformPush)
FW_COMPUTE_PASS(inner, DeformPush)
// Answers to the host.
FW_COMPUTE_PASS(probe, StepPush)
// Effects of each view.
FW_COMPUTE_PASS(body_numbers, StepPush)
FW_COMPUTE_PASS(body_cells, StepPush)
FW_COMPUTE_PASS(lights, StepPush)
FW_COMPUTE_PASS(soot, StepPush)
FW_COMPUTE_PASS(particles, ParticlePush)
FW_COMPUTE_PASS(flame_quads, StepPush)
FW_COMPUTE_PASS(particle_quads, ParticlePush)
FW_COMPUTE_PASS(sparks, SparkPush)
FW_COMPUTE_PASS(flame_sort, SortPush)
FW_COMPUTE_PASS(volume_probe, MarchPush)
FW_COMPUTE_PASS(volume_march, MarchPush)
FW_COMPUTE_PASS(volume_smoke, MarchPush)
FW_COMPUTE_PASS(body_flames, MarchPush)
FW_COMPUTE_PASS(body_tiles, MarchPush)
FW_COMPUTE_PASS(body_field, MarchPush)
FW_COMPUTE_PASS(body_march, MarchPush)
FW_COMPUTE_PASS(field_show, NoPush)
// Refinement.
FW_COMPUTE_PASS(refine_heat, RefinePush)
FW_COMPUTE_PASS(refine_levels, RefinePush)
FW_COMPUTE_PASS(refine_scan, RefinePush)
FW_COMPUTE_PASS(refine_emit, RefinePush)
FW_COMPUTE_PASS(refine_place, RefinePush)
FW_COMPUTE_PASS(refine_cut, RefinePush)
