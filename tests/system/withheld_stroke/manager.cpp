#include "tests/system/withheld_stroke/manager.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string_view>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"

namespace boresight::harness {

namespace {
constexpr const char* kNotifySocket = "/tmp/test_notify";
}

Manager::Manager() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, kNotifySocket, sizeof(address.sun_path) - 1);
  unlink(kNotifySocket);
  const int receiver = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  if (bind(receiver, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      setsockopt(receiver, SOL_SOCKET, SO_PASSCRED, &on, sizeof(on)) != 0) {
    throw std::runtime_error("cannot bind the notification socket");
  }
  setenv("NOTIFY_SOCKET", kNotifySocket, 1);
  process_ = std::make_unique<Child>([this, receiver]() -> int { receive(receiver, *services_); });
  close(receiver);
}

void Manager::receive(int socket, Services& services) {
  for (;;) {
    std::array<char, 256> text{};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
    iovec part{.iov_base = text.data(), .iov_len = text.size()};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket, &message, 0);
    const cmsghdr* const credentials = CMSG_FIRSTHDR(&message);
    if (length <= 0 || credentials == nullptr || credentials->cmsg_type != SCM_CREDENTIALS) continue;
    if (std::string_view(text.data(), static_cast<std::size_t>(length)) != "WATCHDOG=1") continue;
    ucred sender{};
    std::memcpy(&sender, CMSG_DATA(credentials), sizeof(sender));
    for (Service& service : services) {
      if (service.pid != 0 && service.pid != sender.pid) continue;
      service.pid = sender.pid;
      const std::int64_t now_ns = runtime::monotonic_now_ns();
      if (service.strokes > 0) service.longest_gap_ns = std::max(service.longest_gap_ns + 0, now_ns - service.last_ns);
      service.last_ns = now_ns;
      service.strokes = service.strokes + 1;
      break;
    }
  }
}

const Manager::Service* Manager::find(pid_t pid) const {
  const auto found = std::find_if(services_->begin(), services_->end(), [&](const Service& s) { return s.pid == pid; });
  return found == services_->end() ? nullptr : &*found;
}

std::uint64_t Manager::strokes_of(pid_t pid) const {
  const Service* const service = find(pid);
  return service == nullptr ? 0 : service->strokes;
}

std::uint64_t Manager::strokes_within(pid_t pid, double seconds) const {
  const std::uint64_t before = strokes_of(pid);
  sleep_s(seconds);
  return strokes_of(pid) - before;
}

double Manager::longest_gap_s(pid_t pid) const {
  const Service* const service = find(pid);
  if (service == nullptr) return 0.0;
  const std::int64_t since_last_ns = runtime::monotonic_now_ns() - service->last_ns;
  return 1e-9 * static_cast<double>(std::max(service->longest_gap_ns + 0, since_last_ns));
}

}  // namespace boresight::harness
