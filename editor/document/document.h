// The open scene with its file, its layers' pictures and its history. Everything that changes it
// goes through run(), which keeps a step for undo.
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

struct Snapshot;  // a scene and its pictures as they were; what did not change is shared

struct Step {
    std::string name;  // "Move Corner torch"
    std::string line;  // the command that made it, as text
    std::shared_ptr<const Snapshot> after;
};

struct Document {
    Scene scene;
    PaintImages images;
    std::filesystem::path file;  // empty: never saved
    // Where relative paths begin while there is no file; empty: the current folder.
    std::filesystem::path folder;

    std::vector<Step> steps;  // steps[0] is the scene as opened, without a name
    size_t at = 0;            // of the step whose scene is shown
    size_t saved = 0;         // of the step that the file holds; ~0: of none
    uint64_t revision = 0;    // grows with each change of what is shown

    // Surfaces to paint on, by mesh; null: that mesh cannot be painted now. Set by whoever bakes.
    std::function<const PaintSurface*(const Scene&, ObjectId mesh)> surface;

    // Where nodes of the meshes' files stand; see scene.h. Set by whoever reads the files.
    NodePoseOf nodePose;

    // A drag under way, see beginDrag.
    bool dragging = false, dragChanged = false;
    std::string dragName, dragLine;
    // For nudges, see run.
    std::string nudgeKey;
    double nudgeTime = -1e9;
};

Document newDocument();
// Where the scene's relative paths begin now.
std::filesystem::path baseFolder(const Document& document);
[[nodiscard]] inline std::filesystem::path absoluteBase(const Document& document) {
    return std::filesystem::absolute(baseFolder(document));
}
[[nodiscard]] inline bool unsaved(const Document& document) {
    return document.at != document.saved;
}

// Does it, as one step. False: `message` says why and nothing changed. True: `message` says what
// was repaired, if anything. A command that changes nothing is no step. `added`: the new object.
bool run(Document& document, const Command& command, std::string& message,
         ObjectId* added = nullptr);
bool runLine(Document& document, std::string_view line, std::string& message,
             ObjectId* added = nullptr);
// As run; within 0.8 s (of `now`, s) of the last such change of the same field it is one step with
// it. For nudges and the wheel.
bool runNudge(Document& document, const Command& command, double now, std::string& message);

// From press to release all that is run is one step, named by the first; no change, no step.
void beginDrag(Document& document);
void endDrag(Document& document);
void cancelDrag(Document& document);  // Esc: puts back what was

[[nodiscard]] bool canUndo(const Document& document);
[[nodiscard]] bool canRedo(const Document& document);
bool undo(Document& document);
bool redo(Document& document);
void goTo(Document& document, size_t step);  // a click in the history

// For those who open and save: the scene as it is begins a new history; a change of every step.
void resetHistory(Document& document);
void changeEverywhere(Document& document, const std::function<void(Scene&)>& change);

// ---- files. `error` and `repairs` are whole sentences for people: file, field, value, limit.
std::string printScene(const Scene& scene);
// `name` is for messages. What can be mended is, and told; what cannot leaves `scene` untouched.
bool readScene(std::string_view text, const std::string& name, Scene& scene,
               std::vector<std::string>& repairs, std::string& error);
bool openDocument(const std::filesystem::path& file, Document& document,
                  std::vector<std::string>& repairs, std::string& error);
// Writes the pictures of the layers, then the scene; each whole or not at all.
bool saveDocument(Document& document, const std::filesystem::path& file, std::string& error);
// The same without making it the document's file: autosave, and a copy beside it. Pictures of the
// copy that was there before go.
bool saveCopy(const Document& document, const std::filesystem::path& file, std::string& error);
// Such a copy as unsaved work on `original` (empty: it had no file).
bool openCopy(const std::filesystem::path& copy, const std::filesystem::path& original,
              Document& document, std::vector<std::string>& repairs, std::string& error);

}  // namespace fwedit
