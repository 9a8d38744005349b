// A second, small process that cleans up if the supervisor is killed.
#pragma once

#include <filesystem>

#include <sys/types.h>

namespace boresight::supervisor {

/// Forks a guardian that has a list of the domain's processes and files. If the supervisor ends without dismissing the
/// guardian, the guardian ends those processes (SIGTERM, then SIGKILL) and removes those files.
class Guardian {
 public:
  Guardian();
  /// Dismisses the guardian: the supervisor has cleaned up itself.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  void watch_process(pid_t pid);
  void forget_process(pid_t pid);
  void watch_file(const std::filesystem::path& file);
  /// Includes all files in it.
  void watch_directory(const std::filesystem::path& directory);

 private:
  void send_command(char command, const std::string& text);
  int line_ = -1;
  pid_t pid_ = -1;
};

}  // namespace boresight::supervisor
