// Runs every pass and shader once on buffers of exact size. Under GPU-assisted validation
// (tests/run --gpu-assisted) each access past an end is reported, which the second test proves.
// Without it a software device would not notice.
#include "components/exchange_object.h"
#include "components/heat_occlusion.h"
#include "components/particle_field.h"
#include "components/sparks.h"
#include "components/volumetric_fire.h"
#include "flamewright_reference.h"
#include "flipbook/own.h"
#include "flipbook/picture.h"
#include "gpu/passes/pass.h"
#include "shared/front.h"
#include "shared/spark.h"
#include "support/burn_scene.h"
#include "support/particle_reference.h"

#include <algorithm>
#include <set>
#include <string_view>

namespace fw::test::every_pass_test {
namespace {

constexpr uint32_t kSide = 48;  // px
constexpr std::string_view kReferencePasses[] = {"published", "skin", "refine_pattern"};

class EveryPass : public GpuTest {
 protected:
    // A small box whose faces are charts with seams: a receding object of the deform model, or the
    // reference refinement with vertices moved by the host.
    static const BurnScene& scene(bool published) {
        static const BurnScene scenes[2] = {makeScene(false), makeScene(true)};
        return scenes[published ? 1 : 0];
    }
    static BurnScene makeScene(bool published) {
        BurnScene scene;
        Mesh box = makeCube(0.5, 2, false, true);
        addTag(box);
        mesh::BakeInput input = box.input(24, 256);
        input.trustUvs = true;
        scene.domains.push_back(mesh::bake(input, std::pmr::get_default_resource()));
        SceneObject object;
        object.substepShift = 1;
        if (published) object.flags = gpu::kObjectExtended | gpu::kObjectSkinned;
        object.refine = !published;
        object.refinePixelsPerEdge = 2;  // its holes are cut
        const mesh::BurnDomain& domain = scene.domains[0];
        for (uint32_t m = 0; m < gpu::kMaterialsPerObject; ++m) {
            object.materials[m] = plainMaterial(domain, 0.3, 1.0, 1.0);
            object.materials[m].appearance =
                FW_MATERIAL_POLYESTER;  // all material families, including plants
            object.materials[m].baseColor = {0.8f, 0.4f, 0.2f, 900};
            object.materials[m].holeTicks = 300;  // pieces fall
        }
        object.materials[1].appearance = FW_MATERIAL_THATCH;
        object.materials[2].appearance = FW_MATERIAL_PINE;
        object.slowness.assign(domain.slowness.begin(), domain.slowness.end());
        scene.models.push_back(mesh::makeDeformModel(domain, std::pmr::get_default_resource()));
        if (!published) {
            object.deform.flags = gpu::kDeformRecede;
            for (gpu::DeformMaterial& m : object.deform.materials)
                m = gpu::DeformMaterial{4096, 0.01f, 0, 0, 8192, 2, 0, 0};
            object.deform.wall = 0.05f;  // with an inner skin
        }
        scene.objects.push_back(object);
        if (published) {  // and a refined object with one
            object.flags = gpu::kObjectExtended;
            object.reference = true;
            scene.objects.push_back(object);
            scene.refineByReference();
            return scene;
        }
        object.deform.flags = gpu::kDeformShell;
        object.deform.wall = 0;
        object.deform.pinCount = 1;
        object.deform.pins[0] = {0.25f, 0.25f, 0.25f, 0.1f};
        object.deform.pins[1] = {-0.25f, 0.25f, 0.25f, 0};
        scene.objects.push_back(object);
        object.deform.flags = gpu::kDeformExtended;
        object.flags |= gpu::kObjectDepthFirst;
        scene.objects.push_back(object);
        if (!published) scene.addHeat();
        return scene;
    }

    // The box and its fire, without deformation or refinement.
    static const BurnScene& plainScene() {
        static const BurnScene plain = [] {
            BurnScene scene = makeScene(false);
            scene.objects.resize(1);
            scene.models.clear();
            scene.objects[0].deform = {};
            scene.objects[0].refine = false;
            return scene;
        }();
        return plain;
    }

