// Opens and saves the scene file and the layer images beside it.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "document/document.h"
#include "document/text.h"
#include "import/float_picture.h"

namespace fwedit {
namespace {

namespace fs = std::filesystem;

std::string reason(const fs::path& file, const char* what) {
    return file.string() + " " + what + ": " + std::strerror(errno) + ".";
}

// Replaces a file atomically and flushes it to disk.
bool replaceFile(const fs::path& file, std::string_view bytes, std::string& error) {
    const std::string fresh = file.string() + ".new";
    const int handle = ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (handle < 0) {
        error = reason(file, "is not saved");
        return false;
    }
    bool good = true;
    while (good && !bytes.empty()) {
        const ssize_t wrote = ::write(handle, bytes.data(), bytes.size());
        if (wrote < 0 && errno == EINTR) continue;
        good = wrote > 0;
        if (good) bytes.remove_prefix(static_cast<size_t>(wrote));
    }
    good = good && ::fsync(handle) == 0;
    if (!good) error = reason(file, "is not saved");
    if (::close(handle) != 0 && good) {
        error = reason(file, "is not saved");
        good = false;
    }
    if (good && std::rename(fresh.c_str(), file.c_str()) != 0) {
        error = reason(file, "is not saved");
        good = false;
    }
    if (!good) {
        std::remove(fresh.c_str());
        return false;
    }
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory >= 0) {
        ::fsync(directory);
        ::close(directory);
    }
    return true;
}

uint64_t hashOf(std::span<const uint8_t> bytes) {
    uint64_t hash = 0xcbf29ce484222325ull;
    for (const uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
    return hash;
}

fs::path folderOf(const fs::path& file) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(file, ignored);
    return whole.parent_path();
}

// Converts a path relative to one folder into one relative to another.
std::string rebased(const std::string& path, const fs::path& from, const fs::path& to) {
    if (path.empty()) return path;
    const fs::path given(path);
    const fs::path whole = (given.is_absolute() ? given : from / given).lexically_normal();
    const fs::path relative = whole.lexically_relative(to.lexically_normal());
    return relative.empty() ? whole.generic_string() : relative.generic_string();
}

void rebaseScene(Scene& scene, const fs::path& from, const fs::path& to) {
    for (Mesh& mesh : scene.meshes) mesh.file = rebased(mesh.file, from, to);
    for (Flame& flame : scene.flames) flame.profile = rebased(flame.profile, from, to);
}

fwimport::FloatPicture pictureOf(const PaintImage& image) {
    fwimport::FloatPicture picture;
    picture.width = image.width;
    picture.height = image.height;
    picture.channels = 1;
    picture.whole = true;
    picture.names = {"Y"};
    for (const uint8_t value : image.flat()) picture.values.push_back(float(value) / 255.0f);
    return picture;
}

// Image names depend on their content, so a saved scene never shows another scene's paint, even
// after an interrupted save.
bool savePictures(Scene& scene, const PaintImages& images, const fs::path& file,
                  std::string& error) {
    for (PaintLayer& layer : scene.layers) {
        const auto image = images.find(layer.id);
        if (image == images.end() || image->second.width == 0) {
            layer.image.clear();
            continue;
        }
        char name[64];
        std::snprintf(name, sizeof name, ".paint_%u_%016llx.png", layer.id,
                      static_cast<unsigned long long>(hashOf(image->second.flat())));
        layer.image = file.stem().string() + name;
        layer.size = std::max(image->second.width, image->second.height);
        const fs::path path = file.parent_path() / layer.image;
        std::error_code ignored;
        if (fs::exists(path, ignored)) continue;
        const fs::path fresh = file.parent_path() / (".new_" + layer.image);
        if (!fwimport::writePicture(fresh, pictureOf(image->second), error)) return false;
        std::ifstream stream(fresh, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
        fs::remove(fresh, ignored);
        if (!replaceFile(path, bytes, error)) return false;
    }
    return true;
}

bool writeScene(Scene& scene, const Document& document, const fs::path& file, std::string& error) {
    std::error_code code;
    const fs::path folder = folderOf(file);
    fs::create_directories(folder, code);
    rebaseScene(scene, baseFolder(document), folder);
    const fs::path whole = folder / file.filename();
    return savePictures(scene, document.images, whole, error) &&
           replaceFile(whole, printScene(scene), error);
}

void readPictures(Document& document, std::vector<std::string>& repairs) {
    for (size_t i = 0; i < document.scene.layers.size(); ++i) {
        PaintLayer& layer = document.scene.layers[i];
        if (layer.image.empty()) continue;
        const std::string where =
            document.file.filename().string() + ": layers[" + std::to_string(i) + "].image: ";
        fwimport::FloatPicture picture;
        std::string error;
        const fs::path path = folderOf(document.file) / layer.image;
        if (!fwimport::readPicture(path, picture, error)) {
            repairs.push_back(where + error + " The layer is empty now.");
            continue;
        }
        if (picture.width > 4096 || picture.height > 4096) {
            repairs.push_back(where + path.string() + " has " + std::to_string(picture.width) +
                              " x " + std::to_string(picture.height) +
                              " px, above 4096; the layer is empty now.");
            continue;
        }
        std::vector<uint8_t> values;
        for (size_t at = 0; at < picture.values.size(); at += picture.channels)
            values.push_back(static_cast<uint8_t>(
                std::lround(std::clamp(picture.values[at], 0.0f, 1.0f) * 255.0f)));
        document.images[layer.id] = paintImageOf(layer.kind, picture.width, picture.height, values);
    }
}

}  // namespace

fs::path baseFolder(const Document& document) {
    std::error_code ignored;
    if (!document.file.empty()) return folderOf(document.file);
    return document.folder.empty() ? fs::current_path(ignored)
                                   : fs::absolute(document.folder, ignored);
}

bool openDocument(const fs::path& file, Document& document, std::vector<std::string>& repairs,
                  std::string& error) {
    std::error_code code;
    if (fs::is_directory(file, code)) {
        error = file.string() + " was not opened: it is a folder.";
        return false;
    }
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        error = file.string() + " was not opened: it cannot be read.";
        return false;
    }
    const auto bytes = fs::file_size(file, code);
    if (!code && bytes > (uintmax_t{16} << 20)) {
        error = file.string() + " was not opened: it has " + std::to_string(bytes) +
                " bytes, above 16777216.";
        return false;
    }
    const std::string text((std::istreambuf_iterator<char>(stream)), {});
    Document fresh;
    if (!readScene(text, file.filename().string(), fresh.scene, repairs, error)) return false;
    fresh.file = file;
    fresh.folder = document.folder;
    fresh.surface = document.surface;
    fresh.nodePose = document.nodePose;
    readPictures(fresh, repairs);
    resetHistory(fresh);
    fresh.revision = document.revision + 1;
    // The file does not have the repairs yet.
    if (!repairs.empty()) fresh.saved = ~size_t{0};
    document = std::move(fresh);
    return true;
}

