#include "deploy/supervisor/supervisor.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace boresight::supervisor {

namespace {

constexpr std::string_view kRoudiReady = "RouDi is ready for clients";
// No descriptor reports the end of any child, so the supervisor polls. This period costs little and is short compared
// with the duration of a restart.
constexpr std::int64_t kLook_ns = 10'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

void sleep_ns(std::int64_t duration_ns) {
  const timespec duration{.tv_sec = duration_ns / 1'000'000'000, .tv_nsec = duration_ns % 1'000'000'000};
  nanosleep(&duration, nullptr);
}

/// The file's content from `offset` on; empty if it cannot be read.
std::string text_after(const std::filesystem::path& file, std::uintmax_t offset) {
  std::ifstream input(file, std::ios::binary);
  input.seekg(static_cast<std::streamoff>(offset));
  std::ostringstream text;
  text << input.rdbuf();
  return text.str();
}

/// A datagram socket bound to `path` that reports the sender's process id; -1 and errno on failure.
int bind_notifications(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.string().size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::memcpy(address.sun_path, path.c_str(), path.string().size());
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return -1;
  unlink(path.c_str());
  const int yes = 1;
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      setsockopt(descriptor, SOL_SOCKET, SO_PASSCRED, &yes, sizeof(yes)) != 0) {
    const int error = errno;
    close(descriptor);
    errno = error;
    return -1;
  }
  return descriptor;
}

}  // namespace

