#include "services/health/outlet.hpp"

#include <exception>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"

namespace boresight::health {

namespace {
constexpr std::int64_t kRetryPeriod_ns = 5'000'000'000;
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
  const dds::Now now = moment(now_ns);
  const bool are_services_taken = channel_->topics.write(report, now);
  const bool is_taken = channel_->reports.write(report, now.epoch_ns) && are_services_taken;
  if (!is_taken) report_rejection();
  report_mute(!is_taken, now_ns);
}

void Outlet::serve(std::int64_t now_ns) {
  if (!channel_) return;
  for (const std::string& event : channel_->faults.serve(now_ns)) {
    runtime::log::warning("{}", event);
  }
}

dds::Now Outlet::moment(std::int64_t now_ns) {
  return {.monotonic_ns = now_ns, .epoch_ns = runtime::realtime_now_ns()};
}

void Outlet::report_rejection() {
  node_.fault(Fault::kLink, "DDS: the middleware rejected a sample");
}

void Outlet::open(std::int64_t now_ns) {
  try {
    channel_.emplace(config_, vehicle_, faults_, key_);
    runtime::log::info("diagnostics are sent on DDS domain {}", config_.domain);
  } catch (const std::exception& error) {
    node_.fault(Fault::kLink, error.what());
    report_mute(true, now_ns);
    retry_ns_ = now_ns + kRetryPeriod_ns;
  }
}

}  // namespace boresight::health
