// Flipbooks, which an emitter and flames then show.
#include "fuzz/signed_input.h"

namespace fuzz {
namespace {

const Fuzzer kFlipbook{"flipbook", [] { return std::vector<Bytes>{fixture("small.fwbook")}; },
                       [](Input input) {
                           host::HostedWorld w(FW_BACKEND_CPU);
                           const Bytes bytes = signedInput(input);
                           FwFlipbookDef def = fwDefaultFlipbookDef();
                           def.cooked = bytes.data();
                           def.cookedSize = bytes.size();
                           FwFlipbookId id{};
                           if (fwWorld_CreateFlipbook(w.world, &def, &id) != FW_OK) return false;
                           (void)fwWorld_SetFlameFlipbooks(w.world, id, {});
                           FwFireEmitterDef emitter = fwDefaultFireEmitterDef();
                           emitter.fireFlipbooks[0] = id;
                           FwFireEmitterId made{};
                           (void)fwWorld_CreateFireEmitter(w.world, &emitter, &made);
                           w.run(0.1);
                           return true;
                       }};

}  // namespace
}  // namespace fuzz
