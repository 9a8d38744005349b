#include "services/health/outlet.hpp"

#include <exception>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/health/dds/security.hpp"

namespace boresight::health {

namespace {
constexpr std::int64_t kRetryPeriod_ns = 5'000'000'000;

std::int64_t now_s() {
  return runtime::realtime_now_ns() / 1'000'000'000;
}

}  // namespace

dds::CommandKey command_key_of(const dds::Config& config) {
  if (config.command_key_file.empty()) return {};
  std::string problem;
  dds::CommandKey key = dds::read_command_key(config.command_key_file, problem);
  if (!problem.empty()) throw config::Error("dds.command_key_file: " + problem);
  return key;
}

void Outlet::report_mute(bool is_mute, std::int64_t now_ns) {
  FreezeFrame frame;
  frame.time_ns = runtime::realtime_now_ns();
  frame.uptime_ns = static_cast<std::uint64_t>(now_ns);
  frame.cycle = faults_.cycle();
  faults_.report({EventKind::kDiagnosticsMute}, is_mute ? TestResult::kFailed : TestResult::kPassed, now_ns, frame);
}

void Outlet::write(const HealthReport& report, bool at_once, std::int64_t now_ns) {
  if (!config_.enabled || (!at_once && now_ns < next_ns_)) return;
  next_ns_ = now_ns + static_cast<std::int64_t>(config_.period_s * 1e9);
  if (!channel_ && now_ns >= retry_ns_) open(now_ns);
  if (!channel_) return;
  const bool is_taken = channel_->reports.write(report, runtime::realtime_now_ns());
  if (!is_taken) node_.fault(Fault::kLink, "DDS: the middleware rejected a sample");
  const bool expired = has_expired();
  if (expired) node_.fault(Fault::kLink, "DDS security: a file has expired; new readers refuse this participant");
  report_mute(!is_taken || expired, now_ns);
}

void Outlet::serve(std::int64_t now_ns) {
  if (!channel_) return;
  for (const std::string& event : channel_->faults.serve(now_ns)) {
    runtime::log::warning("{}", event);
  }
}

bool Outlet::has_expired() const {
  return now_s() > valid_until_s_;
}

void Outlet::open(std::int64_t now_ns) {
  try {
    channel_.emplace(config_, vehicle_, faults_, key_);
    valid_until_s_ = dds::check_security(config_.security, config_.domain, now_s()).valid_until_s;
    runtime::log::info("diagnostics are sent on DDS domain {}{}", config_.domain,
                       config_.security.enabled ? ", secured" : "");
  } catch (const std::exception& error) {
    node_.fault(Fault::kLink, error.what());
    report_mute(true, now_ns);
    retry_ns_ = now_ns + kRetryPeriod_ns;
  }
}

}  // namespace boresight::health
