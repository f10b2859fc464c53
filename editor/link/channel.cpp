// See channel.h.
#include "link/channel.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace fwlink {
namespace {

constexpr size_t kMostAtOnce = 4u << 20;  // bytes, limit per frame

sockaddr_in loopback(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    return address;
}

std::string systemWords(const std::string& what) { return what + ": " + std::strerror(errno); }

// Makes all calls non-blocking and sends small messages at once.
void makeQuick(int socket) {
    const int yes = 1;
    fcntl(socket, F_SETFL, fcntl(socket, F_GETFL) | O_NONBLOCK);
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

bool triesAgain() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

Channel& Channel::operator=(Channel&& other) noexcept {
    if (this == &other) return *this;
    close();
    socket_ = std::exchange(other.socket_, -1);
    out_ = std::exchange(other.out_, {});
    sent_ = std::exchange(other.sent_, 0);
    received_ = std::exchange(other.received_, 0);
    reader_ = std::exchange(other.reader_, {});
    problem_ = std::exchange(other.problem_, {});
    return *this;
}

bool Channel::connect(uint16_t port, std::string& error) {
    *this = Channel(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    const sockaddr_in address = loopback(port);
    // A local connection succeeds or fails immediately.
    if (socket_ < 0 ||
        ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        error = systemWords("Nobody answers on port " + std::to_string(port));
        close();
        return false;
    }
    makeQuick(socket_);
    return true;
}

void Channel::close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
    out_.clear();
    sent_ = 0;
    reader_ = {};
    problem_.clear();
}

// Complete messages stay readable.
void Channel::fail(std::string problem) {
    MessageReader kept = std::move(reader_);
    close();
    reader_ = std::move(kept);
    problem_ = std::move(problem);
}

void Channel::send(Kind kind, std::span<const uint8_t> body) {
    if (open()) appendMessage(out_, kind, body);
}

void Channel::pump() {
    while (open() && !isDrained()) {
        const ssize_t went =
            ::send(socket_, out_.data() + sent_, out_.size() - sent_, MSG_NOSIGNAL);
        if (went > 0) {
            sent_ += static_cast<size_t>(went);
        } else if (triesAgain()) {
            break;
        } else {
            return fail(systemWords("The peer has disconnected"));
        }
    }
    if (isDrained()) {
        out_.clear();
        sent_ = 0;
    }
    std::array<uint8_t, 65536> room;
    // Unread bytes stay in the socket, so TCP flow control throttles the peer.
    for (size_t taken = 0; open() && taken < kMostAtOnce && !reader_.full();) {
        const ssize_t came = ::recv(socket_, room.data(), room.size(), 0);
        if (came < 0 && triesAgain()) return;
        if (came < 0) return fail(systemWords("The peer has disconnected"));
        if (came == 0) return fail("The peer has disconnected");
        reader_.feed({room.data(), static_cast<size_t>(came)});
        taken += static_cast<size_t>(came);
        received_ += static_cast<size_t>(came);
    }
}

bool Channel::next(Message& message) {
    std::string error;
    if (reader_.next(message, error)) return true;
    if (!error.empty()) fail("The link is closed: " + error);
    return false;
}

bool Listener::listen(uint16_t port, std::string& error) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    sockaddr_in address = loopback(port);
    socklen_t size = sizeof address;
    if (socket_ < 0 || setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
        bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
        ::listen(socket_, 1) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
        error = systemWords("Port " + std::to_string(port) + " is not available");
        return false;
    }
    makeQuick(socket_);
    port_ = ntohs(address.sin_port);
    return true;
}

Listener::~Listener() {
    if (socket_ >= 0) ::close(socket_);
}

Channel Listener::accept() const {
    const int caller = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (caller >= 0) makeQuick(caller);
    return Channel(caller);
}

}  // namespace fwlink
