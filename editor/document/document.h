// The open scene with its file, layer images and history. run() makes all changes and records a
// step for undo.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/command.h"
#include "document/scene.h"

namespace fwedit {

using PaintImages = std::map<ObjectId, PaintImage>;  // by layer

struct Snapshot;  // an earlier scene with its images; shares unchanged parts

struct Step {
    std::string name;  // for example "Move Corner torch"
    std::string line;  // the command as text
    std::shared_ptr<const Snapshot> after;
};

struct Document {
    Scene scene;
    PaintImages images;
    std::filesystem::path file;  // empty: never saved
    // Base of relative paths while there is no file; empty: the current folder.
    std::filesystem::path folder;

    std::vector<Step> steps;  // steps[0] is the opened scene, without a name
    size_t at = 0;            // index of the current step
    size_t saved = 0;         // index of the saved step; ~0: none
    uint64_t revision = 0;    // increases with every visible change

    // Surfaces to paint on, by mesh; null: the mesh cannot be painted. Set by the code that bakes.
    std::function<const PaintSurface*(const Scene&, ObjectId mesh)> surface;

    // Returns node poses within the meshes' files, see scene.h. Set by the code that reads the
    // files.
    NodePoseOf nodePose;

    // State of a drag, see beginDrag.
    bool dragging = false, dragChanged = false;
    std::string dragName, dragLine;
    // State of a nudge, see runNudge.
    std::string nudgeKey;
    double nudgeTime = -1e9;
};

Document newDocument();
// Returns the base of relative paths.
std::filesystem::path baseFolder(const Document& document);
[[nodiscard]] inline std::filesystem::path absoluteBase(const Document& document) {
    return std::filesystem::absolute(baseFolder(document));
}
[[nodiscard]] inline bool unsaved(const Document& document) {
    return document.at != document.saved;
}

// Applies a command as one step. On failure returns false with the reason in `message` and changes
// nothing. On success `message` lists repairs, if any. A command without effect adds no step.
// `added`: the new object.
bool run(Document& document, const Command& command, std::string& message,
         ObjectId* added = nullptr);
bool runLine(Document& document, std::string_view line, std::string& message,
             ObjectId* added = nullptr);
// As run, for nudges and the wheel. Merges with the previous nudge of the same field within 0.8 s.
// `now`: s.
bool runNudge(Document& document, const Command& command, double now, std::string& message);

// All commands between press and release form one step, named after the first. Without a change
// there is no step.
void beginDrag(Document& document);
void endDrag(Document& document);
void cancelDrag(Document& document);  // Esc: restores the previous state

[[nodiscard]] bool canUndo(const Document& document);
[[nodiscard]] bool canRedo(const Document& document);
bool undo(Document& document);
bool redo(Document& document);
void goTo(Document& document, size_t step);  // selects a step of the history

// For loading and saving: restarts the history with the current scene; changes every step.
void resetHistory(Document& document);
void changeEverywhere(Document& document, const std::function<void(Scene&)>& change);

// ---- files. `error` and `repairs` are sentences for users: file, field, value, limit.
std::string printScene(const Scene& scene);
// Parses a scene. `name`: for messages. Repairs and reports recoverable problems. Other problems
// leave `scene` unchanged.
bool readScene(std::string_view text, const std::string& name, Scene& scene,
               std::vector<std::string>& repairs, std::string& error);
bool openDocument(const std::filesystem::path& file, Document& document,
                  std::vector<std::string>& repairs, std::string& error);
// Writes the images of the layers, then the scene. Each file is replaced atomically.
bool saveDocument(Document& document, const std::filesystem::path& file, std::string& error);
// Saves a copy without changing the document's file, for autosave. Removes images of the previous
// copy.
bool saveCopy(const Document& document, const std::filesystem::path& file, std::string& error);
// Opens such a copy as unsaved work on `original` (empty: no file).
bool openCopy(const std::filesystem::path& copy, const std::filesystem::path& original,
              Document& document, std::vector<std::string>& repairs, std::string& error);

}  // namespace fwedit
