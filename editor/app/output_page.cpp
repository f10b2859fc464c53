#include "app/output_page.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "shell/icons.h"
#include "tools/whole_file.h"

namespace fwapp {

using namespace fwui;
namespace fs = std::filesystem;

namespace {

using Work = std::function<bool(const fwedit::OutputInput&, const fwedit::OutputProgress&,
                                OutputPage::Done&)>;

fs::path folderOf(const App& app) {
    if (!app.output->folder.empty()) return app.output->folder;
    return fs::absolute(fwedit::baseFolder(app.document)).lexically_normal() /
           (app.document.file.empty() ? "game" : app.document.file.stem().string() + "_game");
}

// Runs the work in the background on a copy of the scene.
void startJob(App& app, OutputPage::Job& job, const char* name, Work work) {
    if (job.work.valid()) return;
    job.name = name;
    job.began = app.now;
    job.stop = false;
    job.stage.clear();
    job.share = 0;
    job.work = std::async(
        std::launch::async,
        [&job, work = std::move(work), scene = app.document.scene, images = app.document.images,
         folder = fwedit::baseFolder(app.document), stem = app.document.file.stem().string(),
         cache = app.live.cache()] {
            fwedit::Assets assets;
            assets.cache = cache;
            const auto progress = [&job](const std::string& stage, float share) {
                const std::lock_guard lock(job.mutex);
                job.stage = stage;
                job.share = share;
                return !job.stop;
            };
            OutputPage::Done done;
            if (!work({scene, images, folder, stem, assets}, progress, done) && done.error.empty())
                done.error = fwedit::kStopped;
            return done;
        });
}

// Runs `use` with a separate context, because the page uses its own device.
bool withContext(uint32_t backend, std::string& error, const std::function<bool(FwContext*)>& use) {
    FwContextDef def = fwDefaultContextDef();
    def.backend = backend;
    FwErrorInfo info{};
    FwContext* context = nullptr;
    if (fwCreateContext(&def, &context, &info) < 0) {
        error = info.message;
        return false;
    }
    const bool good = use(context);
    fwDestroyContext(context);
    return good;
}

void writeGame(App& app) {
    startJob(
        app, app.output->job, "Game files",
        [out = folderOf(app)](const auto& input, const auto& progress, OutputPage::Done& done) {
            fwedit::OutputPlan plan;
            return withContext(FW_BACKEND_CPU, done.error, [&](FwContext* cpu) {
                if (!fwedit::planOutput(input, plan, done.error) ||
                    !fwedit::cookScene(input, plan, cpu, out, progress, done.files, done.error))
                    return false;
                for (const auto language :
                     {fwedit::SnippetLanguage::C, fwedit::SnippetLanguage::Cpp}) {
                    const bool c = language == fwedit::SnippetLanguage::C;
                    const fs::path file = out / (plan.identifier + (c ? ".c" : ".cpp"));
                    const std::string code = fwedit::snippetOf(plan, language);
                    done.error =
                        fwtools::replaceFile(file.string(), std::as_bytes(std::span(code)));
                    if (!done.error.empty()) return false;
                    done.files.push_back(file);
                }
                return true;
            });
        });
}

const fwedit::Flame* chosenFlame(const App& app) {
    const auto& flames = app.document.scene.flames;
    if (flames.empty()) return nullptr;
    return &flames[size_t(std::clamp(app.output->flame, 0, int(flames.size()) - 1))];
}

void writeFlipbook(App& app) {
    const fwedit::Flame* flame = chosenFlame(app);
    if (!flame) return;
    const fs::path file = folderOf(app) / (flame->name + ".fwbook");
    startJob(app, app.output->job, "Flipbook",
             [file, id = flame->id, def = app.output->flipbook](
                 const auto& input, const auto& progress, OutputPage::Done& done) {
                 done.files = {file};
                 return fwedit::writeFlipbook(input, id, def, file, progress, done.error);
             });
}

void writeTimes(App& app) {
    startJob(
        app, app.output->job, "Burn times",
        [out = folderOf(app)](const auto& input, const auto& progress, OutputPage::Done& done) {
            return withContext(FW_BACKEND_CPU, done.error, [&](FwContext* cpu) {
                return fwedit::writeArrivals(input, cpu, out, progress, done.files, done.error);
            });
        });
}

void writeStrip(App& app) {
    const fs::path file = folderOf(app) / "filmstrip.png";
    startJob(app, app.output->job, "Filmstrip",
             [file, def = app.output->strip](const auto& input, const auto& progress,
                                             OutputPage::Done& done) {
                 done.files = {file};
                 return withContext(FW_BACKEND_VULKAN, done.error, [&](FwContext* device) {
                     return fwedit::writeFilmstrip(input, device, def, file, progress, done.error);
                 });
             });
}

void writeTurn(App& app) {
    fwedit::TurntableDef def = app.output->turn;
    def.time = app.live.time();
    startJob(app, app.output->job, "Turntable",
             [out = folderOf(app) / "turntable", def](const auto& input, const auto& progress,
                                                      OutputPage::Done& done) {
                 return withContext(FW_BACKEND_VULKAN, done.error, [&](FwContext* device) {
                     return fwedit::writeTurntable(input, device, def, out, progress, done.files,
                                                   done.error);
                 });
             });
}

void copyCode(App& app) {
    const std::string& code = app.output->codes[app.output->language];
    if (code.empty()) return;
    ImGui::SetClipboardText(code.c_str());
    setStatus(app, app.output->language == 0 ? "Copied the code in C" : "Copied the code in C++");
}

bool isFinished(const OutputPage::Job& job) {
    return job.work.valid() &&
           job.work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void stop(OutputPage::Job& job) { job.stop = true; }

std::string linkWords(const App& app) {
    const OutputPage& page = *app.output;
    if (!page.linked) return "Off. Nothing leaves the editor.";
    if (!page.link.connected()) return "No sample listens on that port. Retrying every second.";
    if (!page.link.shown(app.document)) return "Sending the change";
    if (!page.link.answer().empty()) return page.link.answer();
    return "The sample shows the current scene.";
}

}  // namespace

OutputPage::~OutputPage() {
    for (Job* one : {&job, &look}) {
        stop(*one);
        if (one->work.valid()) one->work.wait();
    }
}

void updateOutput(App& app) {
    OutputPage& page = *app.output;
    if (isFinished(page.job)) {
        OutputPage::Done done = page.job.work.get();
        if (done.error == fwedit::kStopped) {
            setStatus(app, "Stopped writing: " + page.job.name);
        } else if (!done.error.empty()) {
            toast(app, Toast::Kind::kError, page.job.name + ": nothing was written", done.error);
        } else {
            page.written = std::move(done.files);
            page.writtenName = page.job.name;
            setStatus(app, "Wrote " + std::to_string(page.written.size()) +
                               (page.written.size() == 1 ? " file" : " files"));
        }
    }
    if (isFinished(page.look)) {
        OutputPage::Done done = page.look.work.get();
        page.codeProblem = done.error;
        std::move(std::begin(done.codes), std::end(done.codes), std::begin(page.codes));
    }
    if (app.page != Page::kOutput || page.look.work.valid() ||
        page.codeRevision == app.document.revision)
        return;
    page.codeRevision = app.document.revision;
    startJob(app, page.look, "Code", [](const auto& input, const auto&, OutputPage::Done& done) {
        fwedit::OutputPlan plan;
        if (!fwedit::planOutput(input, plan, done.error)) return false;
        done.codes[0] = fwedit::snippetOf(plan, fwedit::SnippetLanguage::C);
        done.codes[1] = fwedit::snippetOf(plan, fwedit::SnippetLanguage::Cpp);
        return true;
    });
}

bool updateLink(App& app) {
    constexpr double kCallAgain = 1;  // s
    OutputPage& page = *app.output;
    const std::string before = linkWords(app);
    if (!page.linked) {
        page.link.disconnect();
    } else if (app.page != Page::kWelcome) {
        if (!page.link.connected() && app.now - page.calledAt > kCallAgain) {
            page.calledAt = app.now;
            page.link.connect(uint16_t(page.port), page.linkProblem);
        }
        page.link.follow(app.document);
    }
    return linkWords(app) != before;
}

void addOutputActions(App& app, std::vector<Action>& list) {
    App* at = &app;
    const int page = int(Page::kOutput);
    const auto idle = [at] { return !at->output->isWriting(); };
    list.insert(
        list.end(),
        {{"Write game files", "Export", "Ctrl+E", icons::exportTo, [at] { writeGame(*at); }, idle,
          page},
         {"Write flipbook", "Export", "", icons::film, [at] { writeFlipbook(*at); },
          [at, idle] { return idle() && !at->document.scene.flames.empty(); }, page},
         {"Write burn times", "Export", "", icons::timer, [at] { writeTimes(*at); },
          [at, idle] { return idle() && !at->document.scene.meshes.empty(); }, page},
         {"Write filmstrip", "Export", "", icons::film, [at] { writeStrip(*at); }, idle, page},
         {"Write turntable", "Export", "", icons::rotate, [at] { writeTurn(*at); }, idle, page},
         {"Copy the code",
          "Export",
          "Ctrl+Shift+C",
          icons::copy,
          [at] { copyCode(*at); },
          {},
          page},
         {"Link to a sample",
          "Export",
          "Ctrl+L",
          icons::link,
          [at] {
              at->output->linked = !at->output->linked;
              at->output->calledAt = -1e9;
              setStatus(*at, at->output->linked ? "Changes go to the sample" : "The link is off");
          },
          {},
          -3},
         {"Stop writing", "Export", "", icons::close, [at] { stop(at->output->job); },
          [at] { return at->output->isWriting(); }, page}});
}

namespace {

// A full-width button; dim while another job runs.
void showAction(App& app, Rows& rows, const char* name, bool primary) {
    const Action* action = findAction(app, name);
    const bool can = action->enabled();
    if (!can) {
        drawBox(rows.list, {rows.x0, rows.y}, {rows.x1, rows.y + dp(28)}, colors::header);
        drawTextCentred(rows.list, fonts().body, 0.5f * (rows.x0 + rows.x1), rows.y + dp(14),
                        colors::off, name);
    } else if (button(name, {rows.x0, rows.y}, {rows.x1 - rows.x0, dp(28)}, name,
                      primary ? ButtonKind::kPrimary : ButtonKind::kPlain, action->icon,
                      action->keys.empty() ? nullptr : action->keys.c_str())) {
        action->run();
    }
    rows.y += dp(38);
}

void showNote(Rows& rows, const char* text) {
    rows.y += drawTextWrapped(rows.list, fonts().small, {rows.x0, rows.y}, rows.x1 - rows.x0,
                              colors::dim, text) +
              dp(8);
}

void integerRow(Rows& rows, const char* label, uint32_t& value, const char* unit, float low,
                float high) {
    auto shown = float(value);
    if (numberRow(rows, label, shown,
                  {.unit = unit, .format = "%.0f", .lowest = low, .highest = high}) != Edit::kNone)
        value = uint32_t(std::clamp(std::round(shown), low, high));
}

void showActs(App& app, const Rect& rect) {
    OutputPage& page = *app.output;
    ImDrawList* list = beginPanel("##acts", rect, colors::panel, true);
    Rows rows{list, rect.x0 + dp(10), rect.x1 - dp(10), rect.y0 - ImGui::GetScrollY(), 96};
    if (section(rows, "For the game", page.gameOpen)) {
        showNote(rows,
                 "Burn maps, paint, pictures and flame shapes, and the code that loads them.");
        showAction(app, rows, "Write game files", true);
    }
    if (section(rows, "Live link", page.linkOpen)) {
        showNote(rows,
                 "A sample of the game shows each change as it is made: samples/run 14_scene "
                 "--link and this port.");
        rows.label("Linked");
        bool linked = page.linked;
        if (toggle("linked", {rows.fieldX(), rows.y + dp(3)}, linked))
            findAction(app, "Link to a sample")->run();
        rows.next();
        const uint32_t port = page.port;
        integerRow(rows, "Port", page.port, nullptr, 1024, 65535);
        if (page.port != port) page.link.disconnect();
        showNote(rows, linkWords(app).c_str());
    }
    if (section(rows, "Filmstrip", page.stripOpen)) {
        integerRow(rows, "Pictures", page.strip.count, nullptr, 2, 32);
        integerRow(rows, "In a row", page.strip.columns, nullptr, 1, 16);
        integerRow(rows, "Width of each", page.strip.width, "px", 64, 1920);
        page.strip.height = std::max(36u, page.strip.width * 9 / 16);
        showAction(app, rows, "Write filmstrip", false);
    }
    if (section(rows, "Turntable", page.turnOpen)) {
        integerRow(rows, "Pictures", page.turn.count, nullptr, 2, 240);
        integerRow(rows, "Width of each", page.turn.width, "px", 64, 3840);
        page.turn.height = std::max(36u, page.turn.width * 9 / 16);
        showNote(rows, ("As it burns at " + clockText(app.live.time())).c_str());
        showAction(app, rows, "Write turntable", false);
    }
    if (section(rows, "Flipbook of a flame", page.bookOpen)) {
        if (chosenFlame(app)) {
            std::vector<const char*> names;
            for (const fwedit::Flame& flame : app.document.scene.flames)
                names.push_back(flame.name.c_str());
            rows.label("Flame");
            page.flame = std::clamp(page.flame, 0, int(names.size()) - 1);
            choice("flame", {rows.fieldX(), rows.y}, {rows.fieldWidth(), dp(metrics::row)}, names,
                   page.flame);
            rows.next();
            integerRow(rows, "Frames", page.flipbook.frames, nullptr, 4, 128);
            integerRow(rows, "Size", page.flipbook.side, "px", 16, 256);
            numberRow(rows, "One turn", page.flipbook.seconds,
                      {.unit = "s", .format = "%.1f", .lowest = 0.2f, .highest = 10});
        } else {
            showNote(rows, "Add a flame to the scene to have it as a flipbook.");
        }
        showAction(app, rows, "Write flipbook", false);
    }
    if (section(rows, "Burn times", page.timesOpen)) {
        showNote(rows, "When each spot of each mesh catches, in seconds, as an EXR picture.");
        showAction(app, rows, "Write burn times", false);
    }
    ImGui::SetCursorScreenPos({rect.x0, rows.y});
    ImGui::Dummy({1, 1});
    endPanel();
}

// `comment`: in: inside a comment that began above; out: whether it continues below.
ImU32 codeColor(std::string_view line, bool& comment) {
    const size_t first = std::min(line.find_first_not_of(' '), line.size());
    const std::string_view words = line.substr(first);
    const bool within = comment || words.starts_with("/*");
    comment = within && words.find("*/") == words.npos;
    if (within || words.starts_with("//")) return colors::dim;
    return words.starts_with('#') ? colors::accent : colors::text;
}

void showCode(App& app, Rect rect) {
    OutputPage& page = *app.output;
    ImDrawList* list = beginPanel("##code", rect, colors::well);
    const Rect head = rect.cutTop(dp(38));
    list->AddRectFilled(head.low(), head.high(), colors::header);
    float x = head.x0 + dp(10);
    x += drawText(list, fonts().semi, x, head.midY(), colors::title, "Code for your game") + dp(16);
    segments("language", {x, head.y0 + dp(7)}, dp(110, 24), {"C", "C++"}, page.language);
    const std::string& code = page.codes[page.language];
    const auto lines = size_t(std::count(code.begin(), code.end(), '\n'));
    if (!code.empty())
        drawText(list, fonts().small, x + dp(126), head.midY(), colors::dim,
                 (std::to_string(lines) + " lines, for this very scene").c_str());
    if (!code.empty() && button("copy", {head.x1 - dp(92), head.y0 + dp(5)}, dp(84, 28), "Copy",
                                ButtonKind::kPlain, icons::copy))
        copyCode(app);
    if (code.empty()) {
        const std::string text = page.codeProblem.empty() ? "Reading the meshes" : page.codeProblem;
        drawTextWrapped(list, fonts().body, {rect.x0 + dp(24), rect.y0 + dp(24)},
                        rect.width() - dp(48), colors::dim, text.c_str());
        endPanel();
        return;
    }
    ImGui::SetCursorScreenPos(rect.low());
    ImGui::BeginChild("text", {rect.width(), rect.height()}, false,
                      ImGuiWindowFlags_HorizontalScrollbar);
    ImDrawList* inner = ImGui::GetWindowDrawList();
    const float row = dp(17), left = rect.x0 + dp(14) - ImGui::GetScrollX();
    const float top = rect.y0 + dp(12) - ImGui::GetScrollY();
    float widest = 0;
    size_t at = 0;
    bool comment = false;
    for (size_t i = 0; at < code.size(); ++i) {
        const size_t end = std::min(code.find('\n', at), code.size());
        const float y = top + row * (float(i) + 0.5f);
        const std::string line = code.substr(at, end - at);
        const ImU32 color = codeColor(line, comment);
        if (y > rect.y0 - row && y < rect.y1 + row && end > at) {
            drawText(inner, fonts().mono, left, y, color, line.c_str());
            widest = std::max(widest, textSize(fonts().mono, line.c_str()).x);
        }
        at = end + 1;
    }
    ImGui::SetCursorScreenPos({left + widest, top + row * float(lines) + dp(12)});
    ImGui::Dummy({1, 1});
    ImGui::EndChild();
    endPanel();
}

std::string leftText(double spent, float share) {
    if (share < 0.03f || spent < 1) return "";
    const double left = spent * double(1 - share) / double(share);
    char text[48];
    if (left < 90)
        std::snprintf(text, sizeof text, "about %.0f s left", std::ceil(left));
    else
        std::snprintf(text, sizeof text, "about %.0f min left", std::ceil(left / 60));
    return text;
}

void showResults(App& app, const Rect& rect) {
    OutputPage& page = *app.output;
    ImDrawList* list = beginPanel("##results", rect);
    const float x = rect.x0 + dp(10), right = rect.x1 - dp(10),
                half = rect.x0 + std::min(dp(430), 0.55f * rect.width());
    drawText(list, fonts().semi, x, rect.y0 + dp(18), colors::title, "Into the folder");
    std::string folder = abbreviateHome(folderOf(app));
    if (textField("folder", {x, rect.y0 + dp(32)}, {half - x - dp(20), dp(28)}, folder,
                  "A folder; created if missing", icons::open))
        page.folder = expandHome(folder);
    drawColumn(list, half - dp(8), rect.y0 + dp(10), rect.y1 - dp(10), colors::line);
    if (page.isWriting()) {
        std::string stage;
        float share = 0;
        {
            const std::lock_guard lock(page.job.mutex);
            stage = page.job.stage;
            share = page.job.share;
        }
        char percent[16];
        std::snprintf(percent, sizeof percent, "%.0f %%", double(100 * share));
        drawText(list, fonts().semi, half + dp(4), rect.y0 + dp(18), colors::title,
                 ("Writing: " + page.job.name).c_str());
        drawTextRight(list, fonts().semi, right - dp(110), rect.y0 + dp(18), colors::title,
                      percent);
        progressBar(list, {half + dp(4), rect.y0 + dp(32)}, right - dp(110) - half - dp(4), dp(8),
                    share, colors::accent);
        drawText(list, fonts().small, half + dp(4), rect.y0 + dp(54), colors::dim,
                 stage.empty() ? "Beginning" : stage.c_str());
        drawTextRight(list, fonts().small, right - dp(110), rect.y0 + dp(54), colors::dim,
                      leftText(app.now - page.job.began, share).c_str());
        if (page.job.stop)
            drawTextRight(list, fonts().body, right, rect.y0 + dp(36), colors::dim, "Stopping");
        else if (button("stop", {right - dp(92), rect.y0 + dp(22)}, dp(92, 28), "Cancel"))
            stop(page.job);
    } else if (page.written.empty()) {
        drawText(list, fonts().semi, half + dp(4), rect.y0 + dp(18), colors::title, "Written");
        drawText(list, fonts().body, half + dp(4), rect.y0 + dp(44), colors::dim,
                 "What you write is listed here.");
    } else {
        drawText(list, fonts().semi, half + dp(4), rect.y0 + dp(18), colors::title,
                 ("Written: " + page.writtenName).c_str());
        float y = rect.y0 + dp(42), column = half + dp(4);
        const float width = (right - column) / 2;
        const size_t shown = std::min<size_t>(page.written.size(), 6);
        for (size_t i = 0; i < shown; ++i) {
            const bool last = i + 1 == shown && page.written.size() > shown;
            const std::string text =
                last ? "and " + std::to_string(page.written.size() - shown + 1) + " more"
                     : page.written[i].filename().string();
            drawTextFit(list, fonts().body, column + width * float(i / 3),
                        y + dp(20) * float(i % 3), width - dp(10),
                        last ? colors::dim : colors::text, text.c_str());
        }
    }
    endPanel();
}

}  // namespace

void showOutput(App& app, Rect rect) {
    showTopBar(app, rect.cutTop(dp(metrics::topBar)));
    showStatus(app, rect.cutBottom(dp(metrics::status)),
               {{"Ctrl+E", "write game files"}, {"Ctrl+Shift+C", "copy the code"}, {"1", "scene"}});
    rect.y0 += dp(1);
    const Rect acts = rect.cutLeft(dp(296));
    rect.cutLeft(dp(2));
    const Rect results = rect.cutBottom(dp(110));
    rect.cutBottom(dp(2));
    showActs(app, acts);
    showCode(app, rect);
    showResults(app, results);
}

}  // namespace fwapp
