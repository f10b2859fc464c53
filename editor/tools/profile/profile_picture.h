// A fire profile as a picture that an artist paints: red is temperature, green is soot; radius goes
// to the right, from the axis to 1.25 radii; the lowest row is the flame's base. Channels named
// "temperature" and "soot" are taken before these.
#pragma once
#include "import/float_picture.h"
#include "volume/profile.h"

#include <string>

namespace fwtools {

// Whole numbers (PNG) span [0, 3000] K and [0, 2] of soot; floats (EXR) are K and soot as they are.
// False: `error` names the channel, the pixel, the value and the limit; `profile` is untouched.
bool profileOfPicture(const fwimport::FloatPicture& picture, fw::volume::Profile& profile,
                      std::string& error);

// 64 x 128 pixels of three channels, blue is 0. whole: as a PNG has it.
fwimport::FloatPicture pictureOfProfile(const fw::volume::Profile& profile, bool whole);

}  // namespace fwtools
