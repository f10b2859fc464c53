// A client that reads the packets of a hostile server, and does what they say.
#include "fuzz/net.h"

namespace fuzz {
namespace {

const Fuzzer kNetClient{"net_client", [] { return NetSides::records(false); },
                        [](Input input) {
                            const auto w = NetSides::makeWorld();
                            const FwNetDef def =
                                host::netDef(1011);  // as NetSession's first client
                            w->ok(fwNet_Join(w->world, &def));
                            return NetSides::read(*w, {}, input, [&](uint32_t) {
                                FwNetAction action{};
                                action.structSize = sizeof action;
                                for (int i = 0; i < 20; ++i) {
                                    const FwResult result = fwNet_NextAction(w->world, &action);
                                    if (result != FW_OK || action.kind == FW_NET_ACTION_WAIT)
                                        return;
                                    if (action.kind == FW_NET_ACTION_STEP)
                                        w->ok(fwWorld_Step(w->world, action.deltaTime));
                                }
                            });
                        }};

}  // namespace
}  // namespace fuzz
