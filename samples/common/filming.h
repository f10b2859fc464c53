// A sample's run as it is shown: pictures and a progress bar while it lasts, one screen at its end.
// With a window it does nothing.
#pragma once

#include "common/film.h"
#include "common/fire_host.h"
#include "common/progress.h"
#include "common/stage.h"

namespace sample {

class Filming {
 public:
    // Takes the stage's pictures. `film` names the run and may say how it is joined; the folder and
    // the counts come from the options and the stage.
    Filming(Stage& stage, const Options& options, FilmRequest film);
    Filming(const Filming&) = delete;
    Filming& operator=(const Filming&) = delete;

    double seconds() const { return progress_.seconds(); }  // since it began
    // After the last frame: joins the pictures, and prints the summary with what the passes cost.
    void finish(Summary summary, const FireHost& fire);

 private:
    VkSampleCountFlagBits samples_;
    Film film_;
    Progress progress_;
};

}  // namespace sample
