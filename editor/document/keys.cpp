#include "document/keys.h"

#include <algorithm>
#include <iterator>

namespace fwedit {
namespace {

struct Named {
    std::string_view name;
    int code;
};
constexpr Named kNamed[] = {
    {"Space", 32},  {"Tab", 258},   {"Backspace", 259}, {"Insert", 260}, {"Del", 261},
    {"Right", 262}, {"Left", 263},  {"Down", 264},      {"Up", 265},     {"PgUp", 266},
    {"PgDn", 267},  {"Home", 268},  {"End", 269},       {"Plus", 61},    {"Minus", 45},
    {"F1", 290},    {"F2", 291},    {"F3", 292},        {"F4", 293},     {"F5", 294},
    {"F6", 295},    {"F7", 296},    {"F8", 297},        {"F9", 298},     {"F10", 299},
    {"F11", 300},   {"F12", 301},   {"Num 0", 320},     {"Num 1", 321},  {"Num 2", 322},
    {"Num 3", 323}, {"Num 4", 324}, {"Num 5", 325},     {"Num 6", 326},  {"Num 7", 327},
    {"Num 8", 328}, {"Num 9", 329}, {"Num .", 330},     {"Num /", 331},  {"Num *", 332},
    {"Num −", 333}, {"Num +", 334}};
constexpr std::string_view kSingle = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789,.[]/;'\\`";

bool meetOnAPage(int a, int b) { return a == b || a < -1 || b < -1; }

}  // namespace

std::optional<KeyPress> parseKeys(std::string_view words) {
    KeyPress keys;
    const auto modifier = [&](std::string_view name, bool& held) {
        if (!words.starts_with(name)) return;
        held = true;
        words.remove_prefix(name.size());
    };
    modifier("Ctrl+", keys.ctrl);
    modifier("Shift+", keys.shift);
    if (words.size() == 1 && kSingle.find(words[0]) != std::string_view::npos) {
        keys.code = words[0];
        return keys;
    }
    const auto* found = std::find_if(std::begin(kNamed), std::end(kNamed),
                                     [&](const Named& one) { return one.name == words; });
    if (found == std::end(kNamed)) return {};
    keys.code = found->code;
    return keys;
}

std::string printKeys(const KeyPress& keys) {
    std::string name;
    if (keys.code < 128 && kSingle.find(static_cast<char>(keys.code)) != std::string_view::npos)
        name = static_cast<char>(keys.code);
    for (const Named& one : kNamed)
        if (one.code == keys.code) name = one.name;
    if (name.empty()) return name;
    return std::string(keys.ctrl ? "Ctrl+" : "") + (keys.shift ? "Shift+" : "") + name;
}

const KeyUse* keyConflict(std::span<const KeyUse> uses, std::string_view command,
                          const KeyPress& keys, int page) {
    for (const KeyUse& use : uses) {
        if (use.command == command || !meetOnAPage(use.page, page)) continue;
        const std::optional<KeyPress> theirs = parseKeys(use.keys);
        if (theirs && *theirs == keys) return &use;
    }
    return nullptr;
}

}  // namespace fwedit
