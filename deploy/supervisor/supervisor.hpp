// Keeps one domain running: starts RouDi, then every service as a separate process, and restarts those that end, hang
// or do not start. A restarted service can rejoin a running RouDi; no service can rejoin a new RouDi.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "deploy/supervisor/guardian.hpp"
#include "deploy/supervisor/held_name.hpp"
#include "deploy/supervisor/leftovers.hpp"
#include "deploy/supervisor/log_files.hpp"
#include "deploy/supervisor/notifications.hpp"
#include "deploy/supervisor/process.hpp"
#include "deploy/supervisor/rules.hpp"

namespace boresight::supervisor {

/// Determines the reaction to the end of a process or of the domain.
enum class Role : std::uint8_t {
  kService,      ///< member of the domain: restarted when it exits, and with every new RouDi
  kSpectator,    ///< as a service, but optional: the domain is ready without it (a monitor)
  kIndependent,  ///< not on the bus: started by `start_independent`, survives a domain restart, never restarted
};

struct ProcessSpec {
  std::string name;  ///< "tracker": in events, and <log directory>/<name>.log
  Command command;
  std::string runtime_name = {};  ///< on the bus, for removing its files; empty if it is not on the bus
  Role role = Role::kService;
  bool is_on_data_path = true;   ///< if it does not start beside a RouDi that makes progress, the domain restarts
  bool shares_terminal = false;  ///< writes to the supervisor's own standard output instead of a log file
};

struct DomainConfig {
  Command roudi;  ///< boresight-roudi, which reports READY and strokes the watchdog as services do
  std::vector<ProcessSpec> services;
  /// Holds the notification socket, whose path must be short. Removed at the end if it did not exist before.
  std::filesystem::path run_directory;
  std::filesystem::path log_directory;  ///< <name>.log of every process; created, and kept
  /// A service that was given up because of its configuration is tried again after a change below this folder.
  std::filesystem::path config_directory;
  LogLimits logs;
  Places places;
  std::int64_t roudi_ready_timeout_ns = 10'000'000'000;
  /// From the start of a service to READY while the domain runs; see ProcessSpec::is_on_data_path.
  std::int64_t service_ready_timeout_ns = 3'000'000'000;
  std::int64_t first_start_timeout_ns =
      20'000'000'000;  ///< the same while the domain starts: many processes, cold files
  /// As WatchdogSec= of the units on the data path: ten missed strokes. One that was stopped is back within two
  /// seconds.
  std::int64_t watchdog_timeout_ns = 1'000'000'000;
  /// The same of RouDi, whose wrapper ends it earlier, and of services off the data path. Health joins the DDS domain
  /// after its start, which takes a second on a busy machine.
  std::int64_t off_path_watchdog_timeout_ns = 2'000'000'000;
  std::int64_t abort_timeout_ns = 300'000'000;   ///< from SIGABRT to SIGKILL of a process that hangs
  std::int64_t stop_timeout_ns = 2'000'000'000;  ///< from SIGTERM to SIGKILL
  /// The same for the services of a domain whose RouDi is gone. A healthy service ends in a quarter of it; one that
  /// hangs in the old domain must not delay the new one.
  std::int64_t dead_domain_timeout_ns = 200'000'000;
  std::int64_t guardian_timeout_ns = 5'000'000'000;  ///< for the guardian of a killed supervisor to end its domain
  std::int64_t stable_after_ns = 10'000'000'000;     ///< a process that ran for longer is restarted at once
};

enum class EventKind : std::uint8_t {
  kSpawned,
  kReady,
  kExited,
  kStartFailed,
  kDomainRestart,
  kDomainReady,
  kStopped,
  kHung,     ///< ended by the supervisor, as it is not ready or silent for too long
  kGivenUp,  ///< not started again before a change of the configuration
};
[[nodiscard]] std::string_view name_of(EventKind kind);

struct Event {
  std::int64_t time_ns;  ///< CLOCK_MONOTONIC
  EventKind kind;
  std::string process;  ///< "roudi", or the service's name; empty for the domain
  pid_t pid;            ///< 0 for the domain
  std::string detail;   ///< reason as text
};

/// One thread; call poll() in a loop. The domain's processes end with the object, also if its process is killed.
class Supervisor {
 public:
  explicit Supervisor(DomainConfig config);
  /// Stops the domain if it still runs.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts RouDi, waits until it is ready, and starts the services, without waiting for them. Waits for the guardian
  /// of a killed supervisor. Throws std::runtime_error if another domain runs, if RouDi does not become ready, or if
  /// `cancelled()` turns true meanwhile.
  void start(const std::function<bool()>& cancelled = {});
  /// Handles events and waits up to `timeout_ns` for more. A domain restart happens inside this call.
  void poll(std::int64_t timeout_ns);
  /// SIGTERM to the services, then to RouDi, SIGKILL after the time-out; then removes iceoryx's files.
  void stop();

