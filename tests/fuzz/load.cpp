// Saves and command logs, loaded into a world in which every feature runs.
#include "fuzz/signed_input.h"

#include <memory>

namespace fuzz {
namespace {

constexpr uint32_t kThings = 3;
std::unique_ptr<host::BusyWorld> makeBusyWorld() {
    return std::make_unique<host::BusyWorld>(FW_BACKEND_CPU, 12.0f, kThings);
}

struct SavesAndLogs {
    Bytes early, late, log;
    SavesAndLogs() {
        const auto w = makeBusyWorld();
        w->ok(fwWorld_StartCommandLog(w->world));
        w->run(0, 2);
        early = w->save();
        w->run(2, 64);
        late = w->save();
        uint64_t size = 0;
        w->ok(fwWorld_FetchCommandLog(w->world, nullptr, &size));
        log.resize(size);
        w->ok(fwWorld_FetchCommandLog(w->world, log.data(), &size));
    }
};
const SavesAndLogs& savesAndLogs() {
    static const SavesAndLogs made;
    return made;
}

bool playLog(host::BusyWorld& w, const Bytes& log) {
    if (fwWorld_OpenCommandLog(w.world, log.data(), log.size()) != FW_OK) return false;
    float seconds = 1;
    for (int i = 0; i < 20 && seconds > 0; ++i) {
        w.ok(fwWorld_PlayCommandLog(w.world, 20000, &seconds));
        w.ok(fwWorld_Step(w.world, seconds));
    }
    return true;
}

const Fuzzer kLoad{
    "load",
    [] {
        return std::vector<Bytes>{savesAndLogs().early, savesAndLogs().late, savesAndLogs().log};
    },
    [](Input input) {
        static std::unique_ptr<host::BusyWorld> w = makeBusyWorld();
        const Bytes& known = savesAndLogs().early;
        const Bytes bytes = signedInput(input);
        const bool isLog = startsWith(bytes, "FWLG");
        const FwResult result = isLog ? FW_OK : w->load(bytes);
        bool accepted = result == FW_OK;
        if (isLog)
            accepted = playLog(*w, bytes);
        else if (accepted)
            w->run(200, 203);
        else
            EXPECT_TRUE(result == FW_ERROR_BAD_DATA || result == FW_ERROR_VERSION)
                << host::lastMessage(w->world);
        // Whatever was accepted, the world takes its own save.
        if (accepted) w->ok(w->load(known));
        if (accepted) w->ok(fwWorld_OpenCommandLog(w->world, nullptr, 0));
        w->host.errors.clear(), w->host.warnings.clear();
        return accepted;
    }};

}  // namespace
}  // namespace fuzz
