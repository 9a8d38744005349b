// What the supervisor learns of its processes, and how it judges them.
#include <algorithm>
#include <csignal>

#include <sys/wait.h>

#include "deploy/supervisor/clock.hpp"
#include "deploy/supervisor/configuration_watch.hpp"
#include "deploy/supervisor/supervisor.hpp"
#include "services/common/runtime/exit_codes.hpp"

namespace boresight::supervisor {

namespace {

// Logs grow, and people edit files, much more slowly than this.
constexpr std::int64_t kHousekeepingPeriod_ns = 500'000'000;
// A supervisor that did not read messages for longer than this was stopped or got no processor. Its services could not
// deliver their strokes meanwhile, because its socket holds few messages.
constexpr std::int64_t kLongestPause_ns = 500'000'000;

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

}  // namespace

void Supervisor::read_notifications() {
  for (const Notifications::Message& message : notifications_.take()) {
    if (roudi_.pid == message.sender) on_notification(roudi_, message.text);
    for (Child& child : services_) {
      if (child.pid == message.sender) on_notification(child, message.text);
    }
  }
}

void Supervisor::on_notification(Child& child, const std::string& message) {
  const bool is_first = !child.ready && value_in(message, "READY") == "1";
  if (is_first || value_in(message, "WATCHDOG") == "1") child.last_stroke_ns = now_ns();
  if (!is_first) return;
  child.ready = true;
  child.refusals = 0;
  if (&child == &roudi_) on_roudi_ready(value_in(message, "X_SEGMENTS"));
  note(EventKind::kReady, child.spec.name, child.pid, "");
}

void Supervisor::on_roudi_ready(std::string_view segments) {
  segments_ = words_of(segments);
  std::erase_if(segments_, [](const std::string& name) { return name.find('/') != std::string::npos; });
  if (std::find(segments_.begin(), segments_.end(), kManagementSegment) == segments_.end()) {
    segments_.emplace_back(kManagementSegment);
  }
  for (const std::string& name : segments_) guardian_->watch_bus_file(config_.places.shared_memory / name);
  inodes_ = segment_inodes(config_.places, segments_);
}

void Supervisor::reap() {
  const auto look = [this](Child& child) {
    int status = 0;
    if (child.pid != 0 && waitpid(child.pid, &status, WNOHANG) == child.pid) on_exit(child, status);
  };
  look(roudi_);
  for (Child& child : services_) look(child);
  for (Child& child : independents_) look(child);
}

void Supervisor::on_exit(Child& child, int wait_status) {
  const std::int64_t time_ns = now_ns();
  note(EventKind::kExited, child.spec.name, child.pid, describe_exit(wait_status));
  guardian_->forget_process(child.pid);
  child.failures = time_ns - child.started_ns > config_.stable_after_ns ? 1 : child.failures + 1;
  child.start_at_ns = time_ns + restart_delay_ns(child.failures);
  child.wait_status = wait_status;
  child.pid = 0;
  child.ready = false;
  if (child.spec.role == Role::kService && WIFEXITED(wait_status) && WEXITSTATUS(wait_status) == exit_code::kUsage) {
    on_refusal(child);
  }
}

void Supervisor::on_refusal(Child& child) {
  if (&child == &roudi_) return;
  if (!was_ready_ && refused_by_.empty()) refused_by_ = child.spec.name;
  if (++child.refusals < kConfigurationTries) return;
  child.given_up = true;
  note(EventKind::kGivenUp, child.spec.name, 0,
       "it refuses its configuration until a file changes: " + last_lines(log_of(child.spec.name), 1));
}

void Supervisor::forgive_delay_of_own() {
  const std::int64_t time_ns = now_ns();
  if (time_ns - polled_ns_ > kLongestPause_ns) {
    roudi_.last_stroke_ns = time_ns;
    for (Child& child : services_) child.last_stroke_ns = time_ns;
  }
  polled_ns_ = time_ns;
}

Verdict Supervisor::verdict_on_child(const Child& child) const {
  return verdict_on({.is_ready = child.ready, .started_ns = child.started_ns, .last_stroke_ns = child.last_stroke_ns},
                    domain_ready_ ? config_.service_ready_timeout_ns : config_.first_start_timeout_ns,
                    watchdog_timeout_of(child), now_ns());
}

std::int64_t Supervisor::watchdog_timeout_of(const Child& child) const {
  const bool is_on_data_path = &child != &roudi_ && child.spec.is_on_data_path;
  return is_on_data_path ? config_.watchdog_timeout_ns : config_.off_path_watchdog_timeout_ns;
}

void Supervisor::watch_services() {
  for (Child& child : services_) {
    if (child.pid == 0 || child.spec.role != Role::kService) continue;
    if (child.kill_at_ns != 0) {
      if (now_ns() > child.kill_at_ns) kill(-child.pid, SIGKILL);
      continue;
    }
    const Verdict verdict = verdict_on_child(child);
    if (verdict == Verdict::kSilent) end_hung(child, "no progress reported in time");
    // On the data path, reason_to_restart() deals with it.
    if (verdict == Verdict::kNotReady && !child.spec.is_on_data_path) end_hung(child, "not ready in time");
  }
}

void Supervisor::end_hung(Child& child, const std::string& reason) {
  note(EventKind::kHung, child.spec.name, child.pid, reason);
  kill(-child.pid, SIGABRT);
  child.kill_at_ns = now_ns() + config_.abort_timeout_ns;
}

void Supervisor::keep_house() {
  if (now_ns() - looked_ns_ < kHousekeepingPeriod_ns) return;
  looked_ns_ = now_ns();
  rotate_logs();
  for (Child& child : services_) {
    if (!child.given_up || fingerprint_of(config_.config_directory) == child.configuration) continue;
    child.given_up = false;
    child.refusals = 0;
    child.failures = 0;
  }
}

void Supervisor::rotate_logs() {
  static_cast<void>(rotate_log(log_of(roudi_.spec.name), config_.logs));
  for (const auto* children : {&services_, &independents_}) {
    for (const Child& child : *children) static_cast<void>(rotate_log(log_of(child.spec.name), config_.logs));
  }
}

void Supervisor::respawn() {
  for (Child& child : services_) {
    if (child.pid == 0 && !child.given_up && roudi_.ready && now_ns() >= child.start_at_ns) start_child(child);
  }
}

std::optional<std::string> Supervisor::reason_to_restart() const {
  if (roudi_.pid == 0) {
    return "RouDi ended: " + describe_exit(roudi_.wait_status.value_or(0)) + "; " + last_lines(log_of("roudi"), 1);
  }
  // After a failed start in restart_domain(): the process runs, but nothing waits for it.
  if (!roudi_.ready) return "RouDi is not ready in time";
  if (verdict_on_child(roudi_) == Verdict::kSilent) return "RouDi's watchdog is silent";
  if (segment_inodes(config_.places, segments_) != inodes_) return "the shared memory was replaced or removed";
  for (const Child& child : services_) {
    if (child.pid == 0 || child.spec.role != Role::kService || !child.spec.is_on_data_path) continue;
    if (verdict_on_child(child) == Verdict::kNotReady) return child.spec.name + " does not become ready";
  }
  return std::nullopt;
}

bool Supervisor::all_ready() const {
  return roudi_.ready && std::all_of(services_.begin(), services_.end(), [](const Child& child) {
           return child.ready || child.given_up || child.spec.role == Role::kSpectator;
         });
}

}  // namespace boresight::supervisor
