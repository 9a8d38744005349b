#include "deploy/supervisor/guardian.hpp"

#include <cerrno>
#include <csignal>
#include <set>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "deploy/supervisor/process.hpp"

namespace boresight::supervisor {

namespace {

// From SIGTERM to SIGKILL. A healthy service ends in a twentieth of it, and a new supervisor waits meanwhile.
constexpr int kPatience_ms = 500;
constexpr int kLook_ms = 20;
constexpr int kFirstCopy = STDERR_FILENO + 3;

struct Charge {
  std::set<pid_t> processes;
  std::set<std::string> files;
  std::set<std::string> bus_files;
  std::set<std::string> directories;
  bool dismissed = false;
};

/// One line from the supervisor: '+' and '-' a process, 'f' a file, 'b' a file of iceoryx, 'd' a directory, '.' the
/// end.
void note(Charge& charge, const std::string& line) {
  if (line.empty()) return;
  const std::string text = line.substr(1);
  if (line[0] == '+') charge.processes.insert(std::stoi(text));
  if (line[0] == '-') charge.processes.erase(std::stoi(text));
  if (line[0] == 'f') charge.files.insert(text);
  if (line[0] == 'b') charge.bus_files.insert(text);
  if (line[0] == 'd') charge.directories.insert(text);
  if (line[0] == '.') charge.dismissed = true;
}

void end_processes(const Charge& charge) {
  for (const pid_t pid : charge.processes) kill(-pid, SIGTERM);
  for (int waited_ms = 0; waited_ms < kPatience_ms; waited_ms += kLook_ms) {
    bool any = false;
    for (const pid_t pid : charge.processes) any = any || is_running(pid);
    if (!any) return;
    usleep(kLook_ms * 1000);
  }
  for (const pid_t pid : charge.processes) kill(-pid, SIGKILL);
}

void remove_files(const Charge& charge, const Places& places) {
  for (const std::string& file : charge.files) unlink(file.c_str());
  std::error_code ignored;
  for (const std::string& directory : charge.directories) std::filesystem::remove_all(directory, ignored);
  wait_for_end_of_roudi(places);
  if (running_roudi(places)) return;
  for (const std::string& file : charge.bus_files) unlink(file.c_str());
}

[[noreturn]] void guard(const Places& places, int input, int held) {
  setsid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(number, SIG_IGN);
  // A reader of the supervisor's output must not wait for the guardian's end as well.
  const int null = open("/dev/null", O_RDWR);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, descriptor);
  // Through copies beyond both targets, so that neither target overwrites the other's source.
  input = fcntl(input, F_DUPFD, kFirstCopy);
  if (held >= 0) held = fcntl(held, F_DUPFD, kFirstCopy);
  input = dup2(input, STDERR_FILENO + 1);
  if (held >= 0) dup2(held, input + 1);
  closefrom(held >= 0 ? input + 2 : input + 1);
  Charge charge;
  std::string line;
  char c = 0;
  for (ssize_t got = 0; (got = read(input, &c, 1)) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) break;
    if (c != '\n') {
      line.push_back(c);
      continue;
    }
    note(charge, line);
    line.clear();
  }
  if (!charge.dismissed) {
    end_processes(charge);
    remove_files(charge, places);
  }
  _exit(0);
}

}  // namespace

Guardian::Guardian(const Places& places, int held) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  pid_ = fork();
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (pid_ == 0) {
    close(ends[1]);
    guard(places, ends[0], held);
  }
  close(ends[0]);
  line_ = ends[1];
}

Guardian::~Guardian() {
  send_command('.', "");
  close(line_);
  waitpid(pid_, nullptr, 0);
}

void Guardian::watch_process(pid_t pid) {
  send_command('+', std::to_string(pid));
}

void Guardian::forget_process(pid_t pid) {
  send_command('-', std::to_string(pid));
}

void Guardian::watch_file(const std::filesystem::path& file) {
  send_command('f', file.string());
}

void Guardian::watch_bus_file(const std::filesystem::path& file) {
  send_command('b', file.string());
}

void Guardian::watch_directory(const std::filesystem::path& directory) {
  send_command('d', directory.string());
}

void Guardian::send_command(char command, const std::string& text) {
  const std::string line = command + text + "\n";
  // The guardian may have been killed; the supervisor runs on without it.
  static_cast<void>(send(line_, line.data(), line.size(), MSG_NOSIGNAL));
}

}  // namespace boresight::supervisor
