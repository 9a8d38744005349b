// What the links' sockets have in common.
#pragma once

#include <cstdint>
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

/// Reads stamp and drop counter from the control messages of a received message. Without a kernel stamp the stamp is
/// the time of the call and says so. `drops` keeps its value if the kernel said nothing.
[[nodiscard]] FrameStamp read_control(const msghdr& message, std::uint32_t& drops);

/// The same for a link: a drop counter beyond `drops`, which follows it, is reported as a fault.
[[nodiscard]] FrameStamp stamp_and_drops(const msghdr& message, std::uint32_t& drops, std::string_view of_what,
                                         const LinkEvents& events);

[[nodiscard]] std::string last_error();

}  // namespace boresight::ingest
