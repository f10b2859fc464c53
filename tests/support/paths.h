// Absolute paths of this build; "" for what it lacks.
#pragma once

namespace fw::test {

extern const char* const kTestFolder;     // tests/ of the sources
extern const char* const kIncludeFolder;  // with flamewright/flamewright.h
extern const char* const kLibrary;        // libflamewright.so
extern const char* const kBurningMesh;    // the sample 02_burning_mesh
extern const char* const kEditor;         // flamewright-editor
extern const char* const kLosingLoader;   // losing_vulkan.cpp, as libvulkan.so.1

}  // namespace fw::test
