// Outputs of recorded frames.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "services/common/recording/frame.hpp"

namespace boresight::replay {

class Sender {
 public:
  virtual ~Sender() = default;
  /// Sends a frame and waits for a slow receiver. False: the frame is lost because there is no receiver.
  [[nodiscard]] virtual bool send(const recording::Frame& frame) = 0;
  /// Returns at the monotonic time of the next frame, or at a stop signal; sleeps by default.
  virtual void wait_until(std::int64_t due_ns);
  /// Whether the receiver has read every frame that was sent; true for a sender that cannot know.
  [[nodiscard]] virtual bool all_read() { return true; }
  /// End of the recording.
  virtual void end_recording() {}
};

/// Sends to the gateway's replay tunnel. Waits up to `wait_s` for the gateway at first, then throws std::runtime_error.
/// If the gateway ends later, frames are lost until it is back.
[[nodiscard]] std::unique_ptr<Sender> make_tunnel_sender(const std::string& path, double wait_s);

/// Sends to UDP sockets and SocketCAN interfaces. `routes` replaces recorded IPv4 addresses (sender or destination) by
/// local ones, as text. Throws std::runtime_error at the first frame whose interface cannot be opened.
[[nodiscard]] std::unique_ptr<Sender> make_wire_sender(const std::map<std::string, std::string>& routes);

}  // namespace boresight::replay
