#include "bundle/report.h"

#include "bundle/child.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <vector>

using nlohmann::json;

namespace fw::bundle {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Flamewright report</title><style>
:root{color-scheme:light}
body{font:15px/1.45 system-ui,"DejaVu Sans",sans-serif;color:#1d1f23;background:#f4f2ee;margin:0}
main{max-width:1180px;margin:0 auto;padding:24px 28px 60px}
h1{font-size:27px;margin:0 0 2px}h2{font-size:19px;margin:34px 0 8px}h3{font-size:15px;margin:0 0 4px}
p{margin:6px 0 10px}.dim{color:#6b6f76}small{color:#6b6f76}
table{border-collapse:collapse;background:#fff;width:100%;margin:6px 0 10px}
th,td{text-align:left;vertical-align:top;padding:4px 10px;border-bottom:1px solid #e6e2da}
th{background:#ece8e0;font-weight:600}td.n,th.n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
code{font:13px "DejaVu Sans Mono",Consolas,monospace;overflow-wrap:anywhere}
.badges{display:grid;grid-template-columns:repeat(4,1fr);gap:12px;margin:18px 0 6px}
.badge{background:#fff;border-left:6px solid #9aa0a8;padding:10px 14px}
.badge b{display:block;font-size:18px}.badge.good{border-color:#2f8a4c}.badge.bad{border-color:#c63a25}
.bad b,td.bad{color:#b3301c}.good b,td.good{color:#24703d}
.films{display:grid;grid-template-columns:repeat(3,1fr);gap:14px}
figure{margin:0;background:#fff}figure img{display:block;width:100%}
figcaption{padding:6px 10px 9px;font-size:13px}
.two{display:grid;grid-template-columns:1fr 1fr;gap:0 18px}
details{margin:6px 0}summary{cursor:pointer}
tr.sum td{font-weight:600;background:#faf8f4}
@media print{body{background:#fff}}@media(max-width:800px){.badges,.films,.two{grid-template-columns:1fr}}
</style></head><body><main>
)";

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '&')
            out += "&amp;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

std::string textOfValue(const json& value) {
    return escaped(value.is_string() ? value.get<std::string>() : value.dump());
}

std::string base64(const std::string& bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
    return out;
}

std::string milliseconds(double value) {
    char text[32];
    std::snprintf(text, sizeof text, value < 10 ? "%.3f" : value < 100 ? "%.2f" : "%.1f", value);
    return text;
}

std::string cell(const std::string& text, const char* style = "") {
    return *style ? "<td class=\"" + std::string(style) + "\">" + text + "</td>"
                  : "<td>" + text + "</td>";
}
std::string heading(const std::string& text, bool number = false) {
    return (number ? "<th class=\"n\">" : "<th>") + text + "</th>";
}

class Page {
 public:
    Page(const json& report, const std::string& folder)
        : report_(report),
          pictures_(folder + "/pictures"),
          golden_(folder + "/logs/tests/golden") {}

    std::string write() {
        out_ = kHead;
        top();
        badges();
        films();
        passes();
        conformance();
        tests();
        bench();
        machine();
        problems();
        out_ += "</main></body></html>\n";
        return out_;
    }

 private:
    void add(const std::string& text) { out_ += text + "\n"; }
    [[nodiscard]] bool has(const char* part) const { return report_.contains(part); }

    void top() {
        const bool device = !report_["devices"].empty();
        add("<h1>Flamewright on " +
            (device ? textOfValue(report_["devices"][0]["name"]) : "no Vulkan device") + "</h1>");
        std::string line;
        if (device) {
            const json& d = report_["devices"][0];
            line = textOfValue(d["type"]) + ", Vulkan " + textOfValue(d["vulkan"]);
            if (d.contains("driver"))
                line += ", " + textOfValue(d["driver"]) + " " + textOfValue(d["driverInfo"]);
        } else {
            line = textOfValue(report_["problem"]);
        }
        add("<p>" + line + "<br><span class=\"dim\">" + textOfValue(report_["machine"]["system"]) +
            ", " + textOfValue(report_["machine"]["processor"]) + ". Library " +
            textOfValue(report_["library"]) + ", " + textOfValue(report_["build"]) + ". " +
            textOfValue(report_["date"]) +
            (report_.contains("seconds")
                 ? ", took " + std::to_string(report_["seconds"].get<int>()) + " s"
                 : ", not finished") +
            ".</span></p>");
    }

    void badge(const char* style, const std::string& title, const std::string& verdict,
               const std::string& more) {
        add("<div class=\"badge " + std::string(style) + "\">" + title + "<b>" + verdict +
            "</b><small>" + more + "</small></div>");
    }
    void badges() {
        add("<div class=\"badges\">");
        if (!has("conformance")) {
            badge("", "Burn hashes", "not run", "");
        } else {
            const json& rows = report_["conformance"]["rows"];
            const auto equal = std::count_if(rows.begin(), rows.end(),
                                             [](const json& row) { return row["equal"]; });
            const bool good = report_["conformance"]["equal"];
            badge(good ? "good" : "bad", "Burn hashes", good ? "equal" : "DIFFERENT",
                  std::to_string(equal) + " of " + std::to_string(rows.size()) +
                      ": device, cpu backend, recorded");
        }
        if (!has("validation") || report_["validation"]["layer"] == "none") {
            badge("", "Validation", "not run",
                  has("validation") ? "VK_LAYER_KHRONOS_validation is not installed" : "");
        } else {
            const json& validation = report_["validation"];
            const int count = validation["count"];
            const bool good = count == 0 && !validation.contains("fault");
            badge(good ? "good" : "bad", "Validation",
                  validation.contains("fault") ? "stopped"
                  : count == 0                 ? "silent"
                                               : std::to_string(count) + " messages",
                  "synchronization checks included; layer of the " +
                      textOfValue(validation["layer"]));
        }
        if (!has("tests")) {
            badge("", "Tests on the device", "not run", "");
        } else {
            const json& t = report_["tests"];
            const bool good = t["problems"].empty();
            const bool all = t["notRun"] == 0;
            badge(!good ? "bad"
                  : all ? "good"
                        : "",
                  "Tests on the device",
                  good ? t["passed"].dump() + " passed"
                       : std::to_string(t["problems"].size()) + " failed",
                  t["passed"].dump() + " passed, " + t["skipped"].dump() + " skipped, " +
                      t["notRun"].dump() + " not run for want of time");
        }
        double most = 0;
        std::string scene, size;
        size_t faults = 0;
        if (has("passes"))
            for (const json& timed : report_["passes"]) {
                faults += timed.contains("fault");
                if (timed.value("sizes", json::array()).empty()) continue;
                const json& first = timed["sizes"][0];
                if (first["ms"].get<double>() < most) continue;
                most = first["ms"];
                scene = textOfValue(timed["name"]);
                size = sizeOf(first);
            }
        badge(faults          ? "bad"
              : has("passes") ? "good"
                              : "",
              "Slowest scene",
              !has("passes") ? "not run"
              : faults       ? std::to_string(faults) + " stopped"
                             : milliseconds(most) + " ms",
              scene.empty() ? "" : scene + " at " + size + ", all passes of a frame");
        add("</div>");
        if (software())
            add("<p class=\"dim\">This is a software device: the processor draws. Its times say "
                "nothing about a GPU.</p>");
    }
    [[nodiscard]] bool software() const {
        return !report_["devices"].empty() && report_["devices"][0]["type"] == "software device";
    }
    static std::string sizeOf(const json& size) {
        return size["width"].dump() + " &times; " + size["height"].dump();
    }

    static std::string picture(const std::string& name, const std::string& file) {
        return "<img alt=\"" + escaped(name) + "\" src=\"data:image/png;base64," +
               base64(textOf(file)) + "\">";
    }
    void films() {
        if (!has("passes")) return;
        add("<h2>Pictures</h2><div class=\"films\">");
        for (const json& timed : report_["passes"]) {
            const std::string name = timed["name"];
            const std::string file = pictures_ + "/" + name + "_small.png";
            if (!std::filesystem::exists(file)) continue;
            std::string times;
            for (const json& size : timed.value("sizes", json::array()))
                times += "<br>" + milliseconds(size["ms"]) + " ms at " + sizeOf(size);
            add("<figure>" + picture(name, file) + "<figcaption><b>" + escaped(name) +
                "</b>: " + textOfValue(timed["title"]) + times + "</figcaption></figure>");
        }
        add("</div>");
    }

    void passes() {
        if (!has("passes")) return;
        add("<h2>Time of each pass</h2><p>Milliseconds, mean over the frames. A frame is a step of "
            "the simulation, if one is due (32 in a second), and a picture. Passes below 1 % of "
            "their scene are summed.</p><div class=\"two\">");
        for (const json& timed : report_["passes"]) {
            const std::string title =
                "<b>" + textOfValue(timed["name"]) + "</b>: " + textOfValue(timed["title"]);
            if (timed.contains("fault")) {
                add("<p>" + title + "<br><span style=\"color:#b3301c\">" +
                    textOfValue(timed["fault"]) + "</span></p>");
                continue;
            }
            add("<div><p>" + title + "<br><span class=\"dim\">" + timed["burningObjects"].dump() +
                " objects burn, " + timed["quads"].dump() + " quads, " +
                timed["refinedTriangles"].dump() + " refined triangles, " +
                timed["gpuMemoryMiB"].dump() + " MiB of device memory</span></p>");
            if (!timed["gpuTimers"]) add("<p>The device has no timers.</p>");
            passTable(timed["sizes"]);
            add("</div>");
        }
        add("</div>");
    }
    void passTable(const json& sizes) {
        std::string head = heading("part") + heading("pass");
        std::vector<std::pair<std::string, std::vector<double>>> rows;
        for (size_t s = 0; s < sizes.size(); ++s) {
            head += heading(sizeOf(sizes[s]), true);
            for (const json& pass : sizes[s]["passes"]) {
                const std::string key =
                    cell(textOfValue(pass["part"])) + cell(textOfValue(pass["name"]));
                auto at = std::find_if(rows.begin(), rows.end(),
                                       [&](const auto& row) { return row.first == key; });
                if (at == rows.end())
                    at = rows.insert(rows.end(), {key, std::vector<double>(sizes.size(), 0)});
                at->second[s] = pass["ms"];
            }
        }
        add("<table><tr>" + head + "</tr>");
        std::vector<double> rest(sizes.size(), 0);
        size_t few = 0;
        for (const auto& [key, times] : rows) {
            bool shown = false;
            for (size_t s = 0; s < sizes.size(); ++s)
                shown |= times[s] >= 0.01 * sizes[s]["ms"].get<double>();
            if (shown) {
                addTimes("", key, times);
            } else {
                ++few;
                for (size_t s = 0; s < sizes.size(); ++s) rest[s] += times[s];
            }
        }
        if (few) addTimes("", cell("") + cell(std::to_string(few) + " more passes"), rest);
        std::vector<double> all, wall;
        for (const json& size : sizes) {
            all.push_back(size["ms"]);
            wall.push_back(size["wallMs"]);
        }
        addTimes(" class=\"sum\"", cell("") + cell("all passes"), all);
        addTimes("",
                 cell("") + cell("<span class=\"dim\">with submitting, waiting and reading "
                                 "the picture, by the clock</span>"),
                 wall);
        add("</table>");
    }
    void addTimes(const char* style, const std::string& key, const std::vector<double>& times) {
        std::string line = "<tr" + std::string(style) + ">" + key;
        for (const double time : times) line += cell(milliseconds(time), "n");
        add(line + "</tr>");
    }

    void conformance() {
        if (!has("conformance")) return;
        add("<h2>Burn hashes</h2><p>Small scenes burn on this machine's cpu backend and on the "
            "device. Each hash is over every texel of every object. All must equal those that were "
            "recorded where the library was built.</p><table><tr>" +
            heading("scene") + heading("second", true) + heading("texels ignited", true) +
            heading("recorded") + heading("cpu backend") + heading("device") + "</tr>");
        for (const json& row : report_["conformance"]["rows"]) {
            std::string line = "<tr>" + cell(textOfValue(row["scene"])) +
                               cell(textOfValue(row["seconds"]), "n") +
                               cell(textOfValue(row["ignited"]), "n") +
                               cell("<code>" + textOfValue(row["recorded"]) + "</code>");
            for (const char* backend : {"cpu", "device"}) {
                const std::string hash = row[backend];
                line += cell(hash.empty()              ? "none"
                             : hash == row["recorded"] ? "equal"
                                                       : "<code>" + escaped(hash) + "</code>",
                             hash == row["recorded"] ? "good" : "bad");
            }
            add(line + "</tr>");
        }
        add("</table>");
        if (!has("validation")) return;
        for (const json& message : report_["validation"]["messages"])
            add("<p><code>" + textOfValue(message) + "</code></p>");
    }

    void tests() {
        if (!has("tests")) return;
        const json& t = report_["tests"];
        add("<h2>Tests on the device</h2>");
        if (software())
            add("<p class=\"dim\">On a software device only those that compare the device with the "
                "cpu backend and check the use of Vulkan.</p>");
        if (t["problems"].empty()) {
            add("<p>" + t["passed"].dump() + " passed, " + t["skipped"].dump() + " skipped.</p>");
        } else {
            add("<table><tr>" + heading("test") + heading("verdict") + heading("alone") +
                heading("message") + "</tr>");
            for (const json& problem : t["problems"])
                add("<tr>" + cell(textOfValue(problem["name"])) +
                    cell(textOfValue(problem["verdict"]), "bad") +
                    cell(textOfValue(problem["alone"])) +
                    cell("<code>" + textOfValue(problem["message"]) + "</code>") + "</tr>");
            add("</table>");
        }
        differences();
        for (const json& skip : t["skips"])
            add("<p class=\"dim\">" + skip["count"].dump() +
                " skipped: " + textOfValue(skip["message"]) + "</p>");
    }

    // Pictures that differ from those in tests/golden.
    void differences() {
        constexpr const char* kEnding = "_difference.png";
        std::vector<std::string> names;
        std::error_code none;
        for (const auto& entry : std::filesystem::directory_iterator(golden_, none)) {
            const std::string name = entry.path().filename().string();
            if (name.ends_with(kEnding))
                names.push_back(name.substr(0, name.size() - std::strlen(kEnding)));
        }
        std::sort(names.begin(), names.end());
        for (const std::string& name : names) {
            add("<p>" + escaped(name) +
                ": here, expected, difference times 4</p>"
                "<div class=\"films\">");
            for (const char* which : {"_actual.png", "_expected.png", kEnding})
                add("<figure>" + picture(name + which, golden_ + "/" + name + which) + "</figure>");
            add("</div>");
        }
    }

    void bench() {
        if (!has("bench")) return;
        add("<h2>Bench</h2><table><tr>" + heading("row") + heading("time", true) +
            heading("counters") + "</tr>");
        for (const json& row : report_["bench"]) {
            if (row.contains("fault")) {
                add("<tr>" + cell(textOfValue(row["name"])) + cell("", "n") +
                    cell(textOfValue(row["fault"]), "bad") + "</tr>");
                continue;
            }
            std::string counters;
            const json values = row.value("counters", json::object());
            for (const auto& [name, value] : values.items()) {
                char text[96];
                std::snprintf(text, sizeof text, "%s %.4g  ", name.c_str(), value.get<double>());
                counters += escaped(text);
            }
            add("<tr>" + cell(textOfValue(row["name"])) +
                cell(milliseconds(row["time"]) + " " + textOfValue(row["unit"]), "n") +
                cell("<small>" + counters + "</small>") + "</tr>");
        }
        add("</table>");
    }

    void facts(const json& values, const std::vector<const char*>& keys) {
        add("<table>");
        for (const char* key : keys)
            if (values.contains(key))
                add("<tr>" + cell(key) + cell(textOfValue(values[key])) + "</tr>");
        add("</table>");
    }
    void machine() {
        add("<h2>Machine and devices</h2><div class=\"two\"><div><h3>Machine</h3>");
        facts(report_["machine"],
              {"processor", "threads", "memoryMiB", "system", "kernel", "libc"});
        if (has("loader")) add("<p>Vulkan loader " + textOfValue(report_["loader"]) + "</p>");
        add("</div>");
        bool first = true;
        for (const json& device : report_["devices"]) {
            add("<div><h3>" + textOfValue(device["name"]) + (first ? " (used)" : "") + "</h3>");
            facts(device, {"type", "vulkan", "driver", "driverInfo", "driverVersion",
                           "vulkanConformance", "vendorId", "deviceId", "subgroupSize"});
            add("<details><summary>queues, memory, limits, extensions</summary>");
            facts(device, {"queueFamilies", "memoryHeaps", "memoryTypes"});
            std::vector<const char*> limits;
            for (const auto& [name, value] : device["limits"].items())
                limits.push_back(name.c_str());
            facts(device["limits"], limits);
            std::string extensions;
            for (const json& name : device.value("extensions", json::array()))
                extensions += textOfValue(name) + " ";
            add("<small>" + extensions + "</small></details></div>");
            first = false;
        }
        add("</div>");
    }

    void problems() {
        if (report_["problems"].empty()) return;
        add("<h2>Problems of this run</h2>");
        for (const json& problem : report_["problems"])
            add("<p><code>" + textOfValue(problem) + "</code></p>");
    }

    const json& report_;
    std::string pictures_, golden_, out_;
};

}  // namespace

std::string htmlOf(const json& report, const std::string& folder) {
    return Page(report, folder).write();
}

}  // namespace fw::bundle
