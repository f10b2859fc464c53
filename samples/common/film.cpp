#include "common/film.h"

#include <algorithm>
#include <cstdio>

namespace sample {

Film::Film(const FilmRequest& request)
    : made_(request),
      animation_(request.folder / (request.name + "_animated.png"),
                 request.framesPerSecond / std::max(1u, request.animationEvery)) {}

void Film::add(uint32_t number, const Picture& picture) {
    char name[64];
    std::snprintf(name, sizeof name, "frame_%04u.png", number);
    writePng(made_.folder / name, picture);
    ++count_;
    auto scaled = [&](uint32_t width) {
        if (picture.width <= width) return picture;
        const uint32_t height =
            std::max<uint32_t>(1, (picture.height * width + picture.width / 2) / picture.width);
        return resized(picture, width, height);
    };
    if (number % std::max(1u, made_.animationEvery) == 0) {
        animation_.add(scaled(made_.animationWidth));
    }
    // The stills are evenly spaced and include the first and the last frame.
    const uint32_t last = std::max(1u, made_.frames) - 1,
                   stripCount = std::max(1u, made_.stripCount);
    const auto next = static_cast<uint32_t>(strip_.size());
    const uint32_t due =
        stripCount > 1 ? (last * next + (stripCount - 1) / 2) / (stripCount - 1) : last;
    if (next < stripCount && number >= due) strip_.push_back(scaled(made_.stripWidth));
}

std::vector<std::string> Film::close() {
    std::vector<std::string> files;
    if (count_ == 0) return files;
    files.push_back((made_.folder / "frame_0000.png").string() + " and " +
                    std::to_string(count_ - 1) + " more");
    if (animation_.frames() > 0) {
        animation_.close();
        files.push_back((made_.folder / (made_.name + "_animated.png")).string() +
                        " (animated: open it in a browser)");
    }
    if (strip_.size() > 1) {
        const std::filesystem::path path = made_.folder / (made_.name + "_strip.png");
        writePng(path, contactSheet(strip_, made_.columns));
        files.push_back(path.string());
    }
    return files;
}

}  // namespace sample
