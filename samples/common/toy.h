// A wooden elephant, modelled from blended spheres by marching tetrahedra: the default mesh to
// burn. One closed surface with thin ears, about 0.6 m tall.
#pragma once

#include "import/gltf_import.h"

fwimport::ImportedModel makeToy();