    // A separate part one centimetre from a face.
    static void addTag(Mesh& box) {
        float right = 0;
        for (size_t i = 0; i < box.uvs.size(); i += 2) right = std::max(right, box.uvs[i]);
        const uint32_t base = box.vertexCount();
        for (uint32_t i = 0; i < 4; ++i) {
            const double u = 0.1 * (i & 1), v = 0.1 * (i >> 1);
            box.addVertex(u, v, 0.26, double(right) + 0.1 + u, v);
        }
        box.addTriangle(base, base + 1, base + 2);
        box.addTriangle(base + 2, base + 1, base + 3);
    }

    void makeRig(uint32_t shortBinding, bool published) {
        gpu::vk::WorldLimits limits;
        limits.appearances = testAppearances();
        limits.exactBuffers = true;
        limits.maxFlames = 64;  // fewer than the scene needs
        limits.maxLights = 4;
        limits.maxRefinedTriangles = 500;  // fewer than the scene needs
        rig_ = std::make_unique<VkRig>(
            *device_, 2, 0, limits,
            shortBinding != kNoBinding ? shorteningEntry(shortBinding)
            : published ? fewTexelsEntry()  // then passes read words instead of texels
                        : nullptr);
        scene_ = shortBinding != kNoBinding ? &plainScene() : &scene(published);
        scene_->create(rig_->backend);
        rig_->backend.setRoom(
            0, {1u << 16, 1u << 20, gpu::kAirOutside, 1, /*flashes*/ 1u << 20, 0, 0, 0});
        if (shortBinding == kNoBinding) makeTargets();  // otherwise nothing is drawn
        const float eye[3] = {0.9f, 0.7f, 1.1f}, at[3] = {0, 0, 0};
        rig_->view = testView(eye, at, 40, 1, false);
        if (published) makeVertices();
        FwVolumetricFireDef fire = fwDefaultVolumetricFireDef();
        flames_[0] = flameAlone(fire, 1);
        components::setFirePreset(fire, FW_FIRE_CANDLE);  // the camera is outside it
        flames_[1] = flameAlone(fire, 1);
        flames_[0].record.tier = FW_FIRE_TIER_MARCH_HIGH;
        flames_[1].record.tier = FW_FIRE_TIER_IMPOSTOR;
        flames_[1].record.key = 1;
        flames_[2] = flames_[1];
        flames_[2].record.tier = FW_FIRE_TIER_SLICES;
        flames_[2].record.key = 2;
        flames_[3] = flames_[1];
        flames_[3].record.tier = FW_FIRE_TIER_SHARED_IMPOSTOR;
        flames_[3].record.key = 3;
        FwFireEmitterDef jet = fwDefaultFireEmitterDef();
        jet.flags = FW_EMITTER_JET | FW_EMITTER_GROUND;
        jet.power = 20;
        jet.ground = -0.3f;
        jet.sparks = 1;
        emitter_ = std::make_unique<ParticleReference>(jet);
        if (!published) {
            makeField(0, field::FieldPreset::Fire, 0);
            makeField(1, field::FieldPreset::Smoke, 0);
            makeField(2, field::FieldPreset::Water, gpu::kFieldDisplaced);
        }
        fieldStep_ = 0;
        now_ = 4096;
        index_ = 0;
        passes_.clear();
    }

