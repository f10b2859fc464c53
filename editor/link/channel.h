// One end of a live link: messages over TCP on the local machine (127.0.0.1). Never blocks: pump()
// moves the data that the system offers. POSIX sockets.
#pragma once

#include <string>
#include <utility>

#include "link/message.h"

namespace fwlink {

class Channel {
 public:
    Channel() = default;
    explicit Channel(int socket) : socket_(socket) {}  // takes ownership
    ~Channel() { close(); }
    Channel(Channel&& other) noexcept { *this = std::move(other); }
    Channel& operator=(Channel&& other) noexcept;

    // Connects to a local port. On failure returns false with `error`.
    bool connect(uint16_t port, std::string& error);
    void close();
    [[nodiscard]] bool open() const { return socket_ >= 0; }
    // The reason of disconnection; empty: closed on this side, or never open.
    [[nodiscard]] const std::string& problem() const { return problem_; }
    // Returns the problem once.
    std::string takeProblem() { return std::exchange(problem_, {}); }

    void send(Kind kind, std::span<const uint8_t> body);
    // Closes the link with a reason. Complete messages stay readable.
    void fail(std::string problem);
    // Bytes still in the send buffer.
    [[nodiscard]] size_t unsent() const { return out_.size() - sent_; }
    [[nodiscard]] bool isDrained() const { return unsent() == 0; }
    void pump();
    [[nodiscard]] uint64_t received() const { return received_; }  // bytes
    // Returns the next complete message. Invalid data closes the link.
    bool next(Message& message);

 private:
    int socket_ = -1;
    Bytes out_;
    size_t sent_ = 0;        // sent part of out_
    uint64_t received_ = 0;  // bytes
    MessageReader reader_;
    std::string problem_;
};

// Listens on a local port for one peer.
class Listener {
 public:
    // Port 0: any free port. On failure returns false with `error`.
    bool listen(uint16_t port, std::string& error);
    ~Listener();
    Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    [[nodiscard]] uint16_t port() const { return port_; }
    // Accepts a pending connection; a closed channel if there is none.
    [[nodiscard]] Channel accept() const;

 private:
    int socket_ = -1;
    uint16_t port_ = 0;
};

}  // namespace fwlink
