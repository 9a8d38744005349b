// A process that writes radar scans, for tests of nodes that read them.
#pragma once

#include <cstdint>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight::harness {

/// Measured and received now.
inline runtime::Origin scan_origin(std::uint32_t radar) {
  return {.source_id = radar,
          .measurement_time_ns = runtime::monotonic_now_ns(),
          .time_source = TimeSource::kLinkArrival,
          .stage = Stage::kIngest,
          .begin_ns = runtime::monotonic_now_ns()};
}

/// Publishes scans of radars 1 and 2 in turn; the cycle counter counts all of them.
inline int write_scans(std::int64_t period_ns) {
  runtime::Node node(catalogue::Service::kIngestGateway);
  runtime::Publisher<RadarScan> scans(node);
  std::uint32_t counter = 0;
  node.every(period_ns, [&] {
    scans.publish(scan_origin(1 + counter % 2), [&](RadarScan& scan) {
      scan.cycle_counter = ++counter;
      scan.number_of_valid_detections = 1;
      scan.range_m[0] = static_cast<float>(counter);
    });
  });
  return node.spin();
}

}  // namespace boresight::harness
