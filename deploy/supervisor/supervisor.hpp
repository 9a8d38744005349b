// Keeps one domain running: starts RouDi, then every service as a separate process, and restarts them after failures. A
// restarted service can rejoin a running RouDi; no service can rejoin a new RouDi.
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
#include "deploy/supervisor/leftovers.hpp"
#include "deploy/supervisor/process.hpp"

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
  bool shares_terminal = false;  ///< writes to the supervisor's own standard output instead of a log file
};

struct DomainConfig {
  Command roudi;
  std::vector<ProcessSpec> services;
  /// Holds the notification socket, whose path must be short. Removed at the end if it did not exist before.
  std::filesystem::path run_directory;
  std::filesystem::path log_directory;  ///< <name>.log of every process; created, and kept
  Places places;
  std::int64_t roudi_ready_timeout_ns = 10'000'000'000;
  /// The domain restarts if a restarted service does not report READY in this time: a process killed inside publish()
  /// leaves a mutex locked, which blocks registration.
  std::int64_t service_ready_timeout_ns = 3'000'000'000;
  std::int64_t first_start_timeout_ns = 20'000'000'000;  ///< the same for the first start, which reads files from disk
  std::int64_t stop_timeout_ns = 2'000'000'000;          ///< from SIGTERM to SIGKILL
  std::int64_t stable_after_ns = 10'000'000'000;         ///< a process that ran for longer is restarted at once
};

enum class EventKind : std::uint8_t {
  kSpawned,
  kReady,
  kExited,
  kStartFailed,
  kDomainRestart,
  kDomainReady,
  kStopped,
};
[[nodiscard]] std::string_view name_of(EventKind kind);

struct Event {
  std::int64_t time_ns;  ///< CLOCK_MONOTONIC
  EventKind kind;
  std::string process;  ///< "roudi", or the service's name; empty for the domain
  pid_t pid;            ///< 0 for the domain
  std::string detail;   ///< reason as text
};

/// Delay before a process is started again that failed `failures` times in a row: none the first time, then 0.25 s,
/// doubling up to 5 s.
[[nodiscard]] std::int64_t restart_delay_ns(std::uint32_t failures);

/// One thread; call poll() in a loop. The domain's processes end with the object, also if its process is killed.
class Supervisor {
 public:
  explicit Supervisor(DomainConfig config);
  /// Stops the domain if it still runs.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Starts RouDi, waits until it is ready, and starts the services, without waiting for them. Throws
  /// std::runtime_error if another RouDi runs, if ours does not become ready, or if `cancelled()` turns true meanwhile.
  void start(const std::function<bool()>& cancelled = {});
  /// Handles events and waits up to `timeout_ns` for more. A domain restart happens inside this call.
  void poll(std::int64_t timeout_ns);
  /// SIGTERM to the services, then to RouDi, SIGKILL after the time-out; then removes iceoryx's files.
  void stop();

  /// True when every service except spectators has reported READY.
  [[nodiscard]] bool all_ready() const;
  /// Starts a process of role kIndependent; its end is an event. Throws std::system_error if it cannot be executed.
  void start_independent(const ProcessSpec& spec);
  /// The wait status of an independent process that has ended.
  [[nodiscard]] std::optional<int> independent_result(std::string_view name) const;

  [[nodiscard]] const std::vector<Event>& events() const;
  [[nodiscard]] std::uint32_t domain_restarts() const;
  /// 0 if it is not running.
  [[nodiscard]] pid_t pid_of(std::string_view name) const;
  [[nodiscard]] pid_t roudi_pid() const;

 private:
  struct Child {
    ProcessSpec spec;
    pid_t pid = 0;
    bool ready = false;
    std::int64_t started_ns = 0;
    std::int64_t start_at_ns = 0;  ///< when to start it again, while it does not run
    std::uint32_t failures = 0;
    std::optional<int> wait_status = std::nullopt;
  };

  void start_domain(const std::function<bool()>& cancelled);
  void start_roudi(const std::function<bool()>& cancelled);
  void start_child(Child& child);
  void stop_domain(bool including_independent);
  void restart_domain(const std::string& reason);
  void wait_for_something(std::int64_t timeout_ns);
  void read_notifications();
  void reap();
  void on_exit(Child& child, int wait_status);
  void respawn();
  [[nodiscard]] std::optional<std::string> reason_to_restart() const;
  void terminate(const std::vector<Child*>& children);
  void remove_leftovers();
  void note(EventKind kind, std::string_view process, pid_t pid, std::string detail);
  [[nodiscard]] std::filesystem::path log_of(const std::string& name) const;

  DomainConfig config_;
  std::unique_ptr<Guardian> guardian_;
  Child roudi_;
  std::vector<Child> services_;
  std::vector<Child> independents_;
  std::vector<std::string> segments_;
  std::vector<Event> events_;
  ino_t management_inode_ = 0;
  int notifications_ = -1;  ///< datagram socket that the services get as $NOTIFY_SOCKET
  bool running_ = false;
  bool made_run_directory_ = false;
  bool domain_ready_ = false;
  std::uint32_t domain_restarts_ = 0;
};

}  // namespace boresight::supervisor
