// Serves synthetic scans at a fixed rate, for load tests.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/replay/server/someip_server.hpp"

namespace boresight::replay {

struct SyntheticOptions {
  std::uint32_t detections = 0;  ///< in each scan; 0: no synthetic scans
  double rate_hz = 20.0;
  unsigned radars = 1;    ///< instances 1…radars
  bool together = false;  ///< all radars at the same time instead of spread over the cycle
  double ego_rate_hz = 50.0;
  double duration_s = std::numeric_limits<double>::infinity();
};

/// Serves until the end of the duration or a stop signal. Radar n is mounted as `mountings[n − 1]`, or points forward
/// if there are fewer mountings.
void play_synthetic(const SyntheticOptions& options, const std::vector<MountingPose>& mountings, SomeIpServer& server);

}  // namespace boresight::replay
