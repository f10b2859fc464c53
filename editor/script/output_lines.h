// Script lines that write what a scene is for: see script.h.
#pragma once

#include <string>
#include <vector>

#include "output/output.h"
#include "script/script.h"

namespace fwedit {

// The scene of a host, to be written. It points into the host.
OutputInput outputOf(ScriptHost& host);

// False in `known`: the first word is none of these.
bool runOutputLine(ScriptHost& host, const std::vector<std::string>& words, bool& known,
                   std::string& error);

}  // namespace fwedit
