// Verdict on one service: heartbeats, restarts, output deadline, lost and dropped inputs, latency.
#pragma once

#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/latency_window.hpp"
#include "services/health/core/rate_window.hpp"

namespace boresight::health {

/// Uses its heartbeats only. Times are CLOCK_MONOTONIC, ns.
class ServiceMonitor {
 public:
  /// `output_deadline_ns`: longest time between two outputs while input arrives; 0: not tested.
  ServiceMonitor(std::uint32_t service, std::int64_t heartbeat_deadline_ns, std::int64_t output_deadline_ns,
                 const Config& config, std::int64_t start_ns);

  void observe(const ServiceStatus& status, std::int64_t now_ns);
  /// `input_flows`: the input of the service has arrived within its deadline.
  [[nodiscard]] ServiceHealth judge(bool input_flows, std::int64_t now_ns);
  /// Reports the results of its tests to the fault memory; call it with the health of the same time.
  void report(const ServiceHealth& health, FaultMemory& faults, std::int64_t now_ns, const FreezeFrame& frame);

  /// True if its output counter grew within the output deadline.
  [[nodiscard]] bool delivers(std::int64_t now_ns) const {
    return last_output_ns_ != kNever && now_ns - last_output_ns_ <= output_deadline_ns_;
  }

 private:
  static constexpr std::int64_t kNever = -1;
  std::uint32_t service_;
  std::int64_t heartbeat_deadline_ns_;
  std::int64_t output_deadline_ns_;
  Config config_;
  std::int64_t start_ns_;
  std::int64_t last_ns_ = kNever;
  std::int64_t restarted_ns_ = kNever;
  std::int64_t last_output_ns_ = kNever;
  std::int64_t input_since_ns_ = kNever;
  std::uint32_t restarts_ = 0;
  ServiceStatus last_{};
  RateWindow outputs_;
  RateWindow losses_;
  LatencyWindow latency_;
};

}  // namespace boresight::health
