// UDP over the loopback interface that loses, delays, duplicates and reorders packets, like a bad
// internet connection. POSIX sockets; nothing blocks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

struct WireWeather {
    double loss = 0.2, repeat = 0.05;      // probabilities per packet
    double soonest = 0.02, latest = 0.12;  // s, range of the delay
};

class Wire {
 public:
    // Port 0: any free port. Throws std::runtime_error.
    Wire(uint16_t port, const WireWeather& weather, uint32_t seed);
    ~Wire();
    Wire(const Wire&) = delete;
    Wire& operator=(const Wire&) = delete;

    [[nodiscard]] uint16_t port() const { return port_; }
    // Sends to a local port after the delay. now: s.
    void send(uint16_t to, const void* bytes, size_t size, double now);
    void flush(double now);
    // Returns the size of a received packet and its port; 0: none.
    size_t receive(void* room, size_t size, uint16_t& from);

 private:
    struct Packet {
        double at = 0;
        uint16_t to = 0;
        std::vector<unsigned char> bytes;
    };
    double chance() { return double(random_() >> 8) / double(1u << 24); }

    int socket_ = -1;
    uint16_t port_ = 0;
    WireWeather weather_;
    std::mt19937 random_;
    std::vector<Packet> packets_;
};