std::string_view name_of(EventKind kind) {
  static constexpr std::array<std::string_view, 7> kNames = {"spawned",        "ready",        "exited", "start failed",
                                                             "domain restart", "domain ready", "stopped"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::int64_t restart_delay_ns(std::uint32_t failures) {
  constexpr std::int64_t kFirst_ns = 250'000'000;
  constexpr std::int64_t kLongest_ns = 5'000'000'000;
  if (failures <= 1) return 0;
  const std::uint32_t doublings = std::min(failures - 2, 8U);
  return std::min(kLongest_ns, kFirst_ns << doublings);
}

Supervisor::Supervisor(DomainConfig config) : config_(std::move(config)) {
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
  if (notifications_ >= 0) close(notifications_);
}

void Supervisor::start(const std::function<bool()>& cancelled) {
  if (running_) return;
  if (const auto reason = running_roudi(config_.places)) throw std::runtime_error(*reason);
  std::filesystem::create_directories(config_.log_directory);
  made_run_directory_ = std::filesystem::create_directories(config_.run_directory);
  guardian_ = std::make_unique<Guardian>();
  if (made_run_directory_) guardian_->watch_directory(config_.run_directory);
  const std::filesystem::path socket = config_.run_directory / "notify";
  if (notifications_ < 0) notifications_ = bind_notifications(socket);
  if (notifications_ < 0) throw std::system_error(errno, std::generic_category(), socket.string());
  guardian_->watch_file(socket);
  std::vector<std::string> runtime_names;
  for (const Child& child : services_) {
    if (!child.spec.runtime_name.empty()) runtime_names.push_back(child.spec.runtime_name);
  }
  for (const auto& file : leftovers(config_.places, {}, runtime_names)) guardian_->watch_file(file);
  running_ = true;
  try {
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
    child.failures = 0;
    start_child(child);
  }
}

void Supervisor::start_roudi(const std::function<bool()>& cancelled) {
  const std::filesystem::path log = log_of("roudi");
  std::error_code ignored;
  const std::uintmax_t before = std::filesystem::exists(log, ignored) ? std::filesystem::file_size(log) : 0;
  start_child(roudi_);
  if (roudi_.pid == 0) throw std::runtime_error("cannot start RouDi: " + events_.back().detail);
  const std::int64_t deadline_ns = now_ns() + config_.roudi_ready_timeout_ns;
  std::string output;
  while (output.find(kRoudiReady) == std::string::npos) {
    read_notifications();
    reap();
    if (roudi_.pid == 0) throw std::runtime_error("RouDi ended instead of becoming ready; see " + log.string());
    if (now_ns() > deadline_ns) throw std::runtime_error("RouDi does not become ready; see " + log.string());
    if (cancelled && cancelled()) throw std::runtime_error("stopped while starting RouDi");
    sleep_ns(5'000'000);
    output = text_after(log, before);
  }
  roudi_.ready = true;
  segments_ = reserved_segments(output);
  for (const std::string& name : segments_) guardian_->watch_file(config_.places.shared_memory / name);
  management_inode_ = management_inode(config_.places);
  note(EventKind::kReady, "roudi", roudi_.pid, "");
}

void Supervisor::start_child(Child& child) {
  Command command = child.spec.command;
  command.environment.emplace_back("NOTIFY_SOCKET", (config_.run_directory / "notify").string());
  child.ready = false;
  child.wait_status.reset();
  child.started_ns = now_ns();
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
    if (const auto reason = reason_to_restart()) restart_domain(*reason);
    respawn();
    if (!domain_ready_ && all_ready()) {
      domain_ready_ = true;
      note(EventKind::kDomainReady, "", 0, "");
    }
    const std::int64_t left_ns = until_ns - now_ns();
    if (left_ns > 0) wait_for_something(std::min(left_ns, kLook_ns));
  } while (now_ns() < until_ns);
}

void Supervisor::wait_for_something(std::int64_t timeout_ns) {
  pollfd polled{.fd = notifications_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = timeout_ns / 1'000'000'000, .tv_nsec = timeout_ns % 1'000'000'000};
  ppoll(&polled, 1, &timeout, nullptr);
}

void Supervisor::read_notifications() {
  for (;;) {
    std::array<char, 512> text{};
    iovec data{.iov_base = text.data(), .iov_len = text.size() - 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    if (recvmsg(notifications_, &message, MSG_CMSG_CLOEXEC) <= 0) return;
    const cmsghdr* const header = CMSG_FIRSTHDR(&message);
    if (header == nullptr || header->cmsg_type != SCM_CREDENTIALS) continue;
    ucred sender{};
    std::memcpy(&sender, CMSG_DATA(header), sizeof(sender));
    if (std::strstr(text.data(), "READY=1") == nullptr) continue;
    for (Child& child : services_) {
      if (child.pid != sender.pid || child.ready) continue;
      child.ready = true;
      note(EventKind::kReady, child.spec.name, child.pid, "");
    }
  }
}

void Supervisor::reap() {
  const auto look = [this](Child& child) {
    int status = 0;
    if (child.pid != 0 && waitpid(child.pid, &status, WNOHANG) == child.pid) on_exit(child, status);
  };
  look(roudi_);
  for (Child& child : services_) look(child);
  for (Child& child : independents_) look(child);
}

void Supervisor::on_exit(Child& child, int wait_status) {
  const std::int64_t time_ns = now_ns();
  note(EventKind::kExited, child.spec.name, child.pid, describe_exit(wait_status));
  guardian_->forget_process(child.pid);
  child.failures = time_ns - child.started_ns > config_.stable_after_ns ? 1 : child.failures + 1;
  child.start_at_ns = time_ns + restart_delay_ns(child.failures);
  child.wait_status = wait_status;
  child.pid = 0;
  child.ready = false;
}

void Supervisor::respawn() {
  for (Child& child : services_) {
    if (child.pid == 0 && now_ns() >= child.start_at_ns) start_child(child);
  }
}

std::optional<std::string> Supervisor::reason_to_restart() const {
  if (roudi_.pid == 0) return "RouDi ended: " + describe_exit(roudi_.wait_status.value_or(0));
  if (management_inode(config_.places) != management_inode_) return "the management memory was replaced or removed";
  for (const Child& child : services_) {
    if (child.pid == 0 || child.ready || child.spec.role != Role::kService) continue;
    const std::int64_t limit_ns = domain_ready_ ? config_.service_ready_timeout_ns : config_.first_start_timeout_ns;
    if (now_ns() - child.started_ns > limit_ns) return child.spec.name + " does not become ready";
  }
  return std::nullopt;
}

void Supervisor::restart_domain(const std::string& reason) {
  note(EventKind::kDomainRestart, "", 0, reason);
  ++domain_restarts_;
  stop_domain(false);
  // Every exit of RouDi counts, whatever its cause: at once the first time, at most a second later after that.
  sleep_ns(restart_delay_ns(std::min(roudi_.failures, 4U)));
  try {
    start_domain({});
  } catch (const std::runtime_error& error) {
    // The next poll() finds RouDi missing and tries again, later each time.
    note(EventKind::kStartFailed, "roudi", 0, error.what());
  }
}

void Supervisor::stop() {
  if (!running_) return;
  stop_domain(true);
  std::error_code ignored;
  std::filesystem::remove(config_.run_directory / "notify", ignored);
  if (made_run_directory_) std::filesystem::remove_all(config_.run_directory, ignored);
  close(notifications_);
  notifications_ = -1;
  guardian_.reset();
  running_ = false;
  note(EventKind::kStopped, "", 0, "");
}

void Supervisor::stop_domain(bool including_independent) {
  std::vector<Child*> children;
  for (Child& child : services_) children.push_back(&child);
  if (including_independent) {
    for (Child& child : independents_) children.push_back(&child);
  }
  terminate(children);
  // RouDi last: it would terminate all registered processes itself, and keep their memory meanwhile.
  terminate({&roudi_});
  remove_leftovers();
}

void Supervisor::terminate(const std::vector<Child*>& children) {
  const auto any_runs = [&children] {
    return std::any_of(children.begin(), children.end(), [](const Child* child) { return child->pid != 0; });
  };
  for (const Child* child : children) {
    if (child->pid != 0) kill(-child->pid, SIGTERM);
  }
  const std::int64_t deadline_ns = now_ns() + config_.stop_timeout_ns;
  for (bool killed = false; any_runs(); sleep_ns(2'000'000)) {
    read_notifications();  // a full socket would block services that report STOPPING
    for (Child* child : children) {
      int status = 0;
      if (child->pid != 0 && waitpid(child->pid, &status, WNOHANG) == child->pid) on_exit(*child, status);
    }
    if (killed || now_ns() < deadline_ns) continue;
    for (const Child* child : children) {
      if (child->pid != 0) kill(-child->pid, SIGKILL);
    }
    killed = true;
  }
}

void Supervisor::remove_leftovers() {
  std::vector<std::string> runtime_names;
  for (const Child& child : services_) {
    if (!child.spec.runtime_name.empty()) runtime_names.push_back(child.spec.runtime_name);
  }
  // Another RouDi may have started meanwhile. It holds the lock, and the files are then its own.
  if (running_roudi(config_.places)) return;
  std::error_code ignored;
  for (const auto& file : leftovers(config_.places, segments_, runtime_names)) {
    std::filesystem::remove(file, ignored);
  }
}

bool Supervisor::all_ready() const {
  return roudi_.ready && std::all_of(services_.begin(), services_.end(), [](const Child& child) {
           return child.ready || child.spec.role == Role::kSpectator;
         });
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
