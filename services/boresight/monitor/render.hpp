// Snapshots as text for the terminal.
#pragma once

#include <string>

#include "services/boresight/monitor/snapshot.hpp"

namespace boresight::monitor {

struct RenderOptions {
  bool colour = false;
  std::size_t width = 110;  ///< columns; longer lines are cut
  std::size_t tracks = 5;   ///< how many of the nearest tracks to list
  double elapsed_s = 0.0;   ///< since the monitor started
};

/// The whole picture: several lines, each ended by '\n'.
[[nodiscard]] std::string render_screen(const Snapshot& snapshot, const RenderOptions& options);
/// The state in one line, without '\n', for output that is not a terminal.
[[nodiscard]] std::string render_line(const Snapshot& snapshot, double elapsed_s);
/// "AVAILABLE", "AVAILABLE_REDUCED (MISALIGNED)".
[[nodiscard]] std::string verdict(const RadarSnapshot& radar);

}  // namespace boresight::monitor
