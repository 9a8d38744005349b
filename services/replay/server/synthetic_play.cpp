#include "services/replay/server/synthetic_play.hpp"

#include <algorithm>
#include <memory>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/core/synthetic.hpp"

namespace boresight::replay {

namespace {

/// A periodic event.
struct Beat {
  std::int64_t next_ns;
  std::int64_t period_ns;
  std::uint32_t radar;  // 0: ego motion
  std::uint32_t cycle = 0;
};

SensorTime now_at(std::int64_t monotonic_ns) {
  return {monotonic_ns + runtime::realtime_now_ns() - runtime::monotonic_now_ns(),
          wire::boresight_service::sync_status::kSynchronised};
}

}  // namespace

void play_synthetic(const SyntheticOptions& options, const std::vector<MountingPose>& mountings, SomeIpServer& server) {
  const std::int64_t start_ns = runtime::monotonic_now_ns();
  const auto period_ns = static_cast<std::int64_t>(1e9 / options.rate_hz);
  std::vector<Beat> beats{{start_ns, static_cast<std::int64_t>(1e9 / options.ego_rate_hz), 0}};
  for (std::uint32_t radar = 1; radar <= options.radars; ++radar) {
    const std::int64_t shift_ns = options.together ? 0 : period_ns * (radar - 1) / options.radars;
    beats.push_back({start_ns + shift_ns, period_ns, radar});
  }
  const auto scan = std::make_unique<RadarScan>();
  EgoMotion ego{};
  write_synthetic_ego(ego);
  while (!runtime::stop_signalled()) {
    Beat& beat = *std::min_element(beats.begin(), beats.end(),
                                   [](const Beat& a, const Beat& b) { return a.next_ns < b.next_ns; });
    if (static_cast<double>(beat.next_ns - start_ns) * 1e-9 > options.duration_s) {
      // Serves until the end of the duration, so that the last event arrives before the offer is withdrawn.
      server.serve_until(start_ns + static_cast<std::int64_t>(options.duration_s * 1e9));
      return;
    }
    server.serve_until(beat.next_ns);
    if (runtime::stop_signalled()) return;
    if (beat.radar == 0) {
      server.send(ego, now_at(beat.next_ns));
    } else {
      const MountingPose mounting = beat.radar <= mountings.size() ? mountings[beat.radar - 1] : MountingPose{};
      write_synthetic_scan(beat.radar, mounting, beat.cycle, options.detections, *scan);
      server.send(static_cast<std::uint16_t>(beat.radar), *scan, now_at(beat.next_ns));
    }
    ++beat.cycle;
    beat.next_ns += beat.period_ns;
  }
}

}  // namespace boresight::replay
