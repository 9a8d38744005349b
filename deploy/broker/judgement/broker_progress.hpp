// Judges whether RouDi makes progress. Pure: takes what the kernel reports of RouDi's threads, and the time.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deploy/broker/judgement/progress_limits.hpp"

namespace boresight::broker {

/// What a thread does at the moment of an observation, as the kernel reports it.
enum class ThreadState : std::uint8_t {
  kSleeping,  ///< waits for a timer, a message or a mutex
  kRunnable,  ///< runs, or waits for a processor
  kOnDisk,    ///< waits for a page or a file; no signal can end such a thread
  kStopped,   ///< stopped by SIGSTOP or by a debugger
};

/// What a sleeping thread waits for.
enum class Wait : std::uint8_t {
  kUnknown,         ///< not asleep, or the kernel does not show it
  kMutexOfTheDead,  ///< a mutex whose owner has ended: nobody will unlock it
  kMutexOfAnother,  ///< a mutex whose owner lives, and may wait for a processor itself
  kOther,           ///< a timer, a message
};

/// One thread of RouDi at one moment.
struct ThreadActivity {
  std::string name;                  ///< at most 15 characters, as in /proc/PID/task/TID/comm
  std::uint64_t voluntary_switches;  ///< how often the thread gave up the processor by itself, since its start
  std::int64_t processor_time_ns;    ///< since its start
  ThreadState state;
  Wait wait = Wait::kUnknown;
};

/// RouDi's two periodic threads wake every 100 ms, whether there is work or not: one receives registrations, one
/// connects ports. Each wake-up ends with a voluntary context switch. A mutex that a killed process left locked stops
/// both. The names are those of iceoryx 2.0.
inline constexpr const char* kMessageThread = "IPC-msg-process";
inline constexpr const char* kDiscoveryThread = "Mon+Discover";

/// Time between two observations, and the most that one of them adds to a silence. If the observer itself got no
/// processor, or the machine was suspended, the missed time counts nothing.
inline constexpr std::int64_t kObservationPeriod_ns = 50'000'000;

/// Call observe() every kObservationPeriod_ns once RouDi is ready.
class BrokerProgress {
 public:
  explicit BrokerProgress(const ProgressLimits& limits = {}) : limits_(limits) {}

  /// `threads`: all threads of RouDi; empty if they cannot be read, which is no progress and no hang.
  void observe(std::int64_t time_ns, const std::vector<ThreadActivity>& threads);

  /// The reason why RouDi is hung, or nothing. A thread that waits for a processor or a disk is not hung: to end RouDi
  /// would make a shortage worse. Neither is a thread that sleeps while another one waits so, as it may hold the mutex.
  [[nodiscard]] std::optional<std::string> hung() const;
  /// False if the last observation found none of the periodic threads: another version of iceoryx. Then nothing is
  /// judged.
  [[nodiscard]] bool is_judgeable() const { return is_judgeable_; }
  /// False if the last observation found a periodic thread asleep, and not for what it waits.
  [[nodiscard]] bool sees_waits() const { return sees_waits_; }

 private:
  struct Silence {
    std::uint64_t voluntary_switches = 0;
    std::int64_t asleep_ns = 0;      ///< observed time without a voluntary switch, asleep or stopped
    std::int64_t busy_since_ns = 0;  ///< processor time at the last voluntary switch
    std::int64_t busy_ns = 0;        ///< processor time since then
    bool is_stopped = false;
    Wait wait = Wait::kUnknown;
  };
  [[nodiscard]] std::int64_t limit_ns(const Silence& silence) const;

  ProgressLimits limits_;
  std::map<std::string, Silence> silences_;  ///< by the name of the periodic thread
  std::optional<std::int64_t> last_ns_;
  bool is_judgeable_ = false;
  bool sees_waits_ = true;
};

}  // namespace boresight::broker
