// Script commands that export a scene; see script.h.
#pragma once

#include <string>
#include <vector>

#include "output/output.h"
#include "script/script.h"

namespace fwedit {

// Returns the host's scene for export. It points into the host.
OutputInput outputOf(ScriptHost& host);

// `known` false: the first word is no export command.
bool runOutputLine(ScriptHost& host, const std::vector<std::string>& words, bool& known,
                   std::string& error);

}  // namespace fwedit
