// report.html: the report of flamewright-check as one page without references to other files.
#pragma once
#include <nlohmann/json.hpp>

#include <string>

namespace fw::bundle {

// `report`: as in report.json. `pictures`: folder of the pictures "SCENE_small.png".
std::string htmlOf(const nlohmann::json& report, const std::string& pictures);

}  // namespace fw::bundle
