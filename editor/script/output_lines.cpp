#include "script/output_lines.h"

#include <charconv>
#include <cstdio>

#include "document/text.h"
#include "tools/whole_file.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// Parses an optional integer word.
bool whole(const Words& words, size_t at, const char* name, uint32_t low, uint32_t high,
           uint32_t& value, std::string& error) {
    if (at >= words.size()) return true;
    const std::string& word = words[at];
    uint32_t read = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), read);
    if (code == std::errc{} && end == word.data() + word.size() && read >= low && read <= high) {
        value = read;
        return true;
    }
    error = std::string(name) + " is \"" + word + "\"; it takes " + std::to_string(low) + " to " +
            std::to_string(high);
    return false;
}

bool size(const Words& words, size_t at, uint32_t& width, uint32_t& height, std::string& error) {
    return at >= words.size() || parseSize(words[at], width, height, error);
}

void reportFiles(ScriptHost& host, const std::vector<fs::path>& files) {
    for (const fs::path& file : files) host.say(file.string());
}

bool cook(ScriptHost& host, const Words& words, std::string& error) {
    OutputPlan plan;
    std::vector<fs::path> files;
    FwContext* cpu = nullptr;
    if (!need(words, 2, 2, "cook FOLDER", error) || !(cpu = host.cpu(error)) ||
        !planOutput(outputOf(host), plan, error) ||
        !cookScene(outputOf(host), plan, cpu, host.folder / words[1], host.progress, files, error))
        return false;
    reportFiles(host, files);
    return true;
}

bool snippet(ScriptHost& host, const Words& words, std::string& error) {
    OutputPlan plan;
    if (!need(words, 2, 2, "snippet FILE.c|FILE.cpp", error)) return false;
    const fs::path file = host.folder / words[1];
    if (file.extension() != ".c" && file.extension() != ".cpp") {
        error = "\"" + words[1] + "\" ends in neither .c nor .cpp";
        return false;
    }
    if (!planOutput(outputOf(host), plan, error)) return false;
    const std::string text =
        snippetOf(plan, file.extension() == ".c" ? SnippetLanguage::C : SnippetLanguage::Cpp);
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    error = fwtools::replaceFile(file.string(), std::as_bytes(std::span(text)));
    return error.empty();
}

bool filmstrip(ScriptHost& host, const Words& words, std::string& error) {
    FilmstripDef def;
    FwContext* device = nullptr;
    return need(words, 2, 5, "filmstrip FILE [PICTURES [WIDTHxHEIGHT [COLUMNS]]]", error) &&
           whole(words, 2, "the number of pictures", 1, 256, def.count, error) &&
           size(words, 3, def.width, def.height, error) &&
           whole(words, 4, "the number of columns", 1, 256, def.columns, error) &&
           (device = host.device(error)) &&
           writeFilmstrip(outputOf(host), device, def, host.folder / words[1], host.progress,
                          error);
}

bool turntable(ScriptHost& host, const Words& words, std::string& error) {
    TurntableDef def;
    def.time = host.playhead;
    FwContext* device = nullptr;
    std::vector<fs::path> files;
    if (!need(words, 2, 4, "turntable FOLDER [PICTURES [WIDTHxHEIGHT]]", error) ||
        !whole(words, 2, "the number of pictures", 1, 1024, def.count, error) ||
        !size(words, 3, def.width, def.height, error) || !(device = host.device(error)) ||
        !writeTurntable(outputOf(host), device, def, host.folder / words[1], host.progress, files,
                        error))
        return false;
    reportFiles(host, files);
    return true;
}

bool flipbook(ScriptHost& host, const Words& words, std::string& error) {
    FlipbookDef def;
    if (!need(words, 3, 5, "flipbook FILE.fwbook FLAME [FRAMES [TEXELS]]", error) ||
        !whole(words, 3, "the number of frames", 2, 256, def.frames, error) ||
        !whole(words, 4, "the size", 8, 512, def.side, error))
        return false;
    const ObjectId flame = findByWord(host.document.scene, words[2]);
    if (!findIn(host.document.scene.flames, flame)) {
        error = "\"" + words[2] + "\" is no flame of the scene";
        return false;
    }
    return writeFlipbook(outputOf(host), flame, def, host.folder / words[1], host.progress, error);
}

bool bake(ScriptHost& host, const Words& words, std::string& error) {
    FwContext* cpu = nullptr;
    std::vector<fs::path> files;
    if (!need(words, 2, 2, "bake FOLDER", error) || !(cpu = host.cpu(error)) ||
        !writeArrivals(outputOf(host), cpu, host.folder / words[1], host.progress, files, error))
        return false;
    reportFiles(host, files);
    return true;
}

}  // namespace

OutputInput outputOf(ScriptHost& host) {
    const Document& document = host.document;
    return {document.scene, document.images, baseFolder(document), document.file.stem().string(),
            host.assets};
}

bool runOutputLine(ScriptHost& host, const Words& words, bool& known, std::string& error) {
    struct Line {
        const char* verb;
        bool (*run)(ScriptHost&, const Words&, std::string&);
    };
    static constexpr Line kLines[] = {{"cook", cook},           {"snippet", snippet},
                                      {"filmstrip", filmstrip}, {"turntable", turntable},
                                      {"flipbook", flipbook},   {"bake", bake}};
    for (const Line& line : kLines)
        if (words[0] == line.verb) return line.run(host, words, error);
    known = false;
    return false;
}

}  // namespace fwedit
