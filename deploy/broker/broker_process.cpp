#include "deploy/broker/broker_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boresight::broker {

namespace {

/// Between fork and exec, in the child.
[[noreturn]] void become_broker(char* const* arguments, int output, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // the parent ended before the line above
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  // Only RouDi itself reports nothing to the service manager; its wrapper does.
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  execvp(arguments[0], arguments);
  dprintf(STDERR_FILENO, "cannot execute %s: %s\n", arguments[0], std::generic_category().message(errno).c_str());
  _exit(127);
}

}  // namespace

BrokerProcess::BrokerProcess(char* const* arguments) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become_broker(arguments, ends[1], parent);
  const int error = errno;
  close(ends[1]);
  if (pid_ < 0) {
    close(ends[0]);
    throw std::system_error(error, std::generic_category(), "fork");
  }
  output_ = ends[0];
  // Only the reading end: RouDi waits for room when it writes, as it would with a file.
  fcntl(output_, F_SETFL, O_NONBLOCK);
}

BrokerProcess::~BrokerProcess() {
  if (!has_ended_) {
    send(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(output_);
}

std::string BrokerProcess::take_output() const {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = read(output_, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return text;
}

void BrokerProcess::send(int signal) const {
  if (!has_ended_) kill(pid_, signal);
}

bool BrokerProcess::has_ended() {
  if (!has_ended_) has_ended_ = waitpid(pid_, &wait_status_, WNOHANG) == pid_;
  return has_ended_;
}

}  // namespace boresight::broker
