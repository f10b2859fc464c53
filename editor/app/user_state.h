// Settings that persist between runs: sizes, recent files, crash recovery. Stored in the user's
// state folder, never in a scene.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fwapp {

struct UserState {
    float left = 216, right = 296, timeline = 144;  // design pixels
    float interfaceSize = 1;                        // factor on the monitor's scale, [0.75, 2]
    std::vector<std::filesystem::path> recent;      // newest first, 8 at most
    std::filesystem::path lastFolder;
    std::map<std::string, std::string> keys;  // by command; only keys that differ from the defaults
};

// Abbreviates the home folder of a path with ~, and expands it.
std::string abbreviateHome(const std::filesystem::path& path);
std::filesystem::path expandHome(const std::string& text);

std::filesystem::path stateFolder();  // created if necessary; empty: not available
void loadUserState(UserState& state);
void saveUserState(const UserState& state);
void addRecent(UserState& state, const std::filesystem::path& file);

// Copies of unsaved work, one per running editor. A copy whose editor no longer runs can be
// recovered, and stays until the user recovers or discards it.
struct Recovery {
    std::filesystem::path file, original;  // the copy, and its original (empty: no file)
};
std::filesystem::path recoveryFile();  // of this process
void noteRecovery(const std::filesystem::path& original);
void dropRecovery();                    // of this process
bool findRecovery(Recovery& recovery);  // newest copy of an editor that no longer runs
void dropRecovery(const Recovery& recovery);

}  // namespace fwapp
