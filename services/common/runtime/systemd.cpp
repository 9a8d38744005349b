#include "services/common/runtime/systemd.hpp"

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <sys/socket.h>
#include <sys/un.h>
#include <systemd/sd-daemon.h>

namespace boresight::runtime::systemd {

namespace {

/// Where strokes are sent to: $NOTIFY_SOCKET, a path or an abstract name that begins with @.
struct Manager {
  Manager() {
    const char* const name = std::getenv("NOTIFY_SOCKET");
    const std::string_view path = name == nullptr ? "" : name;
    if ((!path.starts_with('/') && !path.starts_with('@')) || path.size() >= sizeof(address.sun_path)) return;
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    if (path.front() == '@') address.sun_path[0] = '\0';
    length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
    descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  }

  sockaddr_un address{};
  socklen_t length = 0;
  int descriptor = -1;
};

}  // namespace

void notify_ready() {
  sd_notify(0, "READY=1");
}
void notify_stopping() {
  sd_notify(0, "STOPPING=1");
}
void stroke_watchdog() {
  static const Manager manager;
  if (manager.descriptor < 0) return;
  constexpr std::string_view kStroke = "WATCHDOG=1";
  static_cast<void>(sendto(manager.descriptor, kStroke.data(), kStroke.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                           reinterpret_cast<const sockaddr*>(&manager.address), manager.length));
}

}  // namespace boresight::runtime::systemd
