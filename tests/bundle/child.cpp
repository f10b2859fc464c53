#include "bundle/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace fw::bundle {

Child::Child(const std::vector<std::string>& words, const std::string& log,
             const Environment& environment, const std::string& folder) {
    // All that allocates comes before the fork: other threads may hold the allocator's lock.
    std::map<std::string, std::string> variables;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry;
        const size_t at = text.find('=');
        if (at != std::string::npos) variables[text.substr(0, at)] = text.substr(at + 1);
    }
    for (const auto& [name, value] : environment) variables[name] = value;
    std::vector<std::string> entries;
    for (const auto& [name, value] : variables) entries.push_back(name + "=" + value);
    std::vector<char*> arguments, environmentWords;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    for (const std::string& entry : entries)
        environmentWords.push_back(const_cast<char*>(entry.c_str()));
    arguments.push_back(nullptr);
    environmentWords.push_back(nullptr);
    const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);
    pid_ = output < 0 || input < 0 ? -1 : fork();
    const int error = errno;
    if (pid_ == 0) {
        setpgid(0, 0);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        dup2(input, 0);
        dup2(output, 1);
        dup2(output, 2);
        if (chdir(folder.c_str()) == 0)
            execve(arguments[0], arguments.data(), environmentWords.data());
        _exit(127);
    }
    if (output >= 0) close(output);
    if (input >= 0) close(input);
    if (pid_ < 0) throw std::runtime_error(words[0] + " cannot start: " + std::strerror(error));
    setpgid(pid_, pid_);
    running_ = true;
}

bool Child::ended() {
    if (!running_) return true;
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
    running_ = false;
    if (stopped_)
        fault_ = "stopped";
    else if (WIFSIGNALED(status))
        fault_ =
            "signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
    else if (WEXITSTATUS(status) != 0)
        fault_ = "status " + std::to_string(WEXITSTATUS(status));
    return true;
}

bool Child::waitFor(double seconds) {
    const Clock::time_point start = Clock::now();
    while (!ended()) {
        if (secondsSince(start) >= seconds) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
}

void Child::stop() {
    if (ended()) return;
    stopped_ = true;
    fault_ = "stopped";
    kill(-pid_, SIGKILL);
    (void)waitFor(5);
    running_ = false;
}

std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string lastLines(const std::string& text, size_t count) {
    const size_t end = text.find_last_not_of('\n') + 1;  // 0: nothing but line ends
    size_t from = end;
    while (from > 0 && (text[from - 1] != '\n' || --count > 0)) --from;
    return text.substr(from, end - from);
}

}  // namespace fw::bundle
