// See recording.h. A line a frame, of words: floats as hexadecimal ones, which come back exactly.
#include "recording.h"

#include <cstdio>
#include <sstream>

#include "common/options.h"

namespace tower {
namespace {

constexpr const char* kTitle = "tower_defence inputs 1";

// Visits the floats of an input in file order.
template <class Input, class Do>
void eachFloat(Input& input, Do&& act) {
    for (auto* value :
         {&input.dragX, &input.dragY, &input.panX, &input.panY, &input.wheel, &input.moveRight,
          &input.moveForward, &input.turn, &input.clickX, &input.clickY, &input.x, &input.y})
        act(*value);
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& path, uint32_t seed) : file_(path) {
    if (!file_) throw sample::Failure("--record " + path.string() + " cannot be written");
    file_ << kTitle << "\nseed " << seed << "\n" << std::hexfloat;
}

void Recorder::frame(const sample::StageFrame& frame) {
    file_ << "frame " << frame.deltaTime << ' ' << frame.extent.width << ' ' << frame.extent.height;
    eachFloat(frame.input, [&](float value) { file_ << ' ' << value; });
    file_ << ' ' << frame.input.click << ' ' << frame.input.held << ' ' << frame.input.keys.size();
    for (const int key : frame.input.keys) file_ << ' ' << key;
    file_ << '\n';
}

void Recorder::markPicture() { file_ << "moment" << std::endl; }

Recording::Recording(const std::filesystem::path& path, uint32_t seed) {
    std::ifstream file(path);
    const auto fail = [&](const std::string& why) {
        throw sample::Failure("--play " + path.string() + ": " + why);
    };
    std::string line;
    if (!std::getline(file, line) || line != kTitle) fail("it is not a recording of this game");
    uint32_t recorded = 0;
    if (!std::getline(file, line) || std::sscanf(line.c_str(), "seed %u", &recorded) != 1)
        fail("its second line has no seed");
    if (recorded != seed) fail("it is of --seed " + std::to_string(recorded));
    while (std::getline(file, line)) {
        if (line == "moment") {
            if (frames_.size() > 1) frames_[frames_.size() - 2].isMarked = true;
            continue;
        }
        std::istringstream words(line);
        std::string word;
        const auto number = [&] {  // Streams cannot parse hexadecimal floats.
            if (!(words >> word)) fail("line \"" + line + "\" ends too early");
            return std::strtod(word.c_str(), nullptr);
        };
        if (!(words >> word) || word != "frame") fail("line \"" + line + "\" is none");
        Frame& frame = frames_.emplace_back();
        frame.deltaTime = float(number());
        frame.width = uint32_t(number());
        frame.height = uint32_t(number());
        eachFloat(frame.input, [&](float& value) { value = float(number()); });
        frame.input.click = number() != 0;
        frame.input.held = number() != 0;
        for (auto keys = size_t(number()); keys > 0; --keys)
            frame.input.keys.push_back(int(number()));
    }
    if (frames_.empty()) fail("it contains no frames");
}

void Recording::put(sample::StageFrame& frame) const {
    const Frame& was = frames_[frame.number];
    if (was.width != frame.extent.width || was.height != frame.extent.height)
        throw sample::Failure("frame " + std::to_string(frame.number) + " of the recording is of " +
                              std::to_string(was.width) + "x" + std::to_string(was.height) +
                              " pixels; give it as --size");
    frame.deltaTime = was.deltaTime;
    frame.input = was.input;
}

}  // namespace tower
