// Packets of a recorded session for the fuzzers of both of its sides. An input is a stream of
// records (appendRecord): a packet, or nothing, and then time passes.
#pragma once
#include "abi/panels.h"
#include "fuzz/signed_input.h"

namespace fuzz {

struct NetSides {
    // One panel in the world; the session's tokens are always the same.
    static std::unique_ptr<host::Panels> makeWorld() {
        FwWorldDef def = fwDefaultWorldDef();
        def.flags = FW_WORLD_CONTACT;
        def.paceFactor = 4;
        auto made = std::make_unique<host::Panels>(def, 20.0f, 32.0f);
        (void)made->add(0, 0, 0);
        return made;
    }
    static void act(host::Panels& server, uint32_t frame) {
        if (frame % 20 == 5) (void)server.touch(FW_IGNITE, server.ids[0], 0.1f, 0, 0.1f, 0.05f);
        if (frame % 30 == 7) server.ok(fwNet_SendMessage(server.world, "hello", 5));
    }
    // Packets of a session of `frames` frames, as its server (`up`) or its client gets them. The
    // client's world diverges, so that it requests tiles.
    static Bytes record(uint32_t frames, bool up) {
        using Session = host::NetSession<host::Panels>;
        Session session(makeWorld());
        Session::Client& client = session.join(makeWorld());
        client.up.loss = client.down.loss = client.up.repeat = client.down.repeat = 0;
        Bytes stream;
        (up ? client.alterUp : client.alterDown) = [&](Bytes& packet) {
            appendRecord(stream, packet);
        };
        for (uint32_t frame = 0; frame < frames; ++frame) {
            act(*session.server, frame);
            session.run(1);
            if (frame == 40) {
                const uint32_t texels[] = {30, 31};
                client.world->ok(fwDebug_PushTexels(client.world->world, client.world->ids[0],
                                                    FW_IGNITE, texels, 2));
            }
            appendRecord(stream, {});
        }
        return stream;
    }
    static std::vector<Bytes> records(bool up) { return {record(6, up), record(90, up)}; }

    // Hands each packet of the stream to the world; `pass` makes time pass. Returns whether the
    // world accepted a packet.
    template <class Pass>
    static bool read(host::Panels& w, FwPeerId from, Input stream, Pass&& pass) {
        bool accepted = false;
        uint32_t frames = 0;
        forEachRecord(stream, [&](Bytes packet) {
            if (packet.empty()) {
                if (++frames > 200) return;
                w.ok(fwNet_Update(w.world, 1.0f / 32));
                pass(frames);
                drain(w, from);
                return;
            }
            if (packet.size() >= 24) host::signPacket(packet);
            const FwResult result =
                fwNet_Read(w.world, from, packet.data(), uint32_t(packet.size()));
            EXPECT_TRUE(result == FW_OK || result == FW_ERROR_BAD_DATA ||
                        result == FW_ERROR_VERSION)
                << host::lastMessage(w.world);
            accepted |= result == FW_OK;
        });
        return accepted;
    }

 private:
    static void drain(host::Panels& w, FwPeerId to) {
        FwResult result = FW_OK;
        for (int i = 0; i < 1000 && result == FW_OK; ++i) {
            Bytes packet(1400);
            auto size = uint32_t(packet.size());
            result = fwNet_Write(w.world, to, packet.data(), &size);
        }
        EXPECT_EQ(FW_NOT_READY, result) << host::lastMessage(w.world);
    }
};

}  // namespace fuzz
