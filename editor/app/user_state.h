// What the editor remembers of its user between runs: sizes, recent files, what a crash left.
// Kept beside other programs' settings, never in a scene.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fwapp {

struct UserState {
    float left = 216, right = 296, timeline = 144;  // design pixels
    float interfaceSize = 1;                        // factor of the monitor's scale, [0.75, 2]
    std::vector<std::filesystem::path> recent;      // the newest first, 8 at most
    std::filesystem::path lastFolder;
    std::map<std::string, std::string> keys;  // by command, where they are not those by design
};

// A path as people write it, with ~ for their home, and back.
std::string homely(const std::filesystem::path& path);
std::filesystem::path fromHomely(const std::string& text);

std::filesystem::path stateFolder();  // created if need be; empty: there is none
void loadUserState(UserState& state);
void saveUserState(const UserState& state);
void addRecent(UserState& state, const std::filesystem::path& file);

// Copies of unsaved work, one of each editor that runs: another one's is found once that no longer
// lives, and stays until it is recovered or discarded.
struct Recovery {
    std::filesystem::path file, original;  // the copy, and what it is of (empty: it had no file)
};
std::filesystem::path recoveryFile();  // our own
void noteRecovery(const std::filesystem::path& original);
void dropRecovery();                    // our own
bool findRecovery(Recovery& recovery);  // the newest that a dead editor left
void dropRecovery(const Recovery& recovery);

}  // namespace fwapp
