#include "deploy/supervisor/held_name.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <system_error>
#include <utility>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace boresight::supervisor {

std::optional<HeldName> HeldName::take(const std::string& name, const std::filesystem::path& folder) {
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) throw std::system_error(errno, std::generic_category(), folder.string());
  // An abstract socket: its name begins with a zero byte and is no file.
  const std::string full =
      std::string(1, '\0') + name + "-" + std::to_string(status.st_dev) + "-" + std::to_string(status.st_ino);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (full.size() > sizeof(address.sun_path)) throw std::system_error(ENAMETOOLONG, std::generic_category(), name);
  std::memcpy(address.sun_path, full.data(), full.size());
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "socket");
  HeldName held(descriptor);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + full.size());
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), size) == 0) return held;
  if (errno == EADDRINUSE) return std::nullopt;
  throw std::system_error(errno, std::generic_category(), name);
}

HeldName::~HeldName() {
  if (descriptor_ >= 0) close(descriptor_);
}

HeldName::HeldName(HeldName&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

HeldName& HeldName::operator=(HeldName&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

}  // namespace boresight::supervisor
