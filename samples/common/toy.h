// A wooden elephant, carved out of blended balls by marching tetrahedra: the mesh that burns when
// no file is named. One closed surface with thin ears, about 0.6 m tall.
#pragma once

#include "import/gltf_import.h"

fwimport::ImportedModel makeToy();
