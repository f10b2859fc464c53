// A scene that is edited in one program and shown by another, over a live link: the editor pushes
// what has changed, the sample takes it over. The scene goes as its file's text, which is small;
// of paint only the tiles that differ from what the other side has. Meshes and flame shapes are
// files of this machine, which both read, as they do the cache of burn maps.
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
    // False: `error`. What the other side had before counts for nothing: it gets all anew.
    bool connect(uint16_t port, std::string& error);
    void disconnect() { channel_.close(); }
    [[nodiscard]] bool connected() const { return channel_.open(); }
    [[nodiscard]] const std::string& problem() const { return channel_.problem(); }
    // Sends what has changed; while the last is still on its way, later.
    void follow(const fwedit::Document& document);
    // The other side shows the document as it is.
    [[nodiscard]] bool shown(const fwedit::Document& document) const {
        return connected() && followed_ == document.revision && shown_ == sent_;
    }
    // What it said of that: empty, or what it could not take, for people.
    [[nodiscard]] const std::string& answer() const { return answer_; }

 private:
    Channel channel_;
    fwedit::PaintImages images_;     // that the other side has
    uint64_t followed_ = ~0ull;      // revision
    uint64_t sent_ = 0, shown_ = 0;  // numbers of scenes, from 1
    std::string answer_;
};

struct LinkedScene {
    uint64_t number = 0;  // for took()
    fwedit::Scene scene;
    fwedit::PaintImages images;
    std::filesystem::path folder;  // where its relative paths begin
};

// The sample's side of the link, without a socket. It holds what was sent and no more:
// tiles are kept one by one, and a layer's table of tiles is made only for layers that a scene
// names.
class SceneReader {
 public:
    static constexpr size_t kMostPaint = size_t{256} << 20;  // bytes of tiles held at a time

    // False: `error` says what is wrong with it, and nothing of it counts. `whole`: there is a
    // scene to be shown, in scene().
    bool take(const Message& message, bool& whole, std::string& error);
    [[nodiscard]] const LinkedScene& scene() const { return scene_; }
    // Bytes of tiles held, and layers that have an entry.
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
    std::map<fwedit::ObjectId, LayerPaint> paint_;  // as it came; a scene says which layers count
    size_t tiles_ = 0;                              // of all layers
};

// The sample's side. The editor whose scene came last is the one that is shown. Callers that have
// sent no scene yet wait beside it, so that a silent one keeps nobody out.
class SceneReceiver {
 public:
    static constexpr size_t kMostCallers = 8;  // beside the editor that is shown

    // Listens; 0: on any port that is free. False: `error`.
    bool listen(uint16_t port, std::string& error) { return listener_.listen(port, error); }
    [[nodiscard]] uint16_t port() const { return listener_.port(); }
    [[nodiscard]] bool connected() const { return editor_.channel.open(); }
    // Once a frame. True: there is a new scene. `report`: lines for people, empty if there are
    // none.
    bool poll(LinkedScene& scene, std::string& report);
    // The scene of that number is on the screen; `answer` is for the artist.
    void took(uint64_t number, const std::string& answer);

 private:
    struct Caller {
        Channel channel;
        SceneReader reader;
    };

    void acceptCallers();
    // True: a scene came whole. A fault of the caller closes its channel and is added to `report`.
    bool readCaller(Caller& caller, std::string& report);

    Listener listener_;
    Caller editor_;
    std::vector<Caller> callers_;
};

}  // namespace fwlink