    void makeTargets() {
        FwVulkanTargetDef def = fwDefaultVulkanTargetDef();
        def.flags = FW_TARGET_COMPOSITE | FW_TARGET_AS_NEEDED;
        def.colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  // linear, otherwise slices do not show
        def.depthFormat = VK_FORMAT_D32_SFLOAT;
        target_ = rig_->context.registerTarget(def);
        def.flags |= FW_TARGET_HAZE | FW_TARGET_TRANSPARENCY;
        def.depthMode = FW_DEPTH_SAMPLED;
        hazeTarget_ = rig_->context.registerTarget(def);
        def.flags |= FW_TARGET_HALF_EFFECTS;
        halfTarget_ = rig_->context.registerTarget(def);
        behind_ = device_->makeImage(def.colorFormat, {kSide, kSide}, 1,
                                     VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        color_ = device_->makeImage(
            def.colorFormat, {kSide, kSide}, 1,
            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
        depth_ =
            device_->makeImage(def.depthFormat, {kSide, kSide}, 1,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                   VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    }

    // The last one is far away, the others lie side by side.
    void makeField(uint32_t slot, field::FieldPreset preset, uint32_t shape) {
        FwParticleFieldDef def = fwDefaultParticleFieldDef();
        components::setFieldPreset(def, uint32_t(preset));
        def.shape = shape;
        def.width = 36;
        def.height = 47;
        def.position[0] = 0.2f * float(slot);
        components::ParticleField field(std::pmr::get_default_resource());
        components::makeParticleField(def, 1, field);
        field.masks[40] = gpu::kFieldWall;
        const float wind[3] = {1, 0, 0};
        rig_->backend.createField(slot, components::rulesOf(field, wind), field.masks);
        fieldDraws_[slot] = components::fieldDraw(field, 0, 0, 0);
    }

    // The box's vertices in the host's buffer: slightly larger, in a buffer without a spare word.
    void makeVertices() {
        const mesh::BurnDomain& domain = scene_->domains[0];
        std::vector<float> places(domain.report.vertices * 3);
        for (size_t i = 0; i < domain.vertices.size(); ++i)
            for (size_t c = 0; c < 3; ++c)
                places[domain.sources[i] * 3 + c] = 1.1f * domain.vertices[i].position[c];
        vertices_ =
            device_->makeBuffer(places.size() * sizeof(float), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        std::copy(places.begin(), places.end(), static_cast<float*>(vertices_.mapped));
    }
    void moveVertices() {
        if (!vertices_.buffer) return;
        FwVulkanVertices vertices{};
        vertices.vertexCount = scene_->domains[0].report.vertices;
        vertices.buffer = vertices_.buffer;
        vertices.stride = 12;
        vertices.stageBefore = VK_PIPELINE_STAGE_HOST_BIT;
        vertices.accessBefore = VK_ACCESS_HOST_WRITE_BIT;
        vertices.stageAfter = VK_PIPELINE_STAGE_HOST_BIT;
        vertices.accessAfter = VK_ACCESS_HOST_WRITE_BIT;
        rig_->backend.setVertexBuffer(0, vertices, 1);
    }

    void texels(std::vector<gpu::TexelEvent>& out, uint32_t kind, uint32_t every) {
        const mesh::BurnDomain& domain = scene_->domains[0];
        for (uint32_t object = 0; object < scene_->objects.size(); ++object)
            for (uint32_t i = 0; i < domain.texelCount(); i += every)
                if (domain.real(i) || every == 1)
                    out.push_back({object, i, kind, now_ + 1 + i % 100});
    }

    struct Frame {
        uint32_t kind = 0, every = 0;  // events on every `every`-th texel; 0: none
        uint32_t steps = 2, switches = 0;
        bool latch = false, probes = false, draw = true, exchange = false;
        bool effects = true;  // flames, particles and fields
        bool whole = false;   // one more event for all texels of each object
    };
    // The box as its own neighbour: it radiates to itself, touches itself and throws embers at
    // itself.
    void placeBox() {
        placed_.object = 0;
        components::placeExchangeObject({}, scene_->domains[0], placed_.record);
        gpu::ExchangeObject& o = placed_.record;
        o.flags = gpu::kExchangeLive | gpu::kExchangeGives | gpu::kExchangeTwoSided;
        o.power0 = o.power1 = {16000, 16000, 16000, 16000};
        o.chance = gpu::kChanceOne;
        o.hopsMost = o.lifeTicks = o.maxTiles = gpu::kNoneTexel;
        o.catches = 256;
        o.texelArea = 1700;
        o.neighbourCount = 1;
        links_.clear();
        for (uint32_t i = 0; i < scene_->domains[0].texelCount(); i += 3)
            links_.push_back({0, i, 0, scene_->domains[0].texelCount() - 1 - i, 100, 0, 0, 0});
        occluder_.size = {10, 10, 10, 1};
        exchange_.objects = {&placed_, 1};
        exchange_.neighbours = {&self_, 1};
        exchange_.neighbourRanges = {&selfRange_, 1};
        exchange_.links = links_;
        linkRange_ = {0, uint32_t(links_.size())};
        exchange_.linkRanges = {&linkRange_, 1};
        exchange_.occluders = {&occluder_, 1};
        // Its faces occlude each other, and so does a wall of the host's.
        components::HeatOcclusion grid(std::pmr::get_default_resource());
        grid.shape.counts = {24, 24, 24};
        grid.shape.origin = {-600, -600, -600};
        grid.shape.cell = 50;
        grid.solid.assign(grid.shape.words(), 0);
        grid.solid.front() = 0xFFFFFFu;
        const components::OcclusionObject walls{0, &scene_->domains[0], o, 40, 0};
        components::bakeOcclusion(grid.shape, {&walls, 1}, grid.baked);
        components::packOcclusion(grid, occlusionWords_);
        occlusion_.origin = {grid.shape.origin[0], grid.shape.origin[1], grid.shape.origin[2]};
        occlusion_.cell = grid.shape.cell;
        occlusion_.counts = components::countsOf(grid.shape);
        occlusion_.words = occlusionWords_;
    }
    void frame(const Frame& what) {
        std::vector<gpu::StepPlan> steps(what.steps);
        std::vector<gpu::TexelEvent> events;
        if (what.every) texels(events, what.kind, what.every);
        for (uint32_t object = 0; what.whole && object < scene_->objects.size(); ++object)
            events.push_back({object, gpu::kNoneTexel, what.kind, now_ + 1});
        gpu::MaterialUpdate update{};
        update.window = scene_->objects[0].window;
        update.substepShift = scene_->objects[0].substepShift;
        std::copy(scene_->objects[0].materials.begin(), scene_->objects[0].materials.end(),
                  std::begin(update.materials));
        for (gpu::BurnMaterial& material : update.materials) material.driveX = 400;
        for (gpu::StepPlan& step : steps) {
            step.now = now_;
            step.substepShift = scene_->objects[0].substepShift;
            step.reduce = true;
            step.heat = true;
            step.rooms = what.exchange;
            if (&step == steps.data()) {
                step.events = events;
                if (what.latch) step.materials = {&update, 1};
                if (what.exchange) step.exchangeUpdate = &exchange_;
            }
            // Without it up to that step.
            if (what.exchange && &step == &steps[what.steps / 2])
                step.occlusionUpdate = &occlusion_;
            if (what.exchange) {
                step.exchange = step.governed = step.capped = true;
                step.rules.flags = 15;
                step.rules.warms = 1;
                step.rules.upY = 4096;
                step.rules.chance = gpu::kChanceOne;
                step.rules.hopsMost = step.rules.lifeTicks = gpu::kNoneTexel;
                step.rules.maxTiles = 40;  // fewer than would burn
                step.rules.brands = 0xFFFFFFFFu;
            }
            now_ += gpu::kStepTicks;
        }
        std::vector<gpu::Probe> probes;
        if (what.probes)
            for (uint32_t i = 0; i < scene_->domains[0].texelCount(); ++i) probes.push_back({0, i});
        const uint32_t map = 0;
        gpu::FramePlan plan;
        plan.frameIndex = ++index_;
        plan.steps = steps;
        plan.probes = probes;
        if (what.probes) plan.burnMaps = {&map, 1};
        flames_[4] = flames_[0];  // as the fire of an object
        ++flames_[4].record.key;
        const mesh::BurnDomain& domain = scene_->domains[0];
        gpu::FlameBody body{};
        body.low = {domain.boundsLow[0], domain.boundsLow[1], domain.boundsLow[2],
                    domain.flameCellSide};
        body.cells = domain.flameCellCount;
        const gpu::VolumeUpdate volumes{flames_, 5, &body, 1};
        if (what.effects) plan.volumes = &volumes;
        const gpu::uvec2 group(0, 0);
        gpu::EmitterUpdate emitters;
        gpu::SparkSource sparks[2];
        if (emitter_->step(0.2f)) {
            emitters.records = &emitter_->record;
            emitters.count = 1;
            emitters.groups = {&group, 1};
            emitters.particleEnd = emitters.particles = emitter_->record.ring;
            components::settleSparks(emitter_->emitter, emitter_->air.now);
            ASSERT_TRUE(
                components::advanceSparks(emitter_->emitter, emitter_->air, 0.2f, sparks[0]));
            sparks[1] = sparks[0];
            sparks[1].object = 1;  // those of its tiles too
            emitters.sparks = sparks;
            emitters.sparkCount = 2;
            emitters.sparkQuads = 20;  // fewer than there are
        }
        if (what.effects) plan.emitters = &emitters;
        std::vector<gpu::FieldRun> runs;
        for (uint32_t i = 0; !scene_->refinesByReference && i < 3; ++i)
            runs.push_back({i, fieldStep_});
        const uint32_t rounds[] = {uint32_t(runs.size())}, drawn[] = {0, 1, 2};
        ++fieldStep_;
        gpu::FieldUpdate fields;
        fields.runs = runs;
        fields.rounds = rounds;
        if (!runs.empty()) fields.draws = fieldDraws_, fields.drawn = drawn;
        if (what.effects) plan.fields = &fields;
        plan.switches = what.switches;
        plan.endTick = now_;
        moveVertices();
        rig_->alsoRecord = [&](const FwVulkanFrame& host) {
            if (what.draw) draw(host);
        };
        rig_->run(plan);
        for (const gpu::PassTime& time : rig_->backend.passTimes())
            if (time.count) passes_.insert(time.name);
    }

    void draw(const FwVulkanFrame& frame) {
        const VkCommandBuffer commands = frame.commandBuffer;
        VkImageMemoryBarrier barriers[3]{};
        for (uint32_t i = 0; i < 3; ++i) {
            barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
            barriers[i].dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
            barriers[i].newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            barriers[i].srcQueueFamilyIndex = barriers[i].dstQueueFamilyIndex =
                VK_QUEUE_FAMILY_IGNORED;
            barriers[i].image = i == 0 ? color_.image : i == 1 ? depth_.image : behind_.image;
            barriers[i].subresourceRange = {
                VkImageAspectFlags(i == 1 ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT),
                0, 1, 0, 1};
        }
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 3,
                             barriers);
        const VkClearColorValue black{};
        const VkClearDepthStencilValue far{1, 0};
        vkCmdClearColorImage(commands, color_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black,
                             1, &barriers[0].subresourceRange);
        vkCmdClearDepthStencilImage(commands, depth_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                    &far, 1, &barriers[1].subresourceRange);
        vkCmdClearColorImage(commands, behind_.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black,
                             1, &barriers[2].subresourceRange);
        barriers[2].srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barriers[2].dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
        barriers[2].oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barriers[2].newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barriers[2]);
        FwVulkanComposite images = fwDefaultVulkanComposite();
        images.width = images.height = kSide;
        for (FwVulkanImage* image : {&images.color, &images.depth}) {
            image->layoutBefore = image->layoutAfter = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
            image->stageBefore = image->stageAfter = VK_PIPELINE_STAGE_TRANSFER_BIT;
            image->accessBefore = image->accessAfter = VK_ACCESS_TRANSFER_WRITE_BIT;
        }
        images.color.image = color_.image;
        images.color.view = color_.view;
        images.depth.image = depth_.image;
        images.depth.view = depth_.view;
        FwView view = rig_->view;
        if (index_ % 2) view.exposure *= 0.99f;  // differs from the view of the outside part
        EXPECT_TRUE(rig_->backend.recordComposite(frame, target_, view, images));
        FwVulkanFrame hostFrame = frame;
        hostFrame.sampledColor = behind_.view;
        hostFrame.sampledColorLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        hostFrame.transparency = 0.5f;
        EXPECT_TRUE(rig_->backend.recordComposite(hostFrame, hazeTarget_, view, images));
        EXPECT_TRUE(rig_->backend.recordComposite(hostFrame, halfTarget_, view, images));
    }

    // From here on flames and particles show flipbooks.
    void showFlipbooks() {
        std::pmr::memory_resource* memory = std::pmr::get_default_resource();
        flipbook::Flipbook flipbooks[3]{flipbook::Flipbook(memory), flipbook::Flipbook(memory),
                                        flipbook::Flipbook(memory)};
        const flipbook::Flipbook* placed[] = {&flipbooks[0], &flipbooks[1], &flipbooks[2]};
        const uint32_t presets[] = {FW_FLIPBOOK_FLAME, FW_FLIPBOOK_SMOKE, FW_FLIPBOOK_SPARK};
        for (int i = 0; i < 3; ++i)
            flipbook::readFlipbook(flipbook::presetFlipbook(presets[i], memory), flipbooks[i]);
        const flipbook::Picture picture = flipbook::packFlipbooks(placed, memory);
        rig_->backend.setFlipbooks(picture.width, picture.height,
                                   std::as_bytes(std::span(picture.texels)), picture.words);
        rig_->backend.setTileFlipbooks(1u | 2u << 8);
        emitter_->emitter.flipbooks = {1u, 2u | 3u << 16};
    }

    // No view shows it, so its prediction stops until one does again.
    void hide(bool hidden) {
        gpu::BurnObject record = scene_->init(0).record;
        const gpu::vec4 rows[] = {record.worldRow0, record.worldRow1, record.worldRow2};
        const uint32_t flags = record.flags & ~gpu::kObjectHidden;
        rig_->backend.setObjectPose(0, rows, record.tint,
                                    hidden ? flags | gpu::kObjectHidden : flags);
    }

    // As after a load: unburnt, in all lists with all of its tiles.
    void restoreBox() {
        const mesh::BurnDomain& domain = scene_->domains[0];
        std::vector<uint32_t> ticks(domain.texelCount(), gpu::kInert);
        for (size_t i = 0; i < ticks.size(); ++i)
            if (domain.texels[i].materialFlags & mesh::kTexelReal) ticks[i] = gpu::kNever;
        const std::vector<gpu::uvec2> heat(domain.texelCount(), gpu::uvec2(0xFFFFu, 0));
        const std::vector<gpu::TileState> tiles(
            domain.tileCount(), gpu::TileState{gpu::kNever, gpu::kTileKept, gpu::kNeverChanged, 0});
        const std::vector<gpu::TileHeat> tileHeat(domain.tileCount(), gpu::TileHeat{1000, 1});
        gpu::RestoredObject one;
        one.image = {0, ticks, {}, tiles, tileHeat, {}};
        if (!scene_->objects[0].heat.empty()) one.image.heat = heat;
        std::copy(scene_->objects[0].materials.begin(), scene_->objects[0].materials.end(),
                  std::begin(one.materials));
        one.window = scene_->objects[0].window;
        one.substepShift = scene_->objects[0].substepShift;
        rig_->backend.restore({&one, 1}, now_);
    }

    // Unburnt, lit, blown at, soaked, dried, extinguished, lit all over, inspected tile by tile,
    // and again in a reused slot.
    void burn() {
        frame({});
        if (scene_->refinesByReference) {
            const float corner[3] = {0.25f, 0.25f, 0.25f};
            rig_->backend.startBoundary(1, corner, now_);
        }
        frame({gpu::kEventIgnite, 40});
        frame({.latch = true});
        frame({gpu::kEventWet, 3});
        frame({gpu::kEventDry, 2, 2, 0, true});
        frame({gpu::kEventExtinguish, 5});
        frame({gpu::kEventDry, 1, 2, 0, false, true});
        frame({gpu::kEventIgnite, 1, 3, 0, true, true});
        frame({.steps = 2, .switches = gpu::kSwitchDense, .probes = true});
        for (int i = 0; i < 3; ++i) frame({.steps = 4});
        hide(true);
        frame({.steps = 1});
        hide(false);
        frame({.steps = 1});
        placeBox();
        showFlipbooks();
        frame({gpu::kEventExtinguish, 2});
        frame({gpu::kEventDry, 1});
        frame({gpu::kEventIgnite, 7});
        for (int i = 0; i < 3; ++i) frame({.steps = 6, .exchange = true});
        frame({.kind = gpu::kEventIgnite, .whole = true});
        rig_->backend.destroyObject(0);
        rig_->backend.createObject(0, scene_->init(0));
        frame({gpu::kEventIgnite, 1, 2, 0, true, true});
        for (int i = 0; i < 2; ++i) frame({.steps = 4});
        if (!scene_->refinesByReference) restoreBox();
        frame({.steps = 4});
        rig_->alsoRecord = nullptr;
        (void)rig_->finish();
        for (const gpu::PassTime& time : rig_->backend.passTimes())
            if (time.count) passes_.insert(time.name);
    }

    // The scene ran all of its passes. Two tests, so that they run in parallel.
    void expectPasses(bool published) {
        makeRig(kNoBinding, published);
        burn();
        if (HasFatalFailure()) return;
        FwContextInfo info{};
        rig_->context.fillInfo(info);
        if (!info.gpuTimers) return;  // without timers it is unknown which passes ran
        const auto expectOne = [&](const char* name) {
            const bool second = std::find(std::begin(kReferencePasses), std::end(kReferencePasses),
                                          std::string_view(name)) != std::end(kReferencePasses);
            if (second != published) return;
            EXPECT_TRUE(passes_.contains(name)) << name << " is not run by this test's scenes";
        };
        for (const gpu::ComputePass& pass : gpu::computePasses()) expectOne(pass.name);
        for (const gpu::DrawPass& pass : gpu::drawPasses()) expectOne(pass.name);
    }

    void TearDown() override {
        rig_.reset();
        GpuTest::TearDown();
    }

    std::unique_ptr<VkRig> rig_;
    const BurnScene* scene_ = nullptr;
    FwTargetId target_{}, hazeTarget_{}, halfTarget_{};
    TestImage color_, depth_, behind_;
    TestBuffer vertices_;
    std::set<std::string> passes_;  // passes with a time
    gpu::ExchangeUpdate::Placed placed_{};
    gpu::ExchangeUpdate exchange_;
    gpu::OcclusionUpdate occlusion_;
    std::pmr::vector<uint32_t> occlusionWords_;
    std::vector<gpu::ContactLink> links_;
    gpu::HeatOccluder occluder_{};
    gpu::VolumeFlame flames_[5]{};
    std::unique_ptr<ParticleReference> emitter_;
    gpu::FieldDraw fieldDraws_[3]{};
    uint32_t fieldStep_ = 0;
    const gpu::ExchangeUpdate::Range selfRange_{0, 1};
    gpu::ExchangeUpdate::Range linkRange_;
    const uint32_t self_ = 0xFF000000u;
    uint32_t now_ = 0;
    uint64_t index_ = 0;
};

TEST_F(EveryPass, StaysInsideItsBuffers) {
    if (device_) expectPasses(false);
}

TEST_F(EveryPass, StaysInsideItsBuffersInReferenceMode) {
    if (device_) expectPasses(true);
}

// One pass proves that the layer checks and that the buffers end where they should: the reset of an
// object writes its last texel and tile. One plain object without effects, because instrumented
// shaders take minutes.
TEST_F(EveryPass, ReportsAnAccessPastTheEnd) {
    if (!device_) return;
    if (!gpuAssisted()) GTEST_SKIP() << "only GPU-assisted validation sees it (--gpu-assisted)";
    // The tests above show that full-length buffers raise no message.
    for (const uint32_t binding : {FW_BIND_STATE, FW_BIND_PREDICT, FW_BIND_TILE_STATE}) {
        rig_.reset();
        device_.reset();
        makeDevice({});
        makeRig(binding, false);
        frame({.steps = 0, .draw = false, .effects = false});
        rig_->frames.waitAll();
        rig_.reset();
        const std::vector<std::string> messages = device_->takeMessages();
        const bool seen =
            std::any_of(messages.begin(), messages.end(), [](const std::string& message) {
                return message.find("access out of bounds") != std::string::npos;
            });
        EXPECT_TRUE(seen) << "binding " << binding;
        for (const std::string& message : messages)
            if (!seen) ADD_FAILURE() << message;
    }
}

}  // namespace
}  // namespace fw::test::every_pass_test
