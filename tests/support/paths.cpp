#include "support/paths.h"

namespace fw::test {

const char* const kTestFolder = TEST_FOLDER;
const char* const kIncludeFolder = INCLUDE_FOLDER;
const char* const kLibrary = PATH_flamewright;
const char* const kBurningMesh = PATH_02_burning_mesh;
const char* const kEditor = PATH_flamewright_editor;
const char* const kLosingLoader = PATH_losing_vulkan;

}  // namespace fw::test
