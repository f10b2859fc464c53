// A recorded input log: a host's commands and their ticks, as text that a person can write. Data
// and its reader only; replay_test.cpp plays it. README.md explains the words.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace fw::test {

enum class ReplayVerb : uint8_t { Wind, Object, Pose, Destroy, Ignite, Wet, Dry, Extinguish };

struct ReplayMesh {
    std::string name, generator;  // of support/meshes.h
    std::vector<double> numbers;  // the generator's arguments
    double density = 0;           // texels per metre
    double noise = 0;             // FwMeshDef::noiseAmplitude
};

struct ReplayCommand {
    uint32_t tick = 0;  // of 2^-12 s
    ReplayVerb verb = ReplayVerb::Wind;
    std::string object;          // empty: all of them (ball events only)
    std::string mesh, material;  // Object only
    double numbers[6] = {};      // in the order of the line
    int line = 0;
};

struct ReplayLog {
    double pace = 1;
    std::vector<ReplayMesh> meshes;
    std::vector<ReplayCommand> commands;  // ticks never fall
    uint32_t steps = 0;                   // to run
};

// False, with file and line in `error`, when the file is not such a log.
bool readReplayLog(const std::string& path, ReplayLog& log, std::string& error);

struct ReplayHash {  // after step `step` (the first is 1)
    uint32_t step = 0, objects = 0;
    uint64_t hash = 0;
    bool operator==(const ReplayHash&) const = default;
};
bool readReplayHashes(const std::string& path, std::vector<ReplayHash>& hashes, std::string& error);
bool writeReplayHashes(const std::string& path, const std::vector<ReplayHash>& hashes);

}  // namespace fw::test
