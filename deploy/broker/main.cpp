// boresight-roudi [--members GROUP] PROGRAM [ARGUMENT…]: runs RouDi and is to a service manager what RouDi is not: a
// service that reports READY, strokes the watchdog as long as RouDi makes progress, and ends RouDi when it hangs.
// README.md beside this file.
#include <array>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "deploy/broker/admission/admission.hpp"
#include "deploy/broker/broker_process.hpp"
#include "deploy/broker/judgement/broker_progress.hpp"
#include "deploy/broker/judgement/thread_activity.hpp"
#include "deploy/supervisor/clock.hpp"
#include "deploy/supervisor/leftovers.hpp"
#include "deploy/supervisor/process.hpp"

namespace boresight::broker {

namespace {

constexpr std::string_view kReadyLine = "RouDi is ready for clients";
constexpr int kUsageCode = 2;    // as every program of the product
constexpr int kFailureCode = 1;  // as every failure of a service at run time; also a RouDi that hangs
constexpr int kSignalCodeBase = 128;
// RouDi gives its clients a second to end (-k 1). A RouDi that needs longer than that hangs.
constexpr std::int64_t kStopLimit_ns = 1'500'000'000;

/// SIGTERM and SIGINT ask for the end; SIGCHLD wakes the loop when RouDi ends.
int open_signals() {
  sigset_t awaited;
  sigemptyset(&awaited);
  for (const int number : {SIGTERM, SIGINT, SIGCHLD}) sigaddset(&awaited, number);
  sigprocmask(SIG_BLOCK, &awaited, nullptr);
  return signalfd(-1, &awaited, SFD_CLOEXEC | SFD_NONBLOCK);
}

bool stop_is_asked_for(int signals) {
  bool asked = false;
  for (signalfd_siginfo info{}; read(signals, &info, sizeof(info)) == static_cast<ssize_t>(sizeof(info));) {
    asked = asked || info.ssi_signo != SIGCHLD;
  }
  return asked;
}

/// A line of its own on standard error. A full disk must not end the domain, so errors are ignored.
void report(const std::string& text) {
  const std::string line = "boresight-roudi: " + text + "\n";
  static_cast<void>(!write(STDERR_FILENO, line.data(), line.size()));
}

/// READY, with the names of the shared memories, which the supervisor removes after a kill.
void notify_ready(const std::string& output) {
  std::string names;
  for (const std::string& name : supervisor::reserved_segments(output)) names += (names.empty() ? "" : " ") + name;
  sd_notifyf(0, "READY=1\nX_SEGMENTS=%s", names.c_str());
}

using supervisor::now_ns;

class Keeper {
 public:
  /// Members of the group `members` may register; without one, it is RouDi's own group.
  Keeper(char* const* arguments, std::optional<gid_t> members, const ProgressLimits& limits)
      : members_(members), signals_(open_signals()), roudi_(arguments), progress_(limits) {}

  /// Returns the exit code when RouDi has ended.
  int run() {
    while (!roudi_.has_ended()) {
      pass_output_on();
      if (stop_is_asked_for(signals_)) begin_stop();
      if (stop_at_ns_ != 0 && now_ns() > stop_at_ns_) roudi_.send(SIGKILL);
      if (is_ready_ && stop_at_ns_ == 0 && !makes_progress()) return kFailureCode;
      wait();
    }
    pass_output_on();
    if (stop_at_ns_ != 0) return 0;
    const int status = roudi_.wait_status();
    report("RouDi ended: " + supervisor::describe_exit(status));
    return WIFSIGNALED(status) ? kSignalCodeBase + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  void wait() {
    std::array<pollfd, 2> polled{
        {{.fd = signals_, .events = POLLIN, .revents = 0}, {.fd = roudi_.output(), .events = POLLIN, .revents = 0}}};
    const timespec period{.tv_sec = 0, .tv_nsec = kObservationPeriod_ns};
    ppoll(polled.data(), polled.size(), &period, nullptr);
    // After the end of its output, only the end of the process is left to wait for, and that is a signal.
    if ((polled[1].revents & POLLHUP) != 0) ppoll(polled.data(), 1, &period, nullptr);
  }

  void pass_output_on() {
    const std::string text = roudi_.take_output();
    if (text.empty()) return;
    static_cast<void>(!write(STDOUT_FILENO, text.data(), text.size()));
    if (is_ready_) return;
    output_ += text;
    if (output_.find(kReadyLine) == std::string::npos) return;
    if (members_) admit(supervisor::Places(), *members_);
    is_ready_ = true;
    notify_ready(output_);
  }

  void begin_stop() {
    if (stop_at_ns_ != 0) return;
    sd_notify(0, "STOPPING=1");
    roudi_.send(SIGTERM);
    stop_at_ns_ = now_ns() + kStopLimit_ns;
  }

  /// Observes RouDi once a period; false if it hangs. Then the end of this object kills it.
  bool makes_progress() {
    const std::int64_t time_ns = now_ns();
    if (time_ns < observed_ns_ + kObservationPeriod_ns) return true;
    observed_ns_ = time_ns;
    progress_.observe(time_ns, read_activity(roudi_.pid()));
    if (const auto reason = progress_.hung()) {
      report("RouDi hangs and is ended: " + *reason);
      return false;
    }
    if (!is_checked_ && !progress_.is_judgeable()) {
      report("RouDi's periodic threads are not found; its progress is not watched");
    }
    if (!is_checked_ && !progress_.sees_waits()) {
      report("the kernel does not show for what RouDi waits; one that only lacks a processor may be taken for hung");
    }
    is_checked_ = true;
    sd_notify(0, "WATCHDOG=1");
    return true;
  }

  std::optional<gid_t> members_;
  int signals_;
  BrokerProcess roudi_;
  BrokerProgress progress_;
  std::string output_;  ///< until RouDi is ready
  std::int64_t observed_ns_ = 0;
  std::int64_t stop_at_ns_ = 0;  ///< when RouDi is killed, if it is to stop; else 0
  bool is_ready_ = false;
  bool is_checked_ = false;  ///< whether the periodic threads are found
};

}  // namespace

}  // namespace boresight::broker

int main(int argc, char** argv) {
  using namespace boresight::broker;
  const std::string_view first = argc > 1 ? argv[1] : "";
  const bool has_members = first == "--members";
  const int program = has_members ? 3 : 1;
  if (argc <= program || (first.starts_with('-') && !has_members)) {
    report(
        "usage: boresight-roudi [--members GROUP] PROGRAM [ARGUMENT…], for example: boresight-roudi iox-roudi -m off "
        "-k 1");
    return kUsageCode;
  }
  try {
    signal(SIGPIPE, SIG_IGN);
    std::optional<gid_t> members;
    if (has_members) members = group_number(argv[2]);
    return Keeper(argv + program, members, limits_of([](const char* name) { return std::getenv(name); })).run();
  } catch (const std::invalid_argument& error) {
    report(error.what());
    return kUsageCode;
  } catch (const std::exception& error) {
    report(error.what());
    return kFailureCode;
  }
}
