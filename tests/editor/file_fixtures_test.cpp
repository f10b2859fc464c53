// Scenes of tests/fixtures load without repairs and hold the values with which they were written.
#include "document/document.h"

#include <gmock/gmock.h>

#include "editor/text_of.h"
#include "support/paths.h"

namespace {

using namespace fwedit;

Scene sceneOf(const char* name) {
    const std::string path = std::string(fw::test::kTestFolder) + "/fixtures/" + name;
    Scene scene;
    std::vector<std::string> repairs;
    std::string error;
    EXPECT_TRUE(readScene(textOf(path), name, scene, repairs, error)) << error;
    EXPECT_THAT(repairs, ::testing::IsEmpty());
    return scene;
}

TEST(FileFixtures, SceneLoads) {
    const Scene scene = sceneOf("yard.fwscene");
    EXPECT_EQ(9u, scene.nextId);
    EXPECT_EQ(30, scene.settings.pace);
    ASSERT_EQ(1u, scene.meshes.size());
    EXPECT_EQ("box.glb", scene.meshes[0].file);
    ASSERT_EQ(1u, scene.sources.size());
    EXPECT_FLOAT_EQ(0.2f, float(scene.sources[0].radius));
    ASSERT_EQ(1u, scene.flames.size());
    EXPECT_EQ("Campfire", scene.flames[0].name);
    ASSERT_EQ(1u, scene.emitters.size());
    ASSERT_EQ(1u, scene.winds.size());
    ASSERT_EQ(1u, scene.colliders.size());
    ASSERT_EQ(1u, scene.layers.size());
    EXPECT_EQ(1u, scene.layers[0].mesh);
    ASSERT_EQ(1u, scene.events.size());
}

TEST(FileFixtures, SceneOfVersion1Loads) {
    const Scene scene = sceneOf("crate_version1.fwscene");
    EXPECT_EQ(4u, scene.nextId);
    EXPECT_EQ(12, scene.settings.pace);
    ASSERT_EQ(1u, scene.meshes.size());
    EXPECT_EQ("Crate", scene.meshes[0].name);
    ASSERT_EQ(1u, scene.winds.size());
    EXPECT_EQ(3u, scene.winds[0].keys.size());
}

}  // namespace
