#include "deploy/supervisor/supervisor.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>
#include <system_error>

#include <sys/wait.h>

#include "deploy/supervisor/clock.hpp"
#include "deploy/supervisor/configuration_watch.hpp"

namespace boresight::supervisor {

namespace {

// No descriptor reports the end of any child, so the supervisor polls. This period costs little and is short compared
// with the duration of a restart.
constexpr std::int64_t kLook_ns = 10'000'000;
// The most failed starts in a row that count for the delay of a domain restart, which is then one second.
constexpr std::uint32_t kMaxCountedFailures = 4;

}  // namespace

std::string_view name_of(EventKind kind) {
  static constexpr std::array<std::string_view, 9> kNames = {
      "spawned", "ready", "exited", "start failed", "domain restart", "domain ready", "stopped", "hung", "given up"};
  return kNames[static_cast<std::size_t>(kind)];
}

Supervisor::Supervisor(DomainConfig config) : config_(std::move(config)) {
  config_.run_directory = std::filesystem::absolute(config_.run_directory);  // sd_notify ignores a relative path
  roudi_.spec.name = "roudi";
  roudi_.spec.command = config_.roudi;
  for (const ProcessSpec& spec : config_.services) services_.push_back({.spec = spec});
}

Supervisor::~Supervisor() {
  try {
    stop();
  } catch (const std::exception&) {
    // A destructor cannot report errors. All processes that could be stopped are stopped.
  }
}

void Supervisor::take_names(const std::function<bool()>& cancelled) {
  const std::filesystem::path& folder = config_.places.sockets;
  supervisor_name_ = HeldName::take("boresight-supervisor", folder);
  if (!supervisor_name_) throw std::runtime_error("another domain runs on this machine; stop its supervisor first");
  const std::int64_t deadline_ns = now_ns() + config_.guardian_timeout_ns;
  while (!(domain_name_ = HeldName::take("boresight-domain", folder))) {
    if (cancelled && cancelled()) throw std::runtime_error("stopped while the last domain ends");
    if (now_ns() > deadline_ns) {
      throw std::runtime_error("the guardian of a killed supervisor does not end; stop this process first");
    }
    sleep_ns(kLook_ns);
  }
}

void Supervisor::start(const std::function<bool()>& cancelled) {
  if (running_) return;
  try {
    take_names(cancelled);
    if (const auto reason = running_roudi(config_.places)) throw std::runtime_error(*reason);
  } catch (...) {
    supervisor_name_.reset();
    domain_name_.reset();
    throw;
  }
  running_ = true;
  try {
    std::filesystem::create_directories(config_.log_directory);
    made_run_directory_ = std::filesystem::create_directories(config_.run_directory);
    guardian_ = std::make_unique<Guardian>(config_.places, domain_name_->descriptor());
    if (made_run_directory_) guardian_->watch_directory(config_.run_directory);
    const std::filesystem::path socket = config_.run_directory / "notify";
    notifications_ = Notifications(socket);
    guardian_->watch_file(socket);
    for (const auto& file : leftovers(config_.places, {}, runtime_names())) guardian_->watch_bus_file(file);
    start_domain(cancelled);
  } catch (...) {
    stop();
    throw;
  }
}

void Supervisor::start_domain(const std::function<bool()>& cancelled) {
  domain_ready_ = false;
  start_roudi(cancelled);
  for (Child& child : services_) {
    if (child.pid == 0 && !child.given_up) start_child(child);
  }
}

void Supervisor::start_roudi(const std::function<bool()>& cancelled) {
  start_child(roudi_);
  if (roudi_.pid == 0) throw std::runtime_error(events_.back().detail);
  const std::int64_t deadline_ns = now_ns() + config_.roudi_ready_timeout_ns;
  while (!roudi_.ready) {
    if (cancelled && cancelled()) throw std::runtime_error("stopped while RouDi starts");
    if (now_ns() > deadline_ns) throw std::runtime_error("RouDi is not ready in time; see " + log_of("roudi").string());
    notifications_.wait(kLook_ns);
    read_notifications();
    reap();
    if (roudi_.pid == 0) {
      throw std::runtime_error("RouDi ended while it started (" + describe_exit(roudi_.wait_status.value_or(0)) +
                               "); see " + log_of("roudi").string());
    }
  }
}

void Supervisor::start_child(Child& child) {
  Command command = child.spec.command;
  command.environment.emplace_back("NOTIFY_SOCKET", (config_.run_directory / "notify").string());
  command.environment.emplace_back("WATCHDOG_USEC", std::to_string(watchdog_timeout_of(child) / 1000));
  child.ready = false;
  child.kill_at_ns = 0;
  child.wait_status.reset();
  child.started_ns = now_ns();
  if (child.refusals > 0) child.configuration = fingerprint_of(config_.config_directory);
  try {
    const auto log = child.spec.shares_terminal ? std::filesystem::path() : log_of(child.spec.name);
    child.pid = spawn(command, log);
  } catch (const std::system_error& error) {
    child.pid = 0;
    ++child.failures;
    // A program that cannot be executed now is not tried again at once.
    child.start_at_ns = now_ns() + restart_delay_ns(child.failures + 1);
    note(EventKind::kStartFailed, child.spec.name, 0, error.what());
    return;
  }
  guardian_->watch_process(child.pid);
  note(EventKind::kSpawned, child.spec.name, child.pid, "");
}

void Supervisor::start_independent(const ProcessSpec& spec) {
  Child child{.spec = spec};
  const auto log = spec.shares_terminal ? std::filesystem::path() : log_of(spec.name);
  child.started_ns = now_ns();
  child.pid = spawn(spec.command, log);
  guardian_->watch_process(child.pid);
  note(EventKind::kSpawned, spec.name, child.pid, "");
  independents_.push_back(std::move(child));
}

void Supervisor::poll(std::int64_t timeout_ns) {
  if (!running_) return;
  const std::int64_t until_ns = now_ns() + timeout_ns;
  do {
    read_notifications();
    reap();
    forgive_delay_of_own();
    watch_services();
    if (const auto reason = reason_to_restart()) restart_domain(*reason);
    keep_house();
    respawn();
    if (!domain_ready_ && all_ready()) {
      domain_ready_ = was_ready_ = true;
      note(EventKind::kDomainReady, "", 0, "");
    }
    const std::int64_t left_ns = until_ns - now_ns();
    if (left_ns > 0) notifications_.wait(std::min(left_ns, kLook_ns));
  } while (now_ns() < until_ns);
}

void Supervisor::restart_domain(const std::string& reason) {
  note(EventKind::kDomainRestart, "", 0, reason);
  ++domain_restarts_;
  // A domain that was ready is back as fast as possible. One that fails while it starts is tried later each time.
  failed_starts_ = domain_ready_ ? 0 : failed_starts_ + 1;
  stop_domain(false);
  for (Child& child : services_) child.failures = 0;  // their end is no failure of theirs
  sleep_ns(restart_delay_ns(std::min(failed_starts_, kMaxCountedFailures)));
  try {
    start_domain({});
  } catch (const std::runtime_error& error) {
    // The next poll() finds RouDi missing or not ready, and tries again, later each time.
    note(EventKind::kStartFailed, "roudi", 0, error.what());
  }
  polled_ns_ = now_ns();
}

void Supervisor::stop() {
  if (!running_) return;
  stop_domain(true);
  std::error_code ignored;
  std::filesystem::remove(config_.run_directory / "notify", ignored);
  if (made_run_directory_) std::filesystem::remove_all(config_.run_directory, ignored);
  notifications_ = Notifications();
  guardian_.reset();
  domain_name_.reset();
  supervisor_name_.reset();
  running_ = false;
  note(EventKind::kStopped, "", 0, "");
}

void Supervisor::stop_domain(bool for_good) {
  std::vector<Child*> children;
  for (Child& child : services_) children.push_back(&child);
  if (for_good) {
    for (Child& child : independents_) children.push_back(&child);
  }
  terminate(children, for_good ? config_.stop_timeout_ns : config_.dead_domain_timeout_ns);
  // RouDi last: it would terminate all registered processes itself, and keep their memory meanwhile. Before a restart
  // it is killed, as its memory is removed anyway.
  terminate({&roudi_}, for_good ? config_.stop_timeout_ns : 0);
  wait_for_end_of_roudi(config_.places);
  remove_leftovers();
}

void Supervisor::terminate(const std::vector<Child*>& children, std::int64_t timeout_ns) {
  const auto signal_all = [&children](int number) {
    for (const Child* child : children) {
      if (child->pid != 0) kill(-child->pid, number);
    }
  };
  const auto any_runs = [&children] {
    return std::any_of(children.begin(), children.end(), [](const Child* child) { return child->pid != 0; });
  };
  const std::int64_t deadline_ns = now_ns() + timeout_ns;
  if (timeout_ns > 0) signal_all(SIGTERM);
  for (bool killed = false; any_runs(); sleep_ns(2'000'000)) {
    if (!killed && now_ns() >= deadline_ns) {
      signal_all(SIGKILL);
      killed = true;
    }
    read_notifications();  // a full socket would block services that report STOPPING
    for (Child* child : children) {
      int status = 0;
      if (child->pid != 0 && waitpid(child->pid, &status, WNOHANG) == child->pid) on_exit(*child, status);
    }
  }
}

std::vector<std::string> Supervisor::runtime_names() const {
  std::vector<std::string> names;
  for (const Child& child : services_) {
    if (!child.spec.runtime_name.empty()) names.push_back(child.spec.runtime_name);
  }
  return names;
}

void Supervisor::remove_leftovers() {
  // Another RouDi may have started meanwhile. It holds the lock, and the files are then its own.
  if (running_roudi(config_.places)) return;
  std::error_code ignored;
  for (const auto& file : leftovers(config_.places, segments_, runtime_names())) {
    std::filesystem::remove(file, ignored);
  }
}

std::optional<int> Supervisor::independent_result(std::string_view name) const {
  for (const Child& child : independents_) {
    if (child.spec.name == name) return child.wait_status;
  }
  return std::nullopt;
}

const std::vector<Event>& Supervisor::events() const {
  return events_;
}

std::uint32_t Supervisor::domain_restarts() const {
  return domain_restarts_;
}

pid_t Supervisor::pid_of(std::string_view name) const {
  for (const auto* children : {&services_, &independents_}) {
    for (const Child& child : *children) {
      if (child.spec.name == name) return child.pid;
    }
  }
  return 0;
}

pid_t Supervisor::roudi_pid() const {
  return roudi_.pid;
}

void Supervisor::note(EventKind kind, std::string_view process, pid_t pid, std::string detail) {
  events_.push_back({now_ns(), kind, std::string(process), pid, std::move(detail)});
}

std::filesystem::path Supervisor::log_of(const std::string& name) const {
  return config_.log_directory / (name + ".log");
}

}  // namespace boresight::supervisor