bool saveCopy(const Document& document, const fs::path& file, std::string& error) {
    Scene scene = document.scene;
    if (!writeScene(scene, document, file, error)) return false;
    // Remove images of the previous copy that the new one does not use.
    std::set<std::string> kept;
    for (const PaintLayer& layer : scene.layers) kept.insert(layer.image);
    const std::string own = file.stem().string() + ".paint_";
    std::vector<fs::path> gone;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folderOf(file), ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(own) && !kept.contains(name)) gone.push_back(entry.path());
    }
    for (const fs::path& picture : gone) fs::remove(picture, ignored);
    return true;
}

bool openCopy(const fs::path& copy, const fs::path& original, Document& document,
              std::vector<std::string>& repairs, std::string& error) {
    if (!openDocument(copy, document, repairs, error)) return false;
    document.file = original;
    const fs::path from = folderOf(copy), to = baseFolder(document);
    changeEverywhere(document, [&](Scene& step) { rebaseScene(step, from, to); });
    document.saved = ~size_t{0};
    return true;
}

bool saveDocument(Document& document, const fs::path& file, std::string& error) {
    endDrag(document);
    Scene scene = document.scene;
    if (!writeScene(scene, document, file, error)) return false;

    // The history must refer to the same files: paths relative to the new folder, and the layer
    // images that were just written.
    std::error_code code;
    const fs::path from = baseFolder(document);
    const fs::path to = folderOf(file);
    std::set<std::string> before, kept;
    for (const PaintLayer& layer : document.scene.layers) before.insert(layer.image);
    const std::vector<PaintLayer> written = scene.layers;
    for (const PaintLayer& layer : written) kept.insert(layer.image);
    changeEverywhere(document, [&](Scene& step) {
        rebaseScene(step, from, to);
        for (PaintLayer& layer : step.layers)
            if (const PaintLayer* now = findIn(written, layer.id)) {
                layer.image = now->image;
                layer.size = now->size;
            }
    });
    // Remove our images that the file no longer uses.
    if (from == to && document.file.stem() == file.stem())
        for (const std::string& image : before)
            if (!image.empty() && !kept.contains(image) &&
                image.rfind(file.stem().string() + ".paint_", 0) == 0)
                fs::remove(to / image, code);
    document.file = file;
    document.saved = document.at;
    return true;
}

}  // namespace fwedit
