// RouDi as a child process whose output is read through a pipe.
#pragma once

#include <string>

#include <sys/types.h>

namespace boresight::broker {

/// Stays in the caller's process group, so that one signal to the group reaches both. SIGKILL ends it with its parent.
class BrokerProcess {
 public:
  /// Starts the program `arguments[0]`, searched in $PATH if it has no slash, with default signal handling. Throws
  /// std::system_error if no process or pipe can be made. A program that cannot be executed ends with code 127.
  explicit BrokerProcess(char* const* arguments);
  /// Kills the process if it still runs, and waits for its end.
  ~BrokerProcess();
  BrokerProcess(const BrokerProcess&) = delete;
  BrokerProcess& operator=(const BrokerProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Non-blocking; readable when there is output.
  [[nodiscard]] int output() const { return output_; }
  /// The output since the last call; may be empty.
  [[nodiscard]] std::string take_output() const;
  void send(int signal) const;
  /// True once the process has ended; then wait_status() is valid.
  [[nodiscard]] bool has_ended();
  [[nodiscard]] int wait_status() const { return wait_status_; }

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  int wait_status_ = 0;
  bool has_ended_ = false;
};

}  // namespace boresight::broker
