// Common part of the links' sockets.
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

/// Requests kernel receive stamps and the counter of frames that the kernel dropped.
void request_stamps_and_drops(int descriptor);

/// Requests a receive buffer of that size, with privilege if available; returns the granted size.
[[nodiscard]] int request_receive_buffer(int descriptor, int bytes);

/// Data of a received message.
struct Reception {
  sockaddr_storage sender{};
  FrameStamp stamp;         ///< the kernel's stamp; without one, the time of the call, marked as such
  std::uint32_t drops = 0;  ///< by the kernel since the socket was opened; unchanged without a report of the kernel
};
/// Reads one message without waiting: returns its length, or −1 as recvmsg().
[[nodiscard]] ssize_t receive(const Socket& socket, std::span<std::uint8_t> buffer, Reception& reception);

/// For a link: reports frames that the kernel dropped since `drops` as a fault, and updates `drops`.
void report_drops(const Reception& reception, std::uint32_t& drops, std::string_view of_what, const LinkEvents& events);

[[nodiscard]] std::string last_error();

}  // namespace boresight::ingest
