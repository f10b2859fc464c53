// See user_state.h.
#include "app/user_state.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace fwapp {
namespace {

namespace fs = std::filesystem;
constexpr size_t kMostRecent = 8;

// Replaces the file atomically.
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

std::string abbreviateHome(const fs::path& path) {
    const std::string text = path.string();
    const char* given = std::getenv("HOME");
    const std::string home = given ? given : "";
    if (home.empty() || !text.starts_with(home + "/")) return text;
    return std::string("~").append(text, home.size());
}

fs::path expandHome(const std::string& text) {
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
        if (const size_t tab = value.find('\t'); key == "keys" && tab != std::string::npos)
            state.keys[value.substr(0, tab)] = value.substr(tab + 1);
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
    for (const auto& [command, keys] : state.keys)
        text << "keys " << command << '\t' << keys << "\n";
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

namespace {

constexpr const char* kRecovery = "recovery-";

fs::path ofFile(const fs::path& copy) { return fs::path(copy).replace_extension(".of"); }

// Deletes a copy with its paint images.
void dropCopy(const fs::path& copy) {
    const std::string pictures = copy.stem().string() + ".paint_";
    std::error_code ignored;
    fs::remove(copy, ignored);
    fs::remove(ofFile(copy), ignored);
    std::vector<fs::path> gone;
    for (const auto& entry : fs::directory_iterator(copy.parent_path(), ignored))
        if (entry.path().filename().string().starts_with(pictures)) gone.push_back(entry.path());
    for (const fs::path& picture : gone) fs::remove(picture, ignored);
}

// Returns the id of the process that wrote it; 0: not such a file.
pid_t writerOf(const fs::path& copy) {
    const std::string stem = copy.stem().string();
    if (copy.extension() != ".fwscene" || !stem.starts_with(kRecovery)) return 0;
    return pid_t(std::strtol(stem.c_str() + std::strlen(kRecovery), nullptr, 10));
}

}  // namespace

fs::path recoveryFile() {
    return stateFolder() / (kRecovery + std::to_string(::getpid()) + ".fwscene");
}

void noteRecovery(const fs::path& original) {
    const std::string path = original.empty() ? "" : fs::absolute(original).string();
    writeText(ofFile(recoveryFile()), path + "\n");
}

void dropRecovery() { dropCopy(recoveryFile()); }

bool findRecovery(Recovery& recovery) {
    recovery = {};
    fs::file_time_type newest{};
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(stateFolder(), ignored)) {
        const pid_t writer = writerOf(entry.path());
        if (writer <= 0 || writer == ::getpid()) continue;
        if (::kill(writer, 0) == 0 || errno != ESRCH) continue;
        const auto written = fs::last_write_time(entry.path(), ignored);
        if (!recovery.file.empty() && written <= newest) continue;
        newest = written;
        recovery.file = entry.path();
    }
    if (recovery.file.empty()) return false;
    std::ifstream in(ofFile(recovery.file));
    std::string line;
    std::getline(in, line);
    recovery.original = line;
    return true;
}

void dropRecovery(const Recovery& recovery) { dropCopy(recovery.file); }

}  // namespace fwapp
