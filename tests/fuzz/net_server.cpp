// A server that reads the packets of a hostile client.
#include "fuzz/net.h"

namespace fuzz {
namespace {

const Fuzzer kNetServer{"net_server", [] { return NetSides::records(true); },
                        [](Input input) {
                            const auto w = NetSides::makeWorld();
                            const FwNetDef def = host::netDef(78);  // as NetSession's
                            w->ok(fwNet_Serve(w->world, &def));
                            FwPeerId peer{};
                            w->ok(fwNet_AddPeer(w->world, &peer));
                            return NetSides::read(*w, peer, input, [&](uint32_t frame) {
                                NetSides::act(*w, frame);
                                w->ok(fwWorld_Step(w->world, 1.0f / 32));
                            });
                        }};

}  // namespace
}  // namespace fuzz
