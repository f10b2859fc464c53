#include "common/filming.h"

#include <algorithm>
#include <string>
#include <utility>

namespace sample {
namespace {

FilmRequest filled(FilmRequest film, const Stage& stage, const Options& options) {
    film.folder = options.out;
    film.framesPerSecond = options.fps;
    film.frames = stage.frames();
    return film;
}

}  // namespace

Filming::Filming(Stage& stage, const Options& options, FilmRequest film)
    : samples_(stage.made.samples),
      film_(filled(film, stage, options)),
      progress_(film.name, std::max(1u, stage.frames())) {
    stage.onPicture = [this](uint32_t number, Picture&& picture) {
        film_.add(number, picture);
        progress_.update(number + 1);
    };
}

void Filming::finish(Summary summary, const FireHost& fire) {
    progress_.finish();
    if (samples_ != VK_SAMPLE_COUNT_1_BIT)
        summary.rows.emplace_back("picture",
                                  std::to_string(uint32_t(samples_)) + " samples a pixel");
    summary.passes = fire.passCosts();
    summary.files = film_.close();
    printSummary(summary);
}

}  // namespace sample
