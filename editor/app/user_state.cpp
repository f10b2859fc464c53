// See user_state.h.
#include "app/user_state.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace fwapp {
namespace {

namespace fs = std::filesystem;
constexpr size_t kMostRecent = 8;

// Whole or not at all.
void writeText(const fs::path& file, const std::string& text) {
    const fs::path fresh = file.string() + ".new";
    {
        std::ofstream out(fresh);
        out << text;
        if (!out.good()) return;
    }
    std::error_code ignored;
    fs::rename(fresh, file, ignored);
}

}  // namespace

std::string homely(const fs::path& path) {
    const std::string text = path.string();
    const char* given = std::getenv("HOME");
    const std::string home = given ? given : "";
    if (home.empty() || !text.starts_with(home + "/")) return text;
    return std::string("~").append(text, home.size());
}

fs::path fromHomely(const std::string& text) {
    const char* home = std::getenv("HOME");
    return home && text.starts_with("~/") ? fs::path(home) / text.substr(2) : fs::path(text);
}

fs::path stateFolder() {
    fs::path folder;
    if (const char* given = std::getenv("XDG_STATE_HOME"); given && *given) {
        folder = fs::path(given) / "flamewright";
    } else if (const char* home = std::getenv("HOME"); home && *home) {
        folder = fs::path(home) / ".local/state/flamewright";
    }
    if (folder.empty()) return {};
    std::error_code failed;
    fs::create_directories(folder, failed);
    return failed ? fs::path() : folder;
}

void loadUserState(UserState& state) {
    std::ifstream in(stateFolder() / "editor");
    std::string line;
    while (std::getline(in, line)) {
        const size_t space = line.find(' ');
        if (space == std::string::npos) continue;
        const std::string key = line.substr(0, space), value = line.substr(space + 1);
        auto number = [&](float low, float high) {
            return std::clamp(std::strtof(value.c_str(), nullptr), low, high);
        };
        if (key == "left") state.left = number(160, 420);
        if (key == "right") state.right = number(264, 460);
        if (key == "timeline") state.timeline = number(92, 340);
        if (key == "interface") state.interfaceSize = number(0.75f, 2);
        if (key == "folder") state.lastFolder = value;
        if (key == "recent" && state.recent.size() < kMostRecent) state.recent.emplace_back(value);
    }
}

void saveUserState(const UserState& state) {
    const fs::path folder = stateFolder();
    if (folder.empty()) return;
    std::ostringstream text;
    text << "left " << state.left << "\nright " << state.right << "\ntimeline " << state.timeline
         << "\ninterface " << state.interfaceSize << "\nfolder " << state.lastFolder.string()
         << "\n";
    for (const fs::path& file : state.recent) text << "recent " << file.string() << "\n";
    writeText(folder / "editor", text.str());
}

void addRecent(UserState& state, const fs::path& file) {
    const fs::path whole = fs::absolute(file).lexically_normal();
    std::erase(state.recent, whole);
    state.recent.insert(state.recent.begin(), whole);
    if (state.recent.size() > kMostRecent) state.recent.resize(kMostRecent);
    saveUserState(state);
}

fs::path recoveryFile() { return stateFolder() / "recovery.fwscene"; }

bool findRecovery(fs::path& original) {
    if (!fs::exists(recoveryFile())) return false;
    std::ifstream in(stateFolder() / "recovery.of");
    std::string line;
    std::getline(in, line);
    original = line;
    return true;
}

void noteRecovery(const fs::path& original) {
    writeText(stateFolder() / "recovery.of", original.string() + "\n");
}

void dropRecovery() {
    std::error_code ignored;
    fs::remove(recoveryFile(), ignored);
    fs::remove(stateFolder() / "recovery.of", ignored);
}

}  // namespace fwapp
