// Lists the parts of a glTF file that the importer does not read: extensions, animations, cameras.
#pragma once

#include "import/gltf_access.h"

namespace fwimport {

// Rejects a file whose shapes require an unsupported extension. Extensions that only affect
// appearance or other parts of the scene are accepted.
void checkRequired(const GltfFile& file);

// Adds notes about unsupported extensions and whole unsupported categories.
void noteLeftOut(const GltfFile& file, Notes& notes);

}  // namespace fwimport
