// The output page: writes everything a game loads and its set-up code, flipbooks, burn times,
// pictures. Jobs run in the background, one at a time, and can be cancelled. output/output.h does
// the work.
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <string>
#include <vector>

#include "app/app.h"
#include "link/scene_link.h"
#include "output/output.h"

namespace fwapp {

struct OutputPage {
    OutputPage() = default;
    ~OutputPage();
    OutputPage(const OutputPage&) = delete;
    OutputPage& operator=(const OutputPage&) = delete;

    struct Done {
        std::string error;  // empty: success
        std::vector<std::filesystem::path> files;
        std::string codes[2];  // preview of the scene's code in C and C++
    };
    struct Job {
        std::string name;  // "Game files"
        std::future<Done> work;
        double began = 0;  // s, App::now
        std::atomic<bool> stop{false};
        std::mutex mutex;
        std::string stage;  // guarded by mutex, as is share
        float share = 0;
    };

    std::filesystem::path folder;  // target folder; empty: beside the scene
    int language = 0;              // SnippetLanguage to show
    fwedit::FlipbookDef flipbook;
    fwedit::FilmstripDef strip;
    fwedit::TurntableDef turn;
    int flame = 0;  // index of the scene's flame for a flipbook
    fwlink::SceneSender link;
    bool linked = false;  // user setting, off by default
    uint32_t port = fwlink::kUsualPort;
    double calledAt = -1e9;   // s, App::now, last attempt to connect
    std::string linkProblem;  // reason for a missing link
    bool gameOpen = true, linkOpen = true, bookOpen = true, timesOpen = true, stripOpen = true,
         turnOpen = true;

    Job job;   // the running job
    Job look;  // the code preview
    std::string codes[2];
    uint64_t codeRevision = ~0ull;  // revision of the code preview
    std::string codeProblem;
    std::vector<std::filesystem::path> written;  // files of the last job
    std::string writtenName;

    [[nodiscard]] bool isWriting() const { return job.work.valid(); }
    [[nodiscard]] bool isLively() const { return isWriting() || look.work.valid(); }
};

void addOutputActions(App& app, std::vector<Action>& list);
// Collects finished background work. Call it every frame on every page.
void updateOutput(App& app);
// Pushes changes to the linked sample, or tries to connect. Returns true if the link's status
// changed. Never blocks; call it often.
bool updateLink(App& app);

}  // namespace fwapp
