// Processor time, for tests and the bench.
#pragma once
#include <ctime>

namespace fw::test {

// CPU time of the whole process in s. On a software device it includes the device's work and is
// independent of the machine's load.
inline double cpuSeconds() {
    std::timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

}  // namespace fw::test
