// Lists the parts of a glTF file that the importer does not read: extensions, animations, cameras.
#pragma once

#include "import/gltf_access.h"

namespace fwimport {

// Refuses a file whose shapes cannot be read without an extension that is not read. An
// extension that changes only the look of a surface, or other parts of a scene, is no reason.
void checkRequired(const GltfFile& file);

// Notes every extension that is in the file and is not read, and whole kinds of things.
void noteLeftOut(const GltfFile& file, Notes& notes);

}  // namespace fwimport
