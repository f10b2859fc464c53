// Pictures of models, in every format that the importer reads.
#include "fuzz/pictures.h"
#include "import/image_decode.h"

namespace fuzz {
namespace {

const Fuzzer kPicture{"picture",
                      [] {
                          std::vector<Bytes> seeds;
                          for (const char* extension : {".png", ".jpg", ".tif", ".webp"})
                              for (const uint32_t channels : {3u, 4u})
                                  seeds.push_back(encoded(smallPicture(channels, true), extension));
                          for (const char* extension : {".exr", ".hdr"})
                              seeds.push_back(encoded(smallPicture(3, false), extension));
                          return seeds;
                      },
                      [](Input input) {
                          fwimport::DecodedImage image;
                          std::string error;
                          if (!fwimport::decodeImage(input, image, error)) {
                              EXPECT_FALSE(error.empty());
                              return false;
                          }
                          EXPECT_EQ(image.rgba.size(), size_t{4} * image.width * image.height);
                          return true;
                      }};

}  // namespace
}  // namespace fuzz
