// A host with its own Vulkan device and render pass. It draws the room before the plugin and stone
// blocks after it, in one pass. The switches cover the ways in which engines differ: secondary
// command buffers, MSAA, depth, encoding, pacing, split screens.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "common/filming.h"
#include "common/fire_host.h"
#include "common/studio.h"
#include "common/turntable.h"
#include "crate.h"

namespace {

struct Switches {
    bool secondary = false, msaa = false, reversed = false, slotPacing = false, blocks = true;
    bool split = false;
    std::string target = "linear";
    float wind[3] = {1.6f, 0.0f, 0.3f};  // m/s
    float pace = 60.0f;
};

VkFormat formatOf(const std::string& target) {
    if (target == "linear") return VK_FORMAT_R16G16B16A16_SFLOAT;
    if (target == "srgb") return VK_FORMAT_R8G8B8A8_SRGB;
    if (target == "unorm") return VK_FORMAT_R8G8B8A8_UNORM;
    throw sample::Failure("--target is \"" + target + "\"; it takes linear, srgb or unorm");
}

void loadCrate(sample::FireHost& fire, const CrateMesh& crate) {
    FwMeshDef meshDef = fwDefaultMeshDef();
    meshDef.positions = crate.positions.data();
    meshDef.normals = crate.normals.data();
    meshDef.details = crate.details.data();
    meshDef.colors = crate.colors.data();
    meshDef.vertexCount = static_cast<uint32_t>(crate.positions.size() / 3);
    meshDef.indices = crate.indices.data();
    meshDef.indexCount = static_cast<uint32_t>(crate.indices.size());
    meshDef.mapSize = 1024;
    meshDef.texelsPerMetre = 256.0f;
    FwBurnableMeshDef def = fwDefaultBurnableMeshDef();
    fire.check(fwWorld_CreateMesh(fire.world, &meshDef, &def.mesh), "fwWorld_CreateMesh");
    FwMaterialDef pine = fwDefaultMaterialDef();
    fire.check(fwInitMaterialPreset(&pine, FW_MATERIAL_PINE), "fwInitMaterialPreset");
    fire.check(fwWorld_CreateMaterial(fire.world, &pine, &def.materials[0]),
               "fwWorld_CreateMaterial");
    FwBurnableMeshId id{};
    fire.check(fwWorld_CreateBurnableMesh(fire.world, &def, &id), "fwWorld_CreateBurnableMesh");
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.object = id;
    match.position[0] = -0.26f;
    match.position[1] = 0.06f;
    match.position[2] = 0.30f;
    match.radius = 0.03f;
    fire.check(fwWorld_Ignite(fire.world, &match, nullptr), "fwWorld_Ignite");
}

// A part of the frame and its camera.
struct Player {
    FwView view;
    sample::StageFrame frame;
    std::unique_ptr<sample::Studio> studio;  // holds one camera per frame
};

// Lets two players view the crate from opposite sides.
void look(std::vector<Player>& players, const sample::Turntable& table,
          const sample::StageFrame& frame, bool reversed) {
    const auto count = static_cast<uint32_t>(players.size());
    for (uint32_t i = 0; i < count; ++i) {
        Player& player = players[i];
        player.frame = frame;
        player.frame.extent.width = frame.extent.width / count;
        player.frame.viewport.width = static_cast<float>(player.frame.extent.width);
        player.frame.viewport.x = player.frame.viewport.width * static_cast<float>(i);
        player.view = table.view;
        player.view.viewId = i;
        sample::OrbitCamera orbit = table.orbit;
        orbit.yaw += 0.9f * static_cast<float>(i);
        sample::setCamera(player.view, orbit.camera(), player.frame, reversed);
    }
}

int run(const sample::Options& options, const Switches& switches) {
    sample::ValidationLog validation;
    {
        // The engine's part: instance, device, window or pictures, render pass.
        const sample::VulkanHost host(sample::hostRequest(options, validation));
        sample::StageRequest stageRequest;
        stageRequest.title = "Flamewright: host device";
        stageRequest.colorFormat = formatOf(switches.target);
        stageRequest.samples = switches.msaa ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
        stageRequest.reversedDepth = switches.reversed;
        const uint32_t frames = sample::framesOf(options, 96 / options.fps);
        sample::Stage stage(host, options, stageRequest, frames);
        std::vector<Player> players(switches.split ? 2 : 1);
        for (Player& player : players) {
            player.studio = std::make_unique<sample::Studio>(host, stage, glm::vec3(0, 0, 0), 0.7f);
            player.studio->addBlock({0.40f, 0.055f, 0.48f}, {0.13f, 0.055f, 0.08f});
            player.studio->addBlock({0.44f, 0.145f, 0.47f}, {0.07f, 0.035f, 0.06f});
        }

        // The plugin's part: pass the device, describe the render pass, fill the world.
        FwWorldDef worldDef = fwDefaultWorldDef();
        worldDef.paceFactor = switches.pace;
        worldDef.seed = options.seed;
        for (int i = 0; i < 3; ++i) worldDef.wind[i] = switches.wind[i];
        sample::FireHost fire(host, worldDef);
        fire.slotPacing = switches.slotPacing;
        fire.registerTarget(stage);
        const CrateMesh crate = makeCrate(0.6f);
        loadCrate(fire, crate);

        sample::Turntable table(stage, {.target = {0.0f, 0.27f, 0.0f},
                                        .distance = 2.4f,
                                        .yaw = -0.45f,
                                        .pitch = 0.28f,
                                        .fieldOfView = 0.5f});
        const float* sun = table.view.sunDirection;
        for (Player& player : players)
            player.studio->castShadow(crate.positions, crate.indices, glm::mat4(1.0f),
                                      {sun[0], sun[1], sun[2]});

        sample::Filming filming(stage, options, {.name = "host_device"});

        sample::StageFrame frame;
        while (table.next(frame)) {
            FwLight lights[8];
            const uint32_t lightCount = fwWorld_GetLights(fire.world, lights, 8);

            look(players, table, frame, stage.made.reversedDepth);
            std::vector<FwView> views;
            for (const Player& player : players) views.push_back(player.view);
            const auto draw = [&](VkCommandBuffer secondary) {
                const VkCommandBuffer commands = secondary ? secondary : frame.commands;
                const VkRect2D whole{{0, 0}, frame.extent};
                for (const Player& player : players) {
                    vkCmdSetViewport(commands, 0, 1, &player.frame.viewport);
                    vkCmdSetScissor(commands, 0, 1, &whole);
                    player.studio->draw(player.frame, commands, player.view, {lights, lightCount});
                    fire.recordInside(player.frame, player.view, secondary);
                    if (switches.blocks) player.studio->drawBlocks(player.frame, commands);
                }
            };

            // Outside any pass the plugin simulates. Inside: room, fire, stones.
            if (switches.secondary) {
                VkCommandBuffer outside = stage.beginSecondary(frame, false);
                fire.recordOutside(frame, views, outside);
                stage.executeSecondary(frame, outside);
                stage.beginScene(frame, true);
                VkCommandBuffer inside = stage.beginSecondary(frame, true);
                draw(inside);
                stage.executeSecondary(frame, inside);
            } else {
                fire.recordOutside(frame, views);
                stage.beginScene(frame);
                draw(VK_NULL_HANDLE);
            }
            stage.endScene(frame);
            stage.finish(frame);
        }

        if (options.headless) {
            sample::Summary summary;
            summary.title = "A burning crate on the host's device";
            summary.rows = {
                {"device", host.properties.deviceName},
                {"target", switches.target + (switches.msaa ? ", 4 samples" : "") +
                               (switches.reversed ? ", reversed depth" : "")},
                {"size", std::to_string(options.width) + " x " + std::to_string(options.height) +
                             ", " + std::to_string(frames) + " frames"},
                {"time", std::to_string(std::lround(filming.seconds())) + " s"}};
            filming.finish(summary, fire);
        }
    }
    return validation.exitCode();
}

}  // namespace

int main(int argc, char** argv) {
    return sample::guardedMain("01_host_device", [&] {
        sample::Options options;
        options.fps = 12.0;
        Switches switches;
        sample::OptionParser parser("01_host_device", "a crate burns in an engine's render pass");
        parser.addFlag("--secondary", "record into secondary command buffers", switches.secondary);
        parser.addFlag("--msaa", "four samples", switches.msaa);
        parser.addFlag("--reversed", "reversed depth", switches.reversed);
        parser.addFlag("--slot-pacing", "pace by slot, not by completed frame",
                       switches.slotPacing);
        parser.addText("--target", "NAME", "linear, srgb or unorm", switches.target);
        parser.addFlag("--split", "two views side by side, one recording", switches.split);
        parser.addVector("--wind", "m/s", switches.wind);
        parser.addNumber("--pace", "how many times faster than wood it burns", switches.pace, 0.1f,
                         1000.0f);
        if (!parser.parse(argc, argv, options)) return 0;
        if (options.list) {
            std::printf("one scene: a crate, wind from the left, stones before it\n");
            return 0;
        }
        return run(options, switches);
    });
}
