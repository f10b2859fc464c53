// Fire profiles: cooked ones, and pictures of them, EXR above all.
#include "core/error.h"
#include "fuzz/pictures.h"
#include "fuzz/signed_input.h"
#include "profile_picture.h"
#include "volume/appearance.h"

namespace fuzz {
namespace {

std::vector<Bytes> profileSeeds() {
    fw::volume::Profile profile;
    fw::volume::paintDefaultProfile(fw::volume::presetDef(fw::volume::FlamePreset{}).appearance,
                                    profile);
    fwimport::FloatPicture small = smallPicture(3, false);
    small.width = small.height = 8;
    small.values.assign(size_t{8} * 8 * 3, 0.5f);
    return {fixture("campfire.fwprofile"),
            encoded(fwtools::pictureOfProfile(profile, false), ".exr"), encoded(small, ".exr"),
            encoded(small, ".tif"), encoded(fwtools::pictureOfProfile(profile, true), ".png")};
}

// A fire of that shape burns for a moment.
bool burnProfile(const FwFireProfileDef& def) {
    host::HostedWorld w(FW_BACKEND_CPU);
    FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
    if (fwWorld_CreateFireProfile(w.world, &def, &fire.profile) != FW_OK) return false;
    (void)host::created(fwWorld_CreateVolumetricFire, w.world, fire);
    w.run(0.1);
    return true;
}

const Fuzzer kProfile{"profile", profileSeeds, [](Input input) {
                          FwFireProfileDef def = fwDefaultFireProfileDef();
                          const Bytes bytes = signedInput(input);
                          if (const char* extension = extensionOf(input)) {
                              const TemporaryFile file(extension);
                              std::ofstream(file.path, std::ios::binary)
                                  .write(reinterpret_cast<const char*>(bytes.data()),
                                         std::streamsize(bytes.size()));
                              fwimport::FloatPicture picture;
                              fw::volume::Profile profile;
                              std::string error;
                              const bool good = fwimport::readPicture(file.path, picture, error) &&
                                                fwtools::profileOfPicture(picture, profile, error);
                              EXPECT_TRUE(good || !error.empty());
                              return good;
                          }
                          def.cooked = bytes.data();
                          def.cookedSize = bytes.size();
                          return !bytes.empty() && burnProfile(def);
                      }};

}  // namespace
}  // namespace fuzz
