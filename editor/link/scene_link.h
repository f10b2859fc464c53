// Live link between an editor and a sample: the editor pushes changes, the sample applies them. The
// scene travels as its file's text, paint as the tiles that differ from the sample's state. Meshes,
// flame shapes and cached burn maps are local files that both sides read.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "document/document.h"
#include "link/channel.h"

namespace fwlink {

constexpr uint16_t kUsualPort = 47380;

// The editor's side.
class SceneSender {
 public:
    // Connects and forgets the peer's earlier state, so the whole scene is sent. On failure returns
    // false with `error`.
    bool connect(uint16_t port, std::string& error);
    void disconnect() { channel_.close(); }
    [[nodiscard]] bool connected() const { return channel_.open(); }
    [[nodiscard]] const std::string& problem() const { return channel_.problem(); }
    // Sends changes. Waits until the previous update is sent.
    void follow(const fwedit::Document& document);
    // The peer shows the current document.
    [[nodiscard]] bool shown(const fwedit::Document& document) const {
        return connected() && followed_ == document.revision && shown_ == sent_;
    }
    // The peer's reply: empty, or a message for the user about skipped parts.
    [[nodiscard]] const std::string& answer() const { return answer_; }

 private:
    Channel channel_;
    fwedit::PaintImages images_;     // layers that the peer has
    uint64_t followed_ = ~0ull;      // document revision
    uint64_t sent_ = 0, shown_ = 0;  // scene serials, from 1
    std::string answer_;
};

struct LinkedScene {
    uint64_t number = 0;  // serial for took()
    fwedit::Scene scene;
    fwedit::PaintImages images;
    std::filesystem::path folder;  // base of relative paths
};

// The sample's side without a socket. Memory is bounded by the data received: tiles are stored one
// by one, and only layers that a scene uses get a tile table.
class SceneReader {
 public:
    static constexpr size_t kMostPaint = size_t{256} << 20;  // bytes, limit of stored tiles

    // Applies a message. On failure returns false with `error` and ignores the whole message.
    // `whole`: scene() has a new scene.
    bool take(const Message& message, bool& whole, std::string& error);
    [[nodiscard]] const LinkedScene& scene() const { return scene_; }
    // Bytes of stored tiles, and layers with an entry.
    [[nodiscard]] size_t paintBytes() const { return tiles_ * sizeof(fwedit::PaintImage::Tile); }
    [[nodiscard]] size_t layers() const { return paint_.size(); }

 private:
    struct LayerPaint {
        uint32_t width = 0, height = 0;  // px
        uint8_t empty = 0;
        std::map<uint32_t, std::shared_ptr<const fwedit::PaintImage::Tile>> tiles;
    };

    bool takePaint(BodyReader& body, std::string& error);
    bool takeScene(BodyReader& body, std::string& error);

    LinkedScene scene_;
    std::map<fwedit::ObjectId, LayerPaint> paint_;  // as received; a scene selects the layers in
                                                    // use
    size_t tiles_ = 0;                              // over all layers
};

// The sample's side. Shows the editor whose scene came last. Connections without a scene wait
// beside it, so an idle one blocks nobody.
class SceneReceiver {
 public:
    static constexpr size_t kMostCallers = 8;  // besides the active editor

    // Listens; port 0: any free port. On failure returns false with `error`.
    bool listen(uint16_t port, std::string& error) { return listener_.listen(port, error); }
    [[nodiscard]] uint16_t port() const { return listener_.port(); }
    [[nodiscard]] bool connected() const { return editor_.channel.open(); }
    // Call it once per frame. Returns true if there is a new scene. `report`: messages for the
    // user, empty if there are none.
    bool poll(LinkedScene& scene, std::string& report);
    // The scene with that serial is visible. `answer`: message for the artist.
    void took(uint64_t number, const std::string& answer);

 private:
    struct Caller {
        Channel channel;
        SceneReader reader;
    };

    void acceptCallers();
    // Returns true if a complete scene arrived. Errors close the caller's channel and are appended
    // to `report`.
    bool readCaller(Caller& caller, std::string& report);

    Listener listener_;
    Caller editor_;
    std::vector<Caller> callers_;
};

}  // namespace fwlink
