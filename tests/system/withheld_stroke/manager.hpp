// The service manager's side of the watchdog: a process that receives and counts the strokes of all services.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <sys/types.h>

#include "tests/system/harness/child.hpp"

namespace boresight::harness {

/// Sets $NOTIFY_SOCKET for the processes that the test starts later.
class Manager {
 public:
  Manager();
  [[nodiscard]] Child& process() { return *process_; }
  /// Strokes of a process so far.
  [[nodiscard]] std::uint64_t strokes_of(pid_t pid) const;
  /// Strokes of a process during the next seconds.
  [[nodiscard]] std::uint64_t strokes_within(pid_t pid, double seconds) const;
  /// The longest time between two strokes of a process, or since the last one; 0 before the first.
  [[nodiscard]] double longest_gap_s(pid_t pid) const;

 private:
  struct Service {
    volatile pid_t pid;
    volatile std::uint64_t strokes;
    volatile std::int64_t last_ns;
    volatile std::int64_t longest_gap_ns;
  };
  using Services = std::array<Service, 16>;
  [[noreturn]] static void receive(int socket, Services& services);
  [[nodiscard]] const Service* find(pid_t pid) const;

  Shared<Services> services_;
  std::unique_ptr<Child> process_;
};

}  // namespace boresight::harness
