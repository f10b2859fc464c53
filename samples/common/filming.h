// Films a headless run: pictures and a progress bar while it runs, a summary at its end. Does
// nothing with a window.
#pragma once

#include "common/film.h"
#include "common/fire_host.h"
#include "common/progress.h"
#include "common/stage.h"

namespace sample {

class Filming {
 public:
    // Receives the stage's pictures. `film`: name and layout of the combined pictures; folder and
    // counts come from the options and the stage.
    Filming(Stage& stage, const Options& options, FilmRequest film);
    Filming(const Filming&) = delete;
    Filming& operator=(const Filming&) = delete;

    double seconds() const { return progress_.seconds(); }  // since the start
    // After the last frame: writes the combined pictures and prints the summary with the cost per
    // pass.
    void finish(Summary summary, const FireHost& fire);

 private:
    VkSampleCountFlagBits samples_;
    Film film_;
    Progress progress_;
};

}  // namespace sample
