// A second, small process that cleans up if the supervisor is killed.
#pragma once

#include <filesystem>

#include <sys/types.h>

#include "deploy/supervisor/leftovers.hpp"

namespace boresight::supervisor {

/// Forks a guardian that has a list of the domain's processes and files. If the supervisor ends without dismissing the
/// guardian, the guardian ends those processes (SIGTERM, then SIGKILL) and removes those files. If a RouDi runs after
/// that, it is another domain's, and iceoryx's files stay.
class Guardian {
 public:
  /// The guardian keeps `held` open until its own end; -1: nothing. Throws std::system_error.
  Guardian(const Places& places, int held);
  /// Dismisses the guardian: the supervisor has cleaned up itself.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  void watch_process(pid_t pid);
  void forget_process(pid_t pid);
  /// A file of the supervisor itself.
  void watch_file(const std::filesystem::path& file);
  /// A file of iceoryx in one of the places.
  void watch_bus_file(const std::filesystem::path& file);
  /// Includes all files in it.
  void watch_directory(const std::filesystem::path& directory);

 private:
  void send_command(char command, const std::string& text);
  int line_ = -1;
  pid_t pid_ = -1;
};

}  // namespace boresight::supervisor