  /// The service that refused its configuration (exit code 2) before the domain was ready for the first time; empty:
  /// none. It would refuse it again, so the caller should stop.
  [[nodiscard]] const std::string& refused_by() const { return refused_by_; }
  /// True when every service has reported READY, except spectators and services that were given up.
  [[nodiscard]] bool all_ready() const;
  /// Starts a process of role kIndependent; its end is an event. Throws std::system_error if it cannot be executed.
  void start_independent(const ProcessSpec& spec);
  /// The wait status of an independent process that has ended.
  [[nodiscard]] std::optional<int> independent_result(std::string_view name) const;

  [[nodiscard]] const std::vector<Event>& events() const;
  [[nodiscard]] std::uint32_t domain_restarts() const;
  /// 0 if it is not running.
  [[nodiscard]] pid_t pid_of(std::string_view name) const;
  /// Of RouDi's wrapper, which runs RouDi as its only child.
  [[nodiscard]] pid_t roudi_pid() const;

 private:
  struct Child {
    ProcessSpec spec;
    pid_t pid = 0;
    bool ready = false;
    bool given_up = false;
    std::int64_t started_ns = 0;
    std::int64_t last_stroke_ns = 0;
    std::int64_t kill_at_ns = 0;   ///< when SIGKILL follows SIGABRT; 0: not asked to end
    std::int64_t start_at_ns = 0;  ///< when to start it again, while it does not run
    std::uint32_t failures = 0;
    std::uint32_t refusals = 0;       ///< exit code 2 in a row
    std::uint64_t configuration = 0;  ///< fingerprint at the start that followed a refusal
    std::optional<int> wait_status = std::nullopt;
  };

  void start_domain(const std::function<bool()>& cancelled);
  void start_roudi(const std::function<bool()>& cancelled);
  void take_names(const std::function<bool()>& cancelled);
  void start_child(Child& child);
  void stop_domain(bool for_good);
  void restart_domain(const std::string& reason);
  void read_notifications();
  void on_notification(Child& child, const std::string& message);
  void on_roudi_ready(std::string_view segments);
  void reap();
  void on_exit(Child& child, int wait_status);
  void on_refusal(Child& child);
  void forgive_delay_of_own();
  void watch_services();
  void end_hung(Child& child, const std::string& reason);
  void keep_house();
  void rotate_logs();
  void respawn();
  [[nodiscard]] std::optional<std::string> reason_to_restart() const;
  [[nodiscard]] Verdict verdict_on_child(const Child& child) const;
  [[nodiscard]] std::int64_t watchdog_timeout_of(const Child& child) const;
  void terminate(const std::vector<Child*>& children, std::int64_t timeout_ns);
  void remove_leftovers();
  [[nodiscard]] std::vector<std::string> runtime_names() const;
  void note(EventKind kind, std::string_view process, pid_t pid, std::string detail);
  [[nodiscard]] std::filesystem::path log_of(const std::string& name) const;

  DomainConfig config_;
  std::optional<HeldName> supervisor_name_;  ///< while this supervisor runs
  std::optional<HeldName> domain_name_;      ///< until the guardian has ended, too
  std::unique_ptr<Guardian> guardian_;
  Notifications notifications_;  ///< its path is the services' $NOTIFY_SOCKET
  Child roudi_;
  std::vector<Child> services_;
  std::vector<Child> independents_;
  std::vector<std::string> segments_;
  std::vector<ino_t> inodes_;  ///< of segments_
  std::vector<Event> events_;
  std::string refused_by_;
  std::int64_t polled_ns_ = 0;  ///< last time that messages were read
  std::int64_t looked_ns_ = 0;  ///< last time that logs and configuration were looked at
  bool running_ = false;
  bool made_run_directory_ = false;
  bool domain_ready_ = false;
  bool was_ready_ = false;  ///< the domain, once
  std::uint32_t domain_restarts_ = 0;
  std::uint32_t failed_starts_ = 0;  ///< domain restarts in a row before the domain was ready
};

}  // namespace boresight::supervisor
