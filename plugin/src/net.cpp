// A world that is shared: as a server's, or as a client's of it.
#include "objects.h"

using namespace fw;
using edge::checkPointer;
using edge::onWorld;

namespace {

// Makes the world a server's or a client's.
template <class Side>
FwResult share(const char* function, FwWorld* world, const FwNetDef* given,
               std::optional<Side> FwWorld::*side) {
    return onWorld(function, world, [&](world::World& w) {
        const FwNetDef def = edge::readDef(given);
        net::checkNetDef(def);
        if (world->server || world->client)
            core::refuse("The world is a %s already; fwNet_Leave ends that.",
                         world->server ? "server's" : "client's");
        (world->*side).emplace(def, w, &world->context->memory);
    });
}

net::Server& serverOf(FwWorld& world) {
    if (!world.server) core::refuse("The world is no server's; see fwNet_Serve.");
    return *world.server;
}

void mustBeShared(const FwWorld& world) {
    if (!world.server && !world.client)
        core::refuse("The world is nobody's but its own; see fwNet_Serve and fwNet_Join.");
}

}  // namespace

extern "C" {

FwResult FW_CALL fwNet_Serve(FwWorld* world, const FwNetDef* given) {
    return share(__func__, world, given, &FwWorld::server);
}

FwResult FW_CALL fwNet_Join(FwWorld* world, const FwNetDef* given) {
    return share(__func__, world, given, &FwWorld::client);
}

FwResult FW_CALL fwNet_Leave(FwWorld* world) {
    return onWorld(__func__, world, [&](world::World& w) {
        world->server.reset();
        world->client.reset();
        w.persistence().stopRecording();
    });
}

FwResult FW_CALL fwNet_AddPeer(FwWorld* world, FwPeerId* id) {
    return onWorld(__func__, world, [&](world::World&) {
        checkPointer(id, "id");
        *id = {};
        *id = serverOf(*world).addPeer();
    });
}

FwResult FW_CALL fwNet_RemovePeer(FwWorld* world, FwPeerId id) {
    return onWorld(__func__, world, [&](world::World&) { serverOf(*world).removePeer(id); });
}

FwResult FW_CALL fwNet_Update(FwWorld* world, float deltaTime) {
    return onWorld(__func__, world, [&](world::World& w) {
        mustBeShared(*world);
        components::checkValue(deltaTime, "deltaTime", 0.0f, 10.0f);
        if (world->server) {
            world->server->update(w, deltaTime);
            if (world->server->awaitsFrame()) edge::answerAtOnce(world);
        }
        if (world->client) world->client->update(w, deltaTime);
    });
}

FwResult FW_CALL fwNet_Write(FwWorld* world, FwPeerId to, void* packet, uint32_t* size) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(packet, "packet");
        checkPointer(size, "size");
        mustBeShared(*world);
        const std::span<std::byte> room(static_cast<std::byte*>(packet), *size);
        const bool written = world->server ? world->server->write(to, room, *size)
                                           : world->client->write(w, room, *size);
        return written ? FW_OK : FW_NOT_READY;
    });
}

FwResult FW_CALL fwNet_Read(FwWorld* world, FwPeerId from, const void* packet, uint32_t size) {
    return onWorld(__func__, world, [&](world::World& w) {
        checkPointer(packet, "packet");
        mustBeShared(*world);
        const std::span<const std::byte> bytes(static_cast<const std::byte*>(packet), size);
        if (world->server)
            world->server->read(w, from, bytes);
        else
            world->client->read(bytes);
    });
}

FwResult FW_CALL fwNet_SendMessage(FwWorld* world, const void* message, uint32_t size) {
    return onWorld(__func__, world, [&](world::World& w) {
        if (size > 0) checkPointer(message, "message");
        serverOf(*world).sendMessage(w, {static_cast<const std::byte*>(message), size});
    });
}

FwResult FW_CALL fwNet_NextAction(FwWorld* world, FwNetAction* action) {
    return onWorld(__func__, world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(action);
        if (size < sizeof(FwNetAction))
            core::fail(FW_ERROR_VERSION, "FwNetAction::structSize is %u; it has %zu bytes.", size,
                       sizeof(FwNetAction));
        if (!world->client) core::refuse("The world is no client's; see fwNet_Join.");
        FwNetAction filled{};
        world->client->takeTurn(w, filled);
        edge::writeInfo(action, size, filled);
    });
}

FwResult FW_CALL fwNet_GetState(FwWorld* world, FwPeerId peer, FwNetState* state) {
    return onWorld(__func__, world, [&](world::World& w) {
        const uint32_t size = edge::checkInfo(state);
        FwNetState filled{};
        if (world->server) world->server->fillState(w, peer, filled);
        if (world->client) world->client->fillState(w, filled);
        edge::writeInfo(state, size, filled);
    });
}

}  // extern "C"
