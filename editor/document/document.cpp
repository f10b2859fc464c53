// See document.h.
#include "document/document.h"

#include <algorithm>
#include <tuple>

#include "document/apply.h"
#include "document/text.h"

namespace fwedit {

// A scene in parts that steps share. A step costs its changes, plus a pointer per object of the
// changed lists.
template <typename T>
using SharedList = std::shared_ptr<const std::vector<std::shared_ptr<const T>>>;

struct Snapshot {
    Settings settings;
    ObjectId nextId = 1;
    std::tuple<SharedList<Mesh>, SharedList<HeatSource>, SharedList<Flame>, SharedList<Emitter>,
               SharedList<Wind>, SharedList<Collider>, SharedList<PaintLayer>, SharedList<Event>>
        lists;
    PaintImages images;
};

namespace {

constexpr double kNudgeSeconds = 0.8;

template <typename T>
SharedList<T> share(const std::vector<T>& list, const SharedList<T>& before) {
    auto made = std::make_shared<std::vector<std::shared_ptr<const T>>>();
    made->reserve(list.size());
    bool same = before && before->size() == list.size();
    for (size_t i = 0; i < list.size(); ++i) {
        std::shared_ptr<const T> kept;
        // Most objects keep their index; search a moved one nearby.
        if (before)
            for (const size_t at : {i, i + 1, i - 1})
                if (!kept && at < before->size() && *(*before)[at] == list[i]) kept = (*before)[at];
        same = same && kept == (*before)[i];
        made->push_back(kept ? kept : std::make_shared<const T>(list[i]));
    }
    return same ? before : SharedList<T>(std::move(made));
}

std::shared_ptr<const Snapshot> takeSnapshot(const Scene& scene, const PaintImages& images,
                                             const Snapshot* before) {
    auto made = std::make_shared<Snapshot>();
    made->settings = scene.settings;
    made->nextId = scene.nextId;
    made->images = images;
    forEachList(scene, [&](Kind, const auto& list) {
        using T = typename std::remove_cvref_t<decltype(list)>::value_type;
        auto& into = std::get<SharedList<T>>(made->lists);
        into = share<T>(list, before ? std::get<SharedList<T>>(before->lists) : nullptr);
    });
    return made;
}

template <typename T>
bool sameList(const SharedList<T>& a, const SharedList<T>& b) {
    if (a == b) return true;
    return std::equal(a->begin(), a->end(), b->begin(), b->end(),
                      [](const auto& x, const auto& y) { return x == y || *x == *y; });
}

bool sameSnapshot(const Snapshot& a, const Snapshot& b) {
    const bool same = std::apply(
        [&](const auto&... list) {
            return (sameList(list, std::get<std::remove_cvref_t<decltype(list)>>(b.lists)) && ...);
        },
        a.lists);
    return same && a.settings == b.settings && a.nextId == b.nextId && a.images == b.images;
}

void restore(const Snapshot& snapshot, Document& document) {
    document.scene.settings = snapshot.settings;
    document.scene.nextId = snapshot.nextId;
    document.images = snapshot.images;
    forEachList(document.scene, [&](Kind, auto& list) {
        using T = typename std::remove_cvref_t<decltype(list)>::value_type;
        list.clear();
        for (const auto& object : *std::get<SharedList<T>>(snapshot.lists)) list.push_back(*object);
    });
    ++document.revision;
}

bool commit(Document& document, const std::string& name, const std::string& line) {
    const Snapshot& before = *document.steps[document.at].after;
    auto after = takeSnapshot(document.scene, document.images, &before);
    if (sameSnapshot(before, *after)) return false;
    document.steps.resize(document.at + 1);
    if (document.saved > document.at) document.saved = ~size_t{0};
    document.steps.push_back({name, line, std::move(after)});
    document.at = document.steps.size() - 1;
    return true;
}

std::string nudgeKeyOf(const Command& command) {
    std::string key =
        std::to_string(uint32_t(command.verb)) + ":" + std::to_string(uint32_t(command.kind));
    for (const ObjectId id : command.targets) key += join("#", std::to_string(id));
    for (const Assignment& made : command.fields) key += join(":", made.field);
    return key;
}

}  // namespace

Document newDocument() {
    Document document;
    document.steps.push_back({"", "", takeSnapshot(document.scene, document.images, nullptr)});
    return document;
}

void resetHistory(Document& document) {
    document.steps.clear();
    document.steps.push_back({"", "", takeSnapshot(document.scene, document.images, nullptr)});
    document.at = document.saved = 0;
    document.dragging = false;
    ++document.revision;
}

void changeEverywhere(Document& document, const std::function<void(Scene&)>& change) {
    const size_t at = document.at;
    const Snapshot* before = nullptr;
    for (Step& step : document.steps) {
        restore(*step.after, document);
        change(document.scene);
        step.after = takeSnapshot(document.scene, document.images, before);
        before = step.after.get();
    }
    restore(*document.steps[at].after, document);
}

bool run(Document& document, const Command& command, std::string& message, ObjectId* added) {
    Scene scene = document.scene;
    PaintImages images = document.images;
    ObjectId fresh = 0;
    if (!applyCommand(document, command, scene, images, message, fresh)) return false;
    const std::string name = undoName(document.scene, command);
    const std::string line = printCommand(document.scene, command);
    document.scene = std::move(scene);
    document.images = std::move(images);
    if (added) *added = fresh;
    ++document.revision;
    document.nudgeKey.clear();
    // Camera changes add no step, so undo does not move the view.
    if (command.verb == Verb::Set && command.kind == Kind::Camera) return true;
    if (document.dragging) {
        if (document.dragName.empty()) document.dragName = name;
        document.dragLine = line;
        document.dragChanged = true;
        return true;
    }
    commit(document, name, line);
    return true;
}

bool runLine(Document& document, std::string_view line, std::string& message, ObjectId* added) {
    Command command;
    if (!parseCommand(document.scene, line, command, message)) return false;
    return run(document, command, message, added);
}

bool runNudge(Document& document, const Command& command, double now, std::string& message) {
    const std::string key = nudgeKeyOf(command);
    const bool merges = !document.dragging && document.at > 0 && key == document.nudgeKey &&
                        now - document.nudgeTime < kNudgeSeconds &&
                        document.at + 1 == document.steps.size();
    const size_t before = document.at;
    if (!run(document, command, message)) return false;
    if (merges && document.at == before + 1) {
        // The new step replaces the previous one.
        document.steps.erase(document.steps.begin() + static_cast<std::ptrdiff_t>(before));
        document.at = before;
        if (document.saved != ~size_t{0} && document.saved >= before) document.saved = ~size_t{0};
        if (sameSnapshot(*document.steps[before - 1].after, *document.steps[before].after)) {
            document.steps.pop_back();
            document.at = before - 1;
        }
    }
    document.nudgeKey = key;
    document.nudgeTime = now;
    return true;
}

void beginDrag(Document& document) {
    if (document.dragging) endDrag(document);
    document.dragging = true;
    document.dragChanged = false;
    document.dragName.clear();
    document.dragLine.clear();
    document.nudgeKey.clear();
}

void endDrag(Document& document) {
    if (!document.dragging) return;
    document.dragging = false;
    if (document.dragChanged) commit(document, document.dragName, document.dragLine);
}

void cancelDrag(Document& document) {
    if (!document.dragging) return;
    document.dragging = false;
    if (document.dragChanged) restore(*document.steps[document.at].after, document);
}

bool canUndo(const Document& document) { return document.at > 0; }
bool canRedo(const Document& document) { return document.at + 1 < document.steps.size(); }

void goTo(Document& document, size_t step) {
    endDrag(document);
    document.at = std::min(step, document.steps.size() - 1);
    document.nudgeKey.clear();
    restore(*document.steps[document.at].after, document);
}

bool undo(Document& document) {
    endDrag(document);
    if (!canUndo(document)) return false;
    goTo(document, document.at - 1);
    return true;
}

bool redo(Document& document) {
    endDrag(document);
    if (!canRedo(document)) return false;
    goTo(document, document.at + 1);
    return true;
}

}  // namespace fwedit
