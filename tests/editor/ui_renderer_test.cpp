// The interface redraws only changed parts; the picture must equal a full redraw.
#include <gmock/gmock.h>

#include <cstdio>
#include <memory>

#include "common/vulkan_host.h"
#include "shell/frames.h"
#include "shell/ui_renderer.h"

namespace fw::test::ui_renderer_test {
namespace {

constexpr VkExtent2D kSize{320, 200};
constexpr int kFrames = 12;

// A still panel, one with changing numbers, glass that moves over both, and one panel fewer from
// the eighth frame on.
void show(int frame) {
    ImGui::NewFrame();
    const auto panel = [](const char* name, ImVec2 at, ImVec2 size) {
        ImGui::SetNextWindowPos(at);
        ImGui::SetNextWindowSize(size);
        ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    };
    panel("still", {0, 0}, {150, 200});
    ImGui::TextUnformatted("Heat source\nat the corner");
    ImGui::End();
    panel("counts", {170, 20}, {150, 120});
    char text[40];
    std::snprintf(text, sizeof text, "%d of %d", frame * frame, kFrames);
    ImGui::TextUnformatted(text);
    ImGui::GetWindowDrawList()->AddLine({175, 60 + 3.0f * float(frame)}, {300, 70}, 0xff80ffc0, 2);
    ImGui::End();
    if (frame < 8) {
        panel("leaves", {180, 150}, {100, 40});
        ImGui::TextUnformatted("Saved");
        ImGui::End();
    }
    const float x = 9.0f * float(frame % 5);
    ImGui::GetForegroundDrawList()->AddCircleFilled({100 + x, 70}, 30, 0x602040ff);
    ImGui::Render();
}

class UiRenderer : public testing::Test {
 protected:
    void SetUp() override {
        try {
            sample::HostRequest request;
            request.validation = &validation_;
            host_ = std::make_unique<sample::VulkanHost>(request);
        } catch (const sample::Failure& failure) {
            GTEST_SKIP() << failure.what();
        }
    }
    void TearDown() override {
        host_.reset();
        EXPECT_EQ(validation_.exitCode(), 0);
    }

    // The picture of the last of these frames, drawn one after another; earlier ones not at all.
    sample::Picture drawn(int first, int last) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = {float(kSize.width), float(kSize.height)};
        sample::Picture picture;
        {
            fwui::Frames frames(*host_, "", kSize);
            fwui::UiRenderer ui(*host_, frames.outputPass, fwui::Frames::kSlots);
            ui.uploadFonts();
            for (int i = 0; i <= last; ++i) {
                show(i);  // windows keep state from earlier frames
                if (i < first) continue;
                fwui::Frame frame;
                EXPECT_TRUE(frames.begin(frame));
                const bool fresh = frames.beginOutput(frame);
                EXPECT_EQ(fresh, i == first);
                ui.draw(frame.commands, frame.slot, *ImGui::GetDrawData(), fresh);
                frames.end(frame);
            }
            picture = frames.picture();
        }
        ImGui::DestroyContext();
        return picture;
    }

    sample::ValidationLog validation_;
    std::unique_ptr<sample::VulkanHost> host_;
};

TEST_F(UiRenderer, PartialRedrawEqualsFullRedraw) {
    for (const int last : {1, 5, 7, 8, kFrames}) {
        const sample::Picture parts = drawn(last - 1, last), whole = drawn(last, last);
        EXPECT_TRUE(parts.rgba == whole.rgba) << "frame " << last << " after the one before";
        EXPECT_TRUE(drawn(0, last).rgba == whole.rgba) << "frame " << last << " after all";
    }
    // Neighbouring frames differ, so the comparison is meaningful.
    EXPECT_FALSE(drawn(3, 3).rgba == drawn(4, 4).rgba);
}

}  // namespace
}  // namespace fw::test::ui_renderer_test
