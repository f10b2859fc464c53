// flamewright_profile: converts fire profiles between painted images, game files and presets. See
// --help.
#include "profile_picture.h"
#include "whole_file.h"

#include "core/error.h"
#include "volume/appearance.h"

#include <cstdio>
#include <filesystem>
#include <memory_resource>
#include <string>
#include <vector>

namespace {

using namespace fw;
namespace fs = std::filesystem;

constexpr const char* kHelp =
    "flamewright_profile IN OUT\n"
    "  IN   a .fwprofile, a picture (PNG, EXR, TIFF, ...), or the name of a preset\n"
    "  OUT  a .fwprofile, or a picture\n"
    "A picture of a fire profile has temperature in red and soot in green. x is the radius, from\n"
    "the axis to 1.25 radii; the lowest row is the base. Each side has 8 to 512 pixels.\n"
    "Integer images (PNG) span 0 to 3000 K and 0 to 2 of soot; float images (EXR) store K and\n"
    "soot directly. Below 1000 K soot does not glow: K / 1000 is then how much clean gas burns\n"
    "(blue).\n";

int refuse(const std::string& what) {
    std::fprintf(stderr, "flamewright_profile: %s\n", what.c_str());
    return 2;
}

bool isCooked(const fs::path& path) { return path.extension() == ".fwprofile"; }

// Prints the reason on failure.
bool read(const std::string& name, volume::Profile& profile) {
    for (uint32_t i = 0; i < uint32_t(volume::FlamePreset::Count); ++i)
        if (name == volume::presetName(volume::FlamePreset(i))) {
            volume::paintDefaultProfile(volume::presetDef(volume::FlamePreset(i)).appearance,
                                        profile);
            return true;
        }
    std::string error;
    if (!isCooked(name)) {
        fwimport::FloatPicture picture;
        if (!fwimport::readPicture(name, picture, error)) {
            (void)refuse(error);
            return false;
        }
        if (fwtools::profileOfPicture(picture, profile, error)) return true;
        (void)refuse(name + ": " + error);
        return false;
    }
    std::vector<std::byte> bytes;
    error = fwtools::readWhole(name, bytes);
    if (!error.empty()) {
        (void)refuse(error);
        return false;
    }
    try {
        volume::readProfile(bytes, profile);
        return true;
    } catch (const core::Error& failure) {
        (void)refuse(name + ": " + failure.message);
        return false;
    }
}

// Prints the reason on failure.
bool write(const std::string& name, const volume::Profile& profile) {
    if (!isCooked(name)) {
        const std::string kind = fs::path(name).extension().string();
        const bool whole = kind != ".exr" && kind != ".hdr" && kind != ".pfm";
        std::string error;
        if (fwimport::writePicture(name, fwtools::pictureOfProfile(profile, whole), error))
            return true;
        (void)refuse(error);
        return false;
    }
    const auto bytes = volume::cookProfile(profile, std::pmr::get_default_resource());
    const std::string error = fwtools::replaceFile(name, bytes);
    if (!error.empty()) (void)refuse(error);
    return error.empty();
}

}  // namespace

int main(int count, char** words) {
    if (count == 2 && std::string(words[1]) == "--help") {
        std::fputs(kHelp, stdout);
        std::fputs("Presets:", stdout);
        for (uint32_t i = 0; i < uint32_t(volume::FlamePreset::Count); ++i)
            std::printf(" \"%s\"", volume::presetName(volume::FlamePreset(i)));
        std::fputs("\n", stdout);
        return 0;
    }
    if (count != 3) return refuse("two names are needed; see --help");
    const std::string in = words[1], out = words[2];
    volume::Profile profile;
    if (!read(in, profile) || !write(out, profile)) return 2;
    std::printf("%s: %u x %u texels\n", out.c_str(), gpu::kProfileWidth, gpu::kProfileHeight);
    return 0;
}
