// The output page: what a scene is for. All that a game loads and the code that puts it together,
// flipbooks, burn times, pictures; written in the background, one at a time, and stopped by a
// click. What it does lies in output/output.h.
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
        std::string error;  // empty: it went well
        std::vector<std::filesystem::path> files;
        std::string codes[2];  // of a look at the scene's code, in C and C++
    };
    struct Job {
        std::string name;  // "Game files"
        std::future<Done> work;
        double began = 0;  // s, App::now
        std::atomic<bool> stop{false};
        std::mutex mutex;
        std::string stage;  // by mutex, as is share
        float share = 0;
    };

    std::filesystem::path folder;  // where it all goes; empty: beside the scene
    int language = 0;              // SnippetLanguage that is shown
    fwedit::FlipbookDef book;
    fwedit::FilmstripDef strip;
    fwedit::TurntableDef turn;
    int flame = 0;  // of the scene's, for a flipbook
    fwlink::SceneSender link;
    bool linked = false;  // wished; off until somebody switches it on
    uint32_t port = fwlink::kUsualPort;
    double calledAt = -1e9;   // s, App::now, when the sample was last sought
    std::string linkProblem;  // why there is none
    bool gameOpen = true, linkOpen = true, bookOpen = true, timesOpen = true, stripOpen = true,
         turnOpen = true;

    Job job;   // what is written
    Job look;  // the code, for the page
    std::string codes[2];
    uint64_t codeRevision = ~0ull;  // that it is of
    std::string codeProblem;
    std::vector<std::filesystem::path> written;  // by the last job
    std::string writtenName;

    [[nodiscard]] bool writes() const { return job.work.valid(); }
    [[nodiscard]] bool lively() const { return writes() || look.work.valid(); }
};

void addOutputActions(App& app, std::vector<Action>& list);
// Takes over what the background has finished; each frame, whatever the page.
void followOutput(App& app);
// Pushes what has changed to the sample that is linked, or seeks it. True: what is said of it has
// changed. Nothing waits; call it often.
bool followLink(App& app);

}  // namespace fwapp
