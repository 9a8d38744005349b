// Another process of a test: a function of the test that runs in a fork, because iceoryx allows one runtime per
// process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include <sys/types.h>

namespace boresight::harness {

/// Runs `body` in a fork; its return value, or 99 after a failed expectation in it, is the exit code. Killed at the
/// latest with this object. Start it from a process that has neither threads nor a Node.
class Child {
 public:
  explicit Child(const std::function<int()>& body);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  void send(int signal) const;
  /// The exit code, −signal if a signal ended it, or nothing if it still runs after the time.
  [[nodiscard]] std::optional<int> wait_for(double seconds);
  /// SIGTERM, then wait_for().
  [[nodiscard]] std::optional<int> stop(double seconds = 5.0);

 private:
  pid_t pid_ = -1;
  std::optional<int> result_;
};

/// Memory that forks share with the test, for a child's results. T must be trivial; it starts as zeros.
void* allocate_shared(std::size_t bytes);
void free_shared(void* memory, std::size_t bytes);

template <typename T>
class Shared {
 public:
  Shared() : value_(static_cast<T*>(allocate_shared(sizeof(T)))) {}
  ~Shared() { free_shared(value_, sizeof(T)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  T* operator->() const { return value_; }
  T& operator*() const { return *value_; }

 private:
  T* value_;
};

/// Checks every 5 ms; false if the condition did not become true in time.
[[nodiscard]] bool eventually(double seconds, const std::function<bool()>& condition);
void sleep_s(double seconds);

}  // namespace boresight::harness
