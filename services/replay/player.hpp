// Plays recordings through a sender at their recorded or another speed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "services/replay/senders/sender.hpp"

namespace boresight::replay {

struct PlayOptions {
  std::vector<std::filesystem::path> files;
  double speed = 1.0;  ///< 0: as fast as the receiver reads
  double start_s = 0.0;
  double duration_s = std::numeric_limits<double>::infinity();
  double step_s = 0.0;  ///< > 0: wait for Enter after each step of this length
  unsigned loops = 1;
};

struct PlayResult {
  std::uint64_t sent = 0;
  std::uint64_t lost = 0;       ///< frames without a receiver
  std::uint64_t malformed = 0;  ///< lines or packets of the recordings
  double recorded_s = 0.0;
  bool stopped = false;  ///< stopped by a signal, or by the end of input in step mode
};

/// Throws recording::OpenError, and std::runtime_error from the sender.
[[nodiscard]] PlayResult play(const PlayOptions& options, Sender& sender);

}  // namespace boresight::replay
