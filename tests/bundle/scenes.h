// Scenes of flamewright-check: small ones whose burn every machine must agree on, and larger ones
// whose passes are timed. All through the C interface, on the cpu backend or an own device.
#pragma once
#include <flamewright/flamewright.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace fw::bundle {

// A context and a world with what burns in it. Throws std::runtime_error with the library's
// message.
class Scene {
 public:
    Scene(uint32_t backend, const FwWorldDef& def);
    ~Scene();
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    // The host's commands of a frame, then the frame of `seconds`.
    void advance(float seconds);
    // Over the ignition ticks and the heat of all objects, in the order of their creation.
    uint64_t burnHash();
    [[nodiscard]] uint32_t ignitedTexels() const;
    [[nodiscard]] FwView view(float aspect) const;

    FwMaterialId addMaterial(uint32_t preset) const;
    // `def`: everything but the mesh; returns the object, which counts in the hash.
    FwBurnableMeshId addObject(FwMeshId mesh, FwBurnableMeshDef def);
    void ball(uint32_t kind, float x, float y, float z, float radius) const;

    FwContext* context = nullptr;
    FwWorld* world = nullptr;
    std::vector<FwBurnableMeshId> objects;
    std::function<void(uint32_t frame)> commands = [](uint32_t) {};
    float eye[3] = {0, 2, 6}, target[3] = {0, 1, 0}, zoom = 2;

 private:
    uint32_t frame_ = 0;
    float time_ = 0;  // s
};

struct BurnHash {
    std::string scene;
    double seconds = 0;    // of the world
    uint32_t ignited = 0;  // texels that burn or have burnt
    uint64_t hash = 0;
};
// Burns the small scenes. `device`: FwContextInfo::deviceName.
std::vector<BurnHash> burnHashes(uint32_t backend, std::string& device);

struct TimedScene {
    const char *name, *title;
    std::unique_ptr<Scene> (*make)();
    float seconds;  // burnt before the first frame that counts
};
std::span<const TimedScene> timedScenes();

}  // namespace fw::bundle
