#include "services/health/core/service_monitor.hpp"

#include <algorithm>
#include <initializer_list>

namespace boresight::health {

namespace {

std::uint64_t sum_of(const ServiceStatus& status, std::initializer_list<Fault> faults) {
  std::uint64_t sum = 0;
  for (const Fault fault : faults) sum += status.faults[static_cast<std::size_t>(fault)];
  return sum;
}

std::uint64_t losses_of(const ServiceStatus& status) {
  return sum_of(status,
                {Fault::kInputLost, Fault::kInputDropped, Fault::kLoanFailed, Fault::kSideInputMissing, Fault::kLink});
}

std::uint64_t rejections_of(const ServiceStatus& status) {
  return sum_of(status, {Fault::kWireLength, Fault::kWireValue, Fault::kWireUnknown, Fault::kRecordingSyntax,
                         Fault::kVersionMismatch, Fault::kForeignMemory});
}

std::uint64_t grown(std::uint64_t now, std::uint64_t before) {
  return now > before ? now - before : 0;
}

float seconds(std::int64_t duration_ns) {
  return static_cast<float>(static_cast<double>(duration_ns) * 1e-9);
}

}  // namespace

ServiceMonitor::ServiceMonitor(std::uint32_t service, std::int64_t heartbeat_deadline_ns,
                               std::int64_t output_deadline_ns, const Config& config, std::int64_t start_ns)
    : service_(service),
      heartbeat_deadline_ns_(heartbeat_deadline_ns),
      output_deadline_ns_(output_deadline_ns),
      config_(config),
      start_ns_(start_ns),
      outputs_(config.window_s),
      losses_(config.window_s),
      latency_(config.window_s) {}

void ServiceMonitor::observe(const ServiceStatus& status, std::int64_t now_ns) {
  if (last_ns_ != kNever && status.incarnation_ns < last_.incarnation_ns)
    return;  // a late heartbeat of a process that has ended
  const bool is_new = last_ns_ == kNever || status.incarnation_ns != last_.incarnation_ns;
  if (is_new) {
    if (last_ns_ != kNever) {
      ++restarts_;
      restarted_ns_ = now_ns;
    }
    // Its counters start at zero. Its first output is due one deadline after its start.
    last_.outputs = 0;
    last_.faults = {};
    last_output_ns_ = now_ns;
  }
  const std::uint64_t outputs = grown(status.outputs, last_.outputs);
  if (outputs > 0) last_output_ns_ = now_ns;
  outputs_.add(now_ns, outputs);
  // Losses before its start do not count for a new process.
  losses_.add(now_ns, is_new ? 0 : grown(losses_of(status), losses_of(last_)));
  latency_.add(now_ns, status.latency_count, status.latency_mean_us, status.latency_max_us);
  last_ = status;
  last_ns_ = now_ns;
}

ServiceHealth ServiceMonitor::judge(bool input_flows, std::int64_t now_ns) {
  if (!input_flows) {
    input_since_ns_ = kNever;
  } else if (input_since_ns_ == kNever) {
    input_since_ns_ = now_ns;
  }
  ServiceHealth health{};
  health.service = service_;
  health.restarts = restarts_;
  health.last_heartbeat_s = -1.0F;
  if (last_ns_ == kNever) {
    const bool had_time = seconds(now_ns - start_ns_) > static_cast<float>(config_.start_grace_s);
    if (had_time) health.condition = ServiceCondition::kSilent;
    return health;
  }
  const bool late = output_deadline_ns_ > 0 && input_flows &&
                    now_ns - std::max(last_output_ns_, input_since_ns_) > output_deadline_ns_;
  health.deadline_missed = late ? 1 : 0;
  health.last_heartbeat_s = seconds(now_ns - last_ns_);
  health.output_rate_hz = static_cast<float>(outputs_.rate_hz(now_ns));
  health.processing_max_us = last_.processing_max_us;
  health.latency_mean_us = latency_.mean_us(now_ns);
  health.latency_max_us = latency_.max_us(now_ns);
  health.lost_inputs = sum_of(last_, {Fault::kInputLost});
  health.dropped_inputs = sum_of(last_, {Fault::kInputDropped});
  health.rejected_inputs = rejections_of(last_);
  health.heap_allocations = last_.heap_allocations;
  const auto restart_memory_ns = static_cast<std::int64_t>(config_.restart_memory_s * 1e9);
  if (now_ns - last_ns_ > heartbeat_deadline_ns_) {
    health.condition = ServiceCondition::kSilent;
  } else if (restarted_ns_ != kNever && now_ns - restarted_ns_ <= restart_memory_ns) {
    health.condition = ServiceCondition::kRestarted;
  } else if (late || last_.state == ServiceState::kDegraded || losses_.sum(now_ns) > 0) {
    health.condition = ServiceCondition::kDegraded;
  } else {
    health.condition = ServiceCondition::kAlive;
  }
  return health;
}

void ServiceMonitor::report(const ServiceHealth& health, FaultMemory& faults, std::int64_t now_ns,
                            const FreezeFrame& frame) {
  const bool is_silent = health.condition == ServiceCondition::kSilent;
  const auto report = [&](EventKind kind, bool is_tested, bool is_failed) {
    const TestResult result = !is_tested ? TestResult::kNone : is_failed ? TestResult::kFailed : TestResult::kPassed;
    faults.report({kind, static_cast<std::uint8_t>(service_)}, result, now_ns, frame);
  };
  report(EventKind::kServiceSilent, health.condition != ServiceCondition::kUnknown, is_silent);
  // A silent service says nothing about its work.
  const bool is_alive = last_ns_ != kNever && !is_silent;
  report(EventKind::kServiceLate, is_alive, health.deadline_missed != 0);
  report(EventKind::kServiceLosing, is_alive, losses_.sum(now_ns) > 0);
  report(EventKind::kServiceDegraded, is_alive, last_.state == ServiceState::kDegraded);
  report(EventKind::kServiceRestarted, is_alive, health.condition == ServiceCondition::kRestarted);
}

}  // namespace boresight::health
