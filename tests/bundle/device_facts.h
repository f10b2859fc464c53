// Facts about the machine and its Vulkan devices, for flamewright-check. Opens the loader by
// name, so that a machine without one still gets a report.
#pragma once
#include <nlohmann/json.hpp>

#include <string>

namespace fw::bundle {

// Processor, memory, system, C library.
nlohmann::json machineFacts();

// {"loader", "problem", "devices": [...]}; the first device is the one that the library, the tests
// and the bench use. "problem" is there if there is no device, and says why.
nlohmann::json deviceFacts();

// Whether the loader finds the validation layer.
bool hasValidationLayer();

}  // namespace fw::bundle
