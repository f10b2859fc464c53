// One end of a live link: messages over TCP, within this machine alone (127.0.0.1). Nothing waits:
// pump() moves what the system gives and takes. POSIX sockets.
#pragma once

#include <string>
#include <utility>

#include "link/message.h"

namespace fwlink {

class Channel {
 public:
    Channel() = default;
    explicit Channel(int socket) : socket_(socket) {}  // owns it
    ~Channel() { close(); }
    Channel(Channel&& other) noexcept { *this = std::move(other); }
    Channel& operator=(Channel&& other) noexcept;

    // To who listens on that port of this machine. False: `error`.
    bool connect(uint16_t port, std::string& error);
    void close();
    [[nodiscard]] bool open() const { return socket_ >= 0; }
    // Why it is not open any more; empty: it was closed here, or never open.
    [[nodiscard]] const std::string& problem() const { return problem_; }
    // The same, once.
    std::string takeProblem() { return std::exchange(problem_, {}); }

    void send(Kind kind, std::span<const uint8_t> body);
    // Closes the link for a reason; what came whole before can still be read.
    void fail(std::string problem);
    // Bytes that the system has not taken yet.
    [[nodiscard]] size_t unsent() const { return out_.size() - sent_; }
    [[nodiscard]] bool drained() const { return unsent() == 0; }
    void pump();
    [[nodiscard]] uint64_t received() const { return received_; }  // bytes
    // A message that came whole. What is none closes the link.
    bool next(Message& message);

 private:
    int socket_ = -1;
    Bytes out_;
    size_t sent_ = 0;        // of out_
    uint64_t received_ = 0;  // bytes
    MessageReader reader_;
    std::string problem_;
};

// A port of this machine on which one other side is awaited.
class Listener {
 public:
    // 0: any that is free. False: `error`.
    bool listen(uint16_t port, std::string& error);
    ~Listener();
    Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    [[nodiscard]] uint16_t port() const { return port_; }
    // Who has called since; not open: nobody.
    [[nodiscard]] Channel accept() const;

 private:
    int socket_ = -1;
    uint16_t port_ = 0;
};

}  // namespace fwlink
