#include "wire.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace {

sockaddr_in loopback(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
}

[[noreturn]] void fail(const char* what) {
    throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

}  // namespace

Wire::Wire(uint16_t port, const WireWeather& weather, uint32_t seed)
    : weather_(weather), random_(seed) {
    socket_ = socket(AF_INET, SOCK_DGRAM, 0);
    if (socket_ < 0) fail("no UDP socket");
    sockaddr_in address = loopback(port);
    socklen_t size = sizeof address;
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        fcntl(socket_, F_SETFL, O_NONBLOCK) != 0) {
        close(socket_);
        fail("the UDP port");
    }
    port_ = ntohs(address.sin_port);
}

Wire::~Wire() { close(socket_); }

void Wire::send(uint16_t to, const void* bytes, size_t size, double now) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    const int copies = chance() < weather_.repeat ? 2 : 1;
    for (int i = 0; i < copies; ++i)
        if (chance() >= weather_.loss)
            packets_.push_back(
                {now + weather_.soonest + (weather_.latest - weather_.soonest) * chance(),
                 to,
                 {from, from + size}});
}

void Wire::flush(double now) {
    std::erase_if(packets_, [&](const Packet& packet) {
        if (packet.at > now) return false;
        const sockaddr_in address = loopback(packet.to);
        // A packet that the system rejects counts as lost.
        (void)sendto(socket_, packet.bytes.data(), packet.bytes.size(), 0,
                     reinterpret_cast<const sockaddr*>(&address), sizeof address);
        return true;
    });
}

size_t Wire::receive(void* room, size_t size, uint16_t& from) {
    for (;;) {  // an empty packet does not end the queue
        sockaddr_in address{};
        socklen_t length = sizeof address;
        const ssize_t came =
            recvfrom(socket_, room, size, 0, reinterpret_cast<sockaddr*>(&address), &length);
        from = ntohs(address.sin_port);
        if (came != 0) return came > 0 ? size_t(came) : 0;
    }
}
