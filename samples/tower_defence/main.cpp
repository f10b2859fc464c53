// The tower-defence slice: a village, a wave of straw men, one flamethrower tower, and the wind.
#include <cstdio>
#include <memory>

#include "common/progress.h"
#include "common/stage.h"
#include "renderer.h"

int main(int argc, char** argv) {
    return sample::guardedMain("tower_defence", [&] {
        sample::OptionParser parser("tower_defence", "a village under attack, and on fire");
        std::string lightName = "golden";
        parser.addText("--light", "golden|noon|night", "time of day", lightName);
        sample::Options options;
        options.width = 1280;
        options.height = 720;
        if (!parser.parse(argc, argv, options)) return 0;
        const tower::Daylight light = lightName == "night"  ? tower::moonlight()
                                      : lightName == "noon" ? tower::noon()
                                                            : tower::goldenHour();
        const village::Scene scene = village::makeVillage(options.seed);
        const tower::PaintedVillage painted = tower::paintVillage(scene);
        sample::ValidationLog log;
        {
            sample::HostRequest request;
            request.windowed = !options.headless;
            if (options.validate) request.validation = &log;
            sample::VulkanHost host(request);
            sample::StageRequest stageRequest;
            stageRequest.exposure = light.exposure * 1.62f;
            stageRequest.vignette = 0.3f;
            sample::Stage stage(host, options, stageRequest, options.frames ? options.frames : 3);
            tower::Renderer renderer(host, stage, scene, painted);
            std::vector<tower::Placed> placed;
            for (const village::Instance& i : scene.instances)
                placed.push_back({i.model, i.frame, i.tint, true, i.roadMetres >= 0});
            sample::Camera camera;
            camera.eye = {-1.5f, 36.0f, 33.4f};
            camera.target = {-1.5f, 0.2f, -2.9f};
            camera.fieldOfView = glm::radians(29.0f);
            camera.nearPlane = 5;
            camera.farPlane = 140;
            stage.onPicture = [&](uint32_t n, sample::Picture&& picture) {
                char name[32];
                std::snprintf(name, sizeof name, "frame_%04u.png", n);
                sample::writePng(options.out / name, picture);
            };
            tower::Jet jet(1);
            sample::StageFrame frame;
            while (stage.next(frame)) {
                for (int i = 0; i < 30 && frame.number == 0; ++i)
                    jet.advance(1 / 30.0f, {-.5f, 3, 6.5f},
                                glm::normalize(glm::vec3(-.6f, -.15f, .5f)), {-3, 0, -1}, true);
                jet.advance(frame.deltaTime, {-.5f, 3, 6.5f},
                            glm::normalize(glm::vec3(-.6f, -.15f, .5f)), {-3, 0, -1}, true);
                tower::SceneFrame sceneFrame{
                    camera,
                    light,
                    placed,
                    {},
                    jet.billboards(glm::normalize(camera.target - camera.eye))};
                renderer.prepare(frame, sceneFrame);
                stage.beginScene(frame);
                renderer.drawSolid(frame);
                renderer.drawJet(frame);
                stage.endScene(frame);
                stage.finish(frame);
            }
        }
        return log.exitCode();
    });
}
