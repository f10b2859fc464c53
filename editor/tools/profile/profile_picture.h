// A fire profile as a painted image: red is temperature, green is soot. x is the radius from the
// axis to 1.25 radii; the lowest row is the flame's base. Channels named "temperature" and "soot"
// take precedence.
#pragma once
#include "import/float_picture.h"
#include "volume/profile.h"

#include <string>

namespace fwtools {

// Integer images (PNG) span [0, 3000] K and [0, 2] of soot; float images (EXR) store K and soot
// directly. On failure returns false; `error` has the channel, the pixel, the value and the limit.
// `profile` is then unchanged.
bool profileOfPicture(const fwimport::FloatPicture& picture, fw::volume::Profile& profile,
                      std::string& error);

// 64 x 128 pixels of three channels, blue is 0. whole: integer values, as in a PNG.
fwimport::FloatPicture pictureOfProfile(const fw::volume::Profile& profile, bool whole);

}  // namespace fwtools
