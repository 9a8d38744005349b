// Sends reports by DDS when they are due, and tries to join the domain again while that is impossible.
#pragma once

#include <cstdint>
#include <optional>

#include "services/common/runtime/node.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/dds/diagnostics_writer.hpp"

namespace boresight::health {

/// Supervision on the ECU works without DDS. Each failure is reported as a fault of the node, and the participant is
/// created again later.
class Outlet {
 public:
  Outlet(runtime::Node& node, const VehicleConfig& vehicle, const dds::Config& config)
      : node_(node), vehicle_(vehicle), config_(config) {}

  /// Sends if `at_once`, or if the configured period has passed since the last report.
  void write(const HealthReport& report, bool at_once, std::int64_t now_ns);

 private:
  void open(std::int64_t now_ns);

  runtime::Node& node_;
  const VehicleConfig& vehicle_;
  const dds::Config& config_;
  std::optional<dds::DiagnosticsWriter> writer_;
  std::int64_t next_ns_ = 0;
  std::int64_t retry_ns_ = 0;
};

}  // namespace boresight::health
