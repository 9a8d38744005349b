// A second, tiny process that cleans up if the supervisor itself is killed.
#pragma once

#include <filesystem>

#include <sys/types.h>

namespace boresight::supervisor {

/// While it lives, a forked guardian knows every process and file of the domain. If the supervisor vanishes without a
/// word, the guardian ends those processes (SIGTERM, then SIGKILL) and removes those files.
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
  /// With everything in it.
  void watch_directory(const std::filesystem::path& directory);

 private:
  void tell(char what, const std::string& text);
  int line_ = -1;
  pid_t pid_ = -1;
};

}  // namespace boresight::supervisor
