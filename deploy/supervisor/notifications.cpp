#include "deploy/supervisor/notifications.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace boresight::supervisor {

namespace {

/// -1 and errno on failure.
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

Notifications::Notifications(const std::filesystem::path& path) : descriptor_(bind_notifications(path)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path.string());
}

Notifications::~Notifications() {
  if (descriptor_ >= 0) close(descriptor_);
}

Notifications::Notifications(Notifications&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Notifications& Notifications::operator=(Notifications&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

std::vector<Notifications::Message> Notifications::take() const {
  std::vector<Message> messages;
  for (;;) {
    std::array<char, 1024> text{};
    iovec data{.iov_base = text.data(), .iov_len = text.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(descriptor_, &message, MSG_CMSG_CLOEXEC);
    if (size <= 0) return messages;
    const cmsghdr* const header = CMSG_FIRSTHDR(&message);
    if (header == nullptr || header->cmsg_type != SCM_CREDENTIALS) continue;
    ucred sender{};
    std::memcpy(&sender, CMSG_DATA(header), sizeof(sender));
    messages.push_back({.sender = sender.pid, .text = std::string(text.data(), static_cast<std::size_t>(size))});
  }
}

void Notifications::wait(std::int64_t timeout_ns) const {
  pollfd polled{.fd = descriptor_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = timeout_ns / 1'000'000'000, .tv_nsec = timeout_ns % 1'000'000'000};
  ppoll(&polled, 1, &timeout, nullptr);
}

std::string_view value_in(std::string_view message, std::string_view name) {
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    const std::string_view line = message.substr(0, end);
    if (line.size() > name.size() && line.starts_with(name) && line[name.size()] == '=') {
      return line.substr(name.size() + 1);
    }
    message = end == std::string_view::npos ? std::string_view() : message.substr(end + 1);
  }
  return {};
}

}  // namespace boresight::supervisor
