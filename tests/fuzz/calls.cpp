// Random sequences of calls of the C interface: the bytes are what a random host draws.
#include "fuzz/fuzzer.h"
#include "fuzz/random_host.h"

namespace fuzz {
namespace {

const Fuzzer kCalls{"calls",
                    [] {
                        std::vector<Bytes> seeds;
                        for (uint64_t seed = 1; seed <= 4; ++seed) {
                            host::Random random(seed);
                            Bytes bytes(16384);
                            for (unsigned char& byte : bytes) byte = uint8_t(random.below(256));
                            seeds.push_back(bytes);
                        }
                        return seeds;
                    },
                    [](Input input) {
                        host::RandomHost random{host::Random(input)};
                        random.run(400);
                        return random.meshes + random.objects + random.flames > 0;
                    }};

}  // namespace
}  // namespace fuzz
