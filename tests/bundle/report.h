// report.html: the report of flamewright-check as one page without references to other files.
#pragma once
#include <nlohmann/json.hpp>

#include <string>

namespace fw::bundle {

// `report`: as in report.json. `folder`: that of the report, with its pictures and logs.
std::string htmlOf(const nlohmann::json& report, const std::string& folder);

}  // namespace fw::bundle
