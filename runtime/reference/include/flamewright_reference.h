/* flamewright_reference.h: UNSTABLE. Methods of papers that Flamewright is compared with. They are in the static library
 * flamewright_reference, which contains all of Flamewright: link it instead of the shared library, which refuses these bits. */
/* Laid out by hand. */
/* clang-format off */
#ifndef FLAMEWRIGHT_REFERENCE_H
#define FLAMEWRIGHT_REFERENCE_H
#include "flamewright/flamewright.h"
#include "flamewright/flamewright_debug.h"

/* FwBurnableMeshDef::flags, beside FwBurnableFlags. */
/* Fire spreads by a 16-tap kernel. The object keeps no ledger: its FwObjectState::energy is 0. It cannot be saved, sought,
 * carried, played or forecast. */
#define FW_BURNABLE_PUBLISHED 4u
/* Instead of FW_BURNABLE_REFINE: each triangle has a template of four-way splits. It refines where a heat boundary reaches it;
 * the boundary grows from the host's first ignition (fire from other objects stays coarse). Burnt triangles vanish whole,
 * levels crack where they meet, and there is no budget. Fire and mesh are the same. The heat boundary at a radius r is where
 * r^2 = |sin(pi Theta / heatStep) + sin(pi Theta) + heatPsi |x - x0|^2|, Theta random:
 * FwBurnableMeshDef::heatPsi: 1/m^2, [0, 1e8], default 0: 1 / (mean finest edge)^2
 * FwBurnableMeshDef::heatStep: growth of r in a step of 1/32 s, [0, 1000], default 0: as fast as the materials' fastest fire */
#define FW_BURNABLE_REFINE_PUBLISHED 64u
/* Deformed by a mass-spring model. Excludes FW_BURNABLE_SKINNED, REFINE, RECEDE and SHELL. */
#define FW_BURNABLE_SPRINGS 512u
/* With FW_BURNABLE_RECEDE or FW_BURNABLE_SPRINGS: once the object has ignited, a depth peel hides its self-intersections. Costs
 * one depth draw of the object for each view, shows no insides, and needs a target with FW_DEPTH_TEST. */
#define FW_BURNABLE_DEPTH_PEEL 8192u

/* FwVolumetricFireDef::tier, beside FwFireTier: view-aligned planes through the flame's lattice, one sample each. For hosts that
 * can run little before their pass. Layers may be visible. Slices need FW_OUTPUT_LINEAR; with another FwOutputEncoding they
 * would blend wrongly, so the fire is marched low instead. */
#define FW_FIRE_TIER_SLICES 4u

/* FwParticleFieldDef::flags, beside FwParticleFieldFlags: ten steps a second, shown without interpolation. */
#define FW_FIELD_AS_PUBLISHED 2u

/* fwDebug_SetSwitches, beside FwDebugSwitch: objects with FW_BURNABLE_DEPTH_PEEL draw only front faces. */
#define FW_DEBUG_NO_DEPTH_PEEL 256u

#endif
