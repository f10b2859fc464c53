#include "sheet.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

namespace fwtools {
namespace {

using namespace fw;
using fwimport::FloatPicture;

constexpr float kRed = 1370.0f, kYellow = 1780.0f;  // K, tips and cores of the library's flames
constexpr float kYellowGreen = 0.8f;                // ratio of green to red of kYellow
constexpr uint32_t kMostCells = 256;                // per side

template <typename... Parts>
bool refused(std::string& error, const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    error = text.str();
    return false;
}

float linearOf(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

struct Reader {
    const FloatPicture& picture;
    int red, green, blue, alpha;  // channel indices; alpha -1: none

    // Linear, premultiplied; w: coverage.
    [[nodiscard]] vec4 operator()(uint32_t x, uint32_t y) const {
        const float cover =
            alpha < 0 ? 1.0f : std::clamp(picture.at(x, y, uint32_t(alpha)), 0.0f, 1.0f);
        vec3 colour;
        int c = 0;
        for (const int channel : {red, green, blue}) {
            const float stored = std::max(picture.at(x, y, uint32_t(channel)), 0.0f);
            colour[c++] = picture.whole ? cover * linearOf(stored) : stored;
        }
        const float most = std::max({colour.x, colour.y, colour.z});
        return vec4(colour, alpha < 0 ? std::min(most, 1.0f) : cover);
    }
};

// Returns the mean over a texel of `side` in a cell of width x height pixels at (left, top).
vec4 meanOver(const Reader& read, uint32_t left, uint32_t top, uint32_t width, uint32_t height,
              uint32_t side, uint32_t x, uint32_t y) {
    const float x0 = float(x) * float(width) / float(side),
                x1 = float(x + 1) * float(width) / float(side);
    const float y0 = float(y) * float(height) / float(side),
                y1 = float(y + 1) * float(height) / float(side);
    vec4 sum(0.0f);
    for (auto j = uint32_t(y0); float(j) < y1 && j < height; ++j)
        for (auto i = uint32_t(x0); float(i) < x1 && i < width; ++i)
            sum +=
                read(left + i, top + j) * ((std::min(x1, float(i + 1)) - std::max(x0, float(i))) *
                                           (std::min(y1, float(j + 1)) - std::max(y0, float(j))));
    return sum / ((x1 - x0) * (y1 - y0));
}

// `emits`: occludes nothing.
vec4 texelOf(const vec4& seen, flipbook::Kind kind, bool emits) {
    const float hides = std::clamp(seen.w, 0.0f, 1.0f);
    const float depth = -std::log(1.0f - std::min(hides, 0.996f));
    const float thick = 1.0f - std::exp(-depth / 4.0f);
    if (kind == flipbook::Kind::Smoke) return vec4(0.0f, 0.0f, hides, thick);
    const float most = std::max({seen.x, seen.y, seen.z});
    const float hue = seen.x > 1e-5f ? seen.y / seen.x / kYellowGreen : 1.0f;
    const float kelvin = kRed + (kYellow - kRed) * std::clamp(hue, 0.0f, 1.0f);
    const float glows = std::min(most, 1.0f);
    return vec4(
        (kelvin - gpu::kFlipbookMinKelvin) / (gpu::kFlipbookMaxKelvin - gpu::kFlipbookMinKelvin),
        glows, emits ? 0.0f : std::max(hides, glows), thick);
}

// Premultiplied light without any coverage is additive.
bool emitsAlone(const FloatPicture& picture, const Reader& read) {
    if (picture.whole || read.alpha < 0) return false;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x)
            if (picture.at(x, y, uint32_t(read.alpha)) > 0.0f) return false;
    return true;
}

}  // namespace

bool framesOfSheet(const FloatPicture& picture, SheetDef& def, std::vector<Frame>& frames,
                   std::string& error) {
    Reader read{picture, picture.channel("R"), picture.channel("G"), picture.channel("B"),
                picture.channel("A")};
    if (read.red < 0 && picture.channels <= 2) {  // grey
        read.red = read.green = read.blue = 0;
        if (picture.channels == 2) read.alpha = 1;
    }
    if (read.red < 0 || read.green < 0 || read.blue < 0)
        return refused(error, "it has ", picture.channels,
                       " channels without R, G and B; a sheet is grey or has these");
    for (const auto& [name, cells, pixels] : {std::tuple{"columns", def.columns, picture.width},
                                              std::tuple{"rows", def.rows, picture.height}}) {
        if (cells < 1 || cells > kMostCells)
            return refused(error, "it has ", cells, ' ', name, "; they must lie in [1, ",
                           kMostCells, "]");
        if (pixels % cells != 0)
            return refused(error, "it is ", picture.width, " x ", picture.height,
                           " pixels; that does not part into ", cells, " equal ", name);
    }
    const uint32_t cells = def.columns * def.rows;
    flipbook::Facts facts = def.facts;
    if (facts.frames == 0) facts.frames = cells;
    if (facts.frames < 2 || facts.frames > std::min(cells, flipbook::kMaxFrames))
        return refused(error, "frames is ", facts.frames, "; a grid of ", def.columns, " x ",
                       def.rows, " has [2, ", std::min(cells, flipbook::kMaxFrames), "] of them");
    const uint32_t width = picture.width / def.columns, height = picture.height / def.rows;
    facts.width = def.side ? def.side : width;
    facts.height = def.side ? def.side : height;
    for (const uint32_t side : {facts.width, facts.height})
        if (side < flipbook::kMinSide || side > flipbook::kMaxSide)
            return refused(error, "a frame is ", facts.width, " x ", facts.height,
                           " texels; each side must lie in [", flipbook::kMinSide, ", ",
                           flipbook::kMaxSide, "] (--size resamples)");
    facts.motionWidth = std::max(facts.width / 2, 4u);
    facts.motionHeight = std::max(facts.height / 2, 4u);
    for (size_t i = 0; i < picture.values.size(); ++i)
        if (!std::isfinite(picture.values[i]))
            return refused(error, "pixel (", i / picture.channels % picture.width, ", ",
                           i / picture.channels / picture.width, ") is ", picture.values[i],
                           "; it must be a number");

    const bool emits = emitsAlone(picture, read);
    std::vector<Frame> made(facts.frames);
    for (uint32_t k = 0; k < facts.frames; ++k) {
        const uint32_t left = k % def.columns * width, top = k / def.columns * height;
        for (uint32_t row = facts.height; row-- > 0;)  // rows from the bottom
            for (uint32_t x = 0; x < facts.width; ++x)
                made[k].texels.push_back(
                    texelOf(def.side ? meanOver(read, left, top, width, height, def.side, x, row)
                                     : read(left + x, top + row),
                            facts.kind, emits));
    }
    frames = std::move(made);
    def.facts = facts;
    return true;
}

}  // namespace fwtools
