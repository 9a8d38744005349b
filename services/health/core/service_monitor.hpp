// One service: does it live, was it restarted, does it deliver, does it lose anything?
#pragma once

#include <cstdint>

#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/rate_window.hpp"

namespace boresight::health {

/// Judged from its heartbeats only. Times are CLOCK_MONOTONIC, ns.
class ServiceMonitor {
 public:
  /// `output_deadline_ns`: longest time between two outputs while its input flows; 0 if it is not to be judged by that.
  ServiceMonitor(std::uint32_t service, std::int64_t heartbeat_deadline_ns, std::int64_t output_deadline_ns,
                 const Config& config);

  void observe(const ServiceStatus& status, std::int64_t now_ns);
  /// `input_flows`: whether what the service works on has arrived lately.
  [[nodiscard]] ServiceHealth judge(bool input_flows, std::int64_t now_ns);

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
  std::int64_t last_ns_ = kNever;
  std::int64_t restarted_ns_ = kNever;
  std::int64_t last_output_ns_ = kNever;
  std::int64_t input_since_ns_ = kNever;
  std::uint32_t restarts_ = 0;
  ServiceStatus last_{};
  RateWindow outputs_;
  RateWindow losses_;
};

}  // namespace boresight::health
