// Scripts that drive the editor without a window: all commands of the document
// (document/command.h), and these:
//   new                           open "yard.fwscene"            save ["yard.fwscene"]
//   undo [3]    redo [3]          drag begin|end|cancel          play 12.5
//   shot "yard.png" [640x360]     frame                          report
//   shot "crate.png" 640x360 neutral [30 14]  unburnt in even light, yaw and pitch in degrees
//   why "Crate" 0 0.4 0.2         burn                           (whole burn, for lit and why)
//   expect count source 2         expect "Torch" output 18       expect unsaved yes
//   expect step "Move Torch"      expect same "yard.fwscene"     expect lit "Crate" above 0.2
//   expect alike "a.png" "b.png" 0.02     mean difference of two images
//   expect halves "a.png" above 0.02      mean difference of the left and the right half
//   refuse set "Torch" shape round        expects the command to fail
//   hash                          ignition map hash and tick of each mesh at the playhead
//   link 47380                    connects to a sample and pushes the scene and all changes
//   link wait                     waits until the sample shows the current scene
//   link off                      disconnects
// Export commands (output/output.h):
//   cook "game"                   writes all files that a game loads into a folder
//   snippet "game/yard.c"         writes the set-up code; .cpp: in C++
//   filmstrip "strip.png" 8 320x180 4     pictures over the timeline, number of columns
//   turntable "turn" 24 640x360   pictures around the scene at the playhead
//   flipbook "fire.fwbook" "Campfire" 32 64   a flame, number of frames, texels per side
//   bake "burn"                   ignition times of each mesh, as EXR
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

    std::filesystem::path folder;  // base of the script's paths
    Document document;
    Assets assets;
    std::unique_ptr<Burn> burn;  // scene at revision burnRevision
    uint64_t burnRevision = 0;
    double playhead = 0;  // s
    BurnRecord record;
    uint64_t recordRevision = ~uint64_t{0};
    fwlink::SceneSender link;
    std::function<void(const std::string&)> say;              // receives messages
    std::function<bool(const std::string&, float)> progress;  // export progress; false cancels

    // Created on first use. Returns null with `error` on failure.
    FwContext* device(std::string& error);  // own device, for pictures
    FwContext* cpu(std::string& error);     // for bakes and queries

 private:
    FwContext* device_ = nullptr;
    FwContext* cpu_ = nullptr;
};

// Runs one line; empty lines and comments are valid. On failure returns false with `error`.
bool runScriptLine(ScriptHost& host, const std::string& line, std::string& error);
// Stops at the first failing line; `error` then starts with "file:line: ".
bool runScript(ScriptHost& host, const std::filesystem::path& file, std::string& error);

// Parses "640x360". On failure returns false with the expected form in `error`.
bool parseSize(const std::string& word, uint32_t& width, uint32_t& height, std::string& error);
// Creates or updates host.burn and runs it to the playhead.
bool burnToPlayhead(ScriptHost& host, FwContext* context, std::string& error);
bool writeShot(ScriptHost& host, const std::filesystem::path& file, uint32_t width, uint32_t height,
               std::string& error);
// Moves the camera so that all meshes are visible.
bool frameScene(ScriptHost& host, std::string& error);

// The command line: --script FILE [--headless] [--cache FOLDER] [--help]. Returns the exit code.
int scriptMain(int count, char** words);

}  // namespace fwedit
