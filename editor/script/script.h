// Scripts that drive the editor without a window: each command of the document (document/command.h)
// and what an artist does besides.
//   new                           open "yard.fwscene"            save ["yard.fwscene"]
//   undo [3]    redo [3]          drag begin|end|cancel          play 12.5
//   shot "yard.png" [640x360]     frame                          report
//   shot "crate.png" 640x360 neutral [30 14]  as it is: in even light before grey, yaw and pitch
//   why "Crate" 0 0.4 0.2         burn                           (the whole burn, for lit and why)
//   expect count source 2         expect "Torch" output 18       expect unsaved yes
//   expect step "Move Torch"      expect same "yard.fwscene"     expect lit "Crate" above 0.2
//   expect alike "a.png" "b.png" 0.02     pictures, in the mean of their values
//   expect halves "a.png" above 0.02      the left one against the right one
//   refuse set "Torch" shape round        a command that must not be possible
//   hash                          of the ignition map of each mesh at the playhead, and its tick
//   link 47380                    pushes the scene, and from here on each change, to the sample
//   that link wait                     listens there; waits until the sample shows it link off
// And what the scene is for (output/output.h):
//   cook "game"                   all that a game loads, into a folder
//   snippet "game/yard.c"         code that puts it together; .cpp: in C++
//   filmstrip "strip.png" 8 320x180 4     pictures over the timeline, in columns
//   turntable "turn" 24 640x360   pictures around it, at the playhead
//   flipbook "fire.fwbook" "Campfire" 32 64   a flame as frames of so many texels
//   bake "burn"                   when each spot of each mesh catches, as EXR
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "document/burn.h"
#include "document/document.h"
#include "document/inspect.h"
#include "link/scene_link.h"

namespace fwedit {

struct ScriptHost {
    explicit ScriptHost(std::filesystem::path begin);
    ~ScriptHost();
    ScriptHost(const ScriptHost&) = delete;
    ScriptHost& operator=(const ScriptHost&) = delete;

    std::filesystem::path folder;  // where the script's paths begin
    Document document;
    Assets assets;
    std::unique_ptr<Burn> burn;  // of the scene at revision burnRevision
    uint64_t burnRevision = 0;
    double playhead = 0;  // s
    BurnRecord record;
    uint64_t recordRevision = ~uint64_t{0};
    fwlink::SceneSender link;
    std::function<void(const std::string&)> say;              // a line for whoever watches
    std::function<bool(const std::string&, float)> progress;  // of what is written; false stops

    // Made when first needed. Null: `error`.
    FwContext* device(std::string& error);  // our own, for pictures
    FwContext* cpu(std::string& error);     // for bakes and questions

 private:
    FwContext* device_ = nullptr;
    FwContext* cpu_ = nullptr;
};

// One line; empty ones and comments are fine. False: `error` says why.
bool runScriptLine(ScriptHost& host, const std::string& line, std::string& error);
// Stops at the first line that does not work; `error` then begins with "file:line: ".
bool runScript(ScriptHost& host, const std::filesystem::path& file, std::string& error);

// "640x360". False: `error` says what it takes.
bool parseSize(const std::string& word, uint32_t& width, uint32_t& height, std::string& error);
// Creates or renews host.burn and runs it to the playhead.
bool burnToPlayhead(ScriptHost& host, FwContext* context, std::string& error);
bool writeShot(ScriptHost& host, const std::filesystem::path& file, uint32_t width, uint32_t height,
               std::string& error);
// Puts the camera so that all meshes show.
bool frameScene(ScriptHost& host, std::string& error);

// The command line: --script FILE [--headless] [--cache FOLDER] [--help]. Exit code.
int scriptMain(int count, char** words);

}  // namespace fwedit
