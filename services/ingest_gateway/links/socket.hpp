// What the links' sockets have in common.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include <sys/socket.h>

#include "services/ingest_gateway/codecs/frame_stamp.hpp"
#include "services/ingest_gateway/links/link.hpp"

namespace boresight::ingest {

/// Owns a file descriptor.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    if (this != &other) {
      reset();
      descriptor_ = std::exchange(other.descriptor_, -1);
    }
    return *this;
  }
  ~Socket() { reset(); }
  void reset();
  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

/// Asks for kernel receive stamps and for the counter of frames the kernel dropped.
void request_stamps_and_drops(int descriptor);

/// Asks for a receive buffer of that size, by privilege if the process has it; returns what the kernel gave.
[[nodiscard]] int request_receive_buffer(int descriptor, int bytes);

/// What comes with a received message.
struct Reception {
  sockaddr_storage sender{};
  FrameStamp stamp;  ///< the kernel's; without one, the time of the call, and it says so
  std::uint32_t drops =
      0;  ///< by the kernel since the socket was opened; keeps its value where the kernel says nothing
};
/// Takes one message without waiting: its length, or −1 as recvmsg().
[[nodiscard]] ssize_t receive(const Socket& socket, std::span<std::uint8_t> buffer, Reception& reception);

/// For a link: what the kernel has dropped since `drops`, which follows it, is a fault.
void report_drops(const Reception& reception, std::uint32_t& drops, std::string_view of_what, const LinkEvents& events);

[[nodiscard]] std::string last_error();

}  // namespace boresight::ingest
