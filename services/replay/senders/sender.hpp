// Ways for a recorded frame out of the replay.
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
  /// Sends, waiting as long as the receiver is slow. False: the frame was lost because nobody receives at present.
  [[nodiscard]] virtual bool send(const recording::Frame& frame) = 0;
  /// Returns at the monotonic time when the next frame is due, or at a stop signal; by default it sleeps.
  virtual void wait_until(std::int64_t due_ns);
  /// No frame of the recording will follow.
  virtual void end_recording() {}
};

/// Into the gateway's replay tunnel. Waits up to `wait_s` for the gateway at first (throws std::runtime_error then);
/// when the gateway goes away later, frames are lost until it is back.
[[nodiscard]] std::unique_ptr<Sender> make_tunnel_sender(const std::string& path, double wait_s);

/// To UDP sockets and SocketCAN interfaces. `routes` replaces recorded IPv4 addresses (sender or destination) by local
/// ones, textual. Throws std::runtime_error at the first frame whose interface cannot be opened.
[[nodiscard]] std::unique_ptr<Sender> make_wire_sender(const std::map<std::string, std::string>& routes);

}  // namespace boresight::replay
