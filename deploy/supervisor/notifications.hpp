// The datagram socket to which services report READY=1 and WATCHDOG=1, as they do to systemd.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace boresight::supervisor {

class Notifications {
 public:
  Notifications() = default;
  /// Binds a socket to `path`, whose name must be short. Throws std::system_error.
  explicit Notifications(const std::filesystem::path& path);
  ~Notifications();
  Notifications(Notifications&& other) noexcept;
  Notifications& operator=(Notifications&& other) noexcept;

  struct Message {
    pid_t sender;
    std::string text;  ///< lines NAME=VALUE
  };
  /// Every message that waits; does not block.
  [[nodiscard]] std::vector<Message> take() const;
  /// Waits until a message comes or the time is over.
  void wait(std::int64_t timeout_ns) const;

 private:
  int descriptor_ = -1;
};

/// The value of the line NAME=VALUE; empty without such a line.
[[nodiscard]] std::string_view value_in(std::string_view message, std::string_view name);

}  // namespace boresight::supervisor
