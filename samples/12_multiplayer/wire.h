// UDP over the loopback, which loses, holds up, doubles and so mixes what is sent: a bad day on the
// internet. POSIX sockets; nothing blocks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

struct WireWeather {
    double loss = 0.2, repeat = 0.05;      // chances of a packet
    double soonest = 0.02, latest = 0.12;  // s
};

class Wire {
 public:
    // port 0: any that is free. Throws std::runtime_error.
    Wire(uint16_t port, const WireWeather& weather, uint32_t seed);
    ~Wire();
    Wire(const Wire&) = delete;
    Wire& operator=(const Wire&) = delete;

    [[nodiscard]] uint16_t port() const { return port_; }
    // To a port of this machine, once its time has come; now: s.
    void send(uint16_t to, const void* bytes, size_t size, double now);
    void flush(double now);
    // Size of a packet that came, and from which port; 0: none.
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
