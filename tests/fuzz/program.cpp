// Runs the fuzzer that FLAMEWRIGHT_FUZZER names, under libFuzzer. Without it, prints the names.
// With FLAMEWRIGHT_FUZZ_SEEDS, writes the fuzzer's seeds into that folder. An input that needs more
// memory than allowed fails.
#include "fuzz/fuzzer.h"

#include <gtest/gtest.h>
#include <sanitizer/allocator_interface.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr size_t kMemory = size_t{256} << 20;  // bytes for any input
constexpr size_t kMemoryPerByte = 100;
constexpr int kSeconds = 5;  // of processor time for any input

const fuzz::Fuzzer* chosen = nullptr;
std::atomic<int64_t> used{0}, allowed{INT64_MAX};

void onAllocation(const volatile void*, size_t size) {
    const int64_t now = used.fetch_add(int64_t(size)) + int64_t(size);
    if (now <= allowed) return;
    std::fprintf(stderr, "The input needs %lld bytes of memory; the limit is %lld.\n",
                 static_cast<long long>(now), static_cast<long long>(allowed.load()));
    allowed = INT64_MAX;
    std::abort();
}
void onRelease(const volatile void* memory) {
    if (memory) used -= int64_t(__sanitizer_get_allocated_size(memory));
}

void limitTime(int seconds) {  // 0: no limit
    const itimerval timer{{0, 0}, {seconds, 0}};
    (void)setitimer(ITIMER_PROF, &timer, nullptr);
}
void onTime(int) {
    static constexpr char kText[] = "The input takes more processor time than allowed.\n";
    (void)!write(2, kText, sizeof kText - 1);
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
    testing::InitGoogleTest(count, *words);
    const char* name = std::getenv("FLAMEWRIGHT_FUZZER");
    for (const fuzz::Fuzzer* one : fuzz::Fuzzer::all()) {
        if (!name) std::printf("%s\n", one->name);
        if (name && std::string_view(name) == one->name) chosen = one;
    }
    if (!name) std::exit(0);
    if (!chosen) {
        std::fprintf(stderr, "FLAMEWRIGHT_FUZZER: there is no fuzzer \"%s\".\n", name);
        std::exit(2);
    }
    if (const char* folder = std::getenv("FLAMEWRIGHT_FUZZ_SEEDS")) {
        size_t number = 0;
        for (const fuzz::Bytes& seed : chosen->seeds())
            std::ofstream(std::filesystem::path(folder) / std::to_string(++number),
                          std::ios::binary)
                .write(reinterpret_cast<const char*>(seed.data()), std::streamsize(seed.size()));
        std::exit(number == 0 || testing::Test::HasFailure());
    }
    (void)std::signal(SIGPROF, onTime);
    (void)chosen->take({});  // makes what all inputs share
    __sanitizer_install_malloc_and_free_hooks(onAllocation, onRelease);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    allowed = used + int64_t(std::max(kMemory, kMemoryPerByte * size));
    limitTime(kSeconds);
    (void)chosen->take({data, size});
    limitTime(0);
    allowed = INT64_MAX;
    if (testing::Test::HasFailure()) std::abort();
    return 0;
}
