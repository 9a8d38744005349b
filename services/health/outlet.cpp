#include "services/health/outlet.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "services/common/runtime/log.hpp"
#include "services/health/dds/interfaces.hpp"
#include "services/health/dds/security.hpp"

namespace boresight::health {

namespace {
constexpr std::int64_t kRetryPeriod_ns = 5'000'000'000;
constexpr const char* kRejection = "the middleware rejected a sample";
constexpr const char* kExpired = "a file of DDS security has expired; new readers refuse this participant";

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

void Outlet::report_mute(const std::string& problem, std::int64_t now_ns) {
  if (problem != problem_) {
    if (problem.empty()) {
      runtime::log::info("diagnostics are sent on DDS domain {} again", config_.domain);
    } else {
      runtime::log::warning("diagnostics are mute on DDS: {}", problem);
    }
    problem_ = problem;
  }
  if (!problem.empty()) node_.fault(Fault::kLink, "DDS is mute: " + problem);
  FreezeFrame frame;
  frame.time_ns = runtime::realtime_now_ns();
  frame.uptime_ns = static_cast<std::uint64_t>(now_ns);
  frame.cycle = faults_.cycle();
  const TestResult result = problem.empty() ? TestResult::kPassed : TestResult::kFailed;
  faults_.report({EventKind::kDiagnosticsMute}, result, now_ns, frame);
}

void Outlet::write(const HealthReport& report, bool at_once, std::int64_t now_ns) {
  if (!config_.enabled || (!at_once && now_ns < next_ns_)) return;
  next_ns_ = now_ns + static_cast<std::int64_t>(config_.period_s * 1e9);
  std::string problem = look_at_interfaces();
  const bool may_join = !channel_ && !joining_.valid() && !used_addresses_.empty();
  if (may_join && now_ns >= retry_ns_) begin_to_join();
  if (!channel_ && problem.empty()) problem = obstacle_;
  if (!channel_ && problem.empty()) return;  // not known yet
  if (channel_) {
    const dds::Now now = moment(now_ns);
    const bool are_services_taken = channel_->topics.write(report, now);
    const bool is_report_taken = channel_->reports.write(report, now.epoch_ns);
    if (!(are_services_taken && is_report_taken) && problem.empty()) problem = kRejection;
    if (has_expired() && problem.empty()) problem = kExpired;
  }
  report_mute(problem, now_ns);
}

void Outlet::serve(std::int64_t now_ns) {
  end_joining(now_ns);
  if (!channel_) return;
  if (!channel_->topics.send()) node_.fault(Fault::kLink, std::string("DDS: ") + kRejection);
  for (const std::string& event : channel_->faults.serve(now_ns)) {
    runtime::log::warning("{}", event);
  }
}

bool Outlet::has_expired() const {
  return now_s() > valid_until_s_;
}

dds::Now Outlet::moment(std::int64_t now_ns) {
  return {.monotonic_ns = now_ns, .epoch_ns = runtime::realtime_now_ns()};
}

void Outlet::end() {
  if (!channel_) return;
  channel_->topics.end();
  channel_->reports.end(runtime::realtime_now_ns(), config_.farewell_s);
}

std::string Outlet::look_at_interfaces() {
  dds::UsableInterfaces usable;
  try {
    usable = dds::usable_interfaces(config_.interfaces, dds::local_interfaces());
  } catch (const std::exception& error) {
    return error.what();
  }
  // The middleware does not join the multicast group of an interface again that was lost.
  if (channel_ && !std::ranges::includes(used_addresses_, usable.addresses)) {
    runtime::log::info("DDS: the network interfaces changed; joining domain {} again", config_.domain);
    channel_.reset();
    retry_ns_ = 0;
  }
  if (channel_ || joining_.valid()) {
    std::vector<std::string> kept;
    std::ranges::set_intersection(used_addresses_, usable.addresses, std::back_inserter(kept));
    used_addresses_ = std::move(kept);
  } else {
    used_addresses_ = usable.addresses;
  }
  return dds::joined(usable.problems);
}

void Outlet::begin_to_join() {
  joining_ = std::async(std::launch::async, [this] {
    auto participant = std::make_unique<dds::Participant>(config_, "boresight-health");
    return Joined{std::move(participant), dds::check_security(config_.security, config_.domain, now_s()).valid_until_s};
  });
}

void Outlet::end_joining(std::int64_t now_ns) {
  if (!joining_.valid() || joining_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  next_ns_ = 0;  // the result is reported at once
  try {
    Joined joined = joining_.get();
    valid_until_s_ = joined.valid_until_s;
    channel_.emplace(std::move(joined.participant), config_, vehicle_, faults_, key_);
    obstacle_.clear();
    if (problem_.empty()) {
      runtime::log::info("diagnostics are sent on DDS domain {}{}", config_.domain,
                         config_.security.enabled ? ", secured" : "");
    }
  } catch (const std::exception& error) {
    retry_ns_ = now_ns + kRetryPeriod_ns;
    obstacle_ = error.what();
  }
}

}  // namespace boresight::health
