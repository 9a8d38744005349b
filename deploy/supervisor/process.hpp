// Starts a child process that ends with its parent.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

namespace boresight::supervisor {

/// What to execute. The environment is added to the supervisor's own.
struct Command {
  std::vector<std::string> arguments;  ///< arguments[0] is the program, searched in $PATH if it has no slash
  std::vector<std::pair<std::string, std::string>> environment;
};

/// Starts `command` in a session of its own, so that the terminal's Ctrl-C reaches only the supervisor. The child has
/// default signal handling and gets SIGTERM when the calling thread ends. Standard input is /dev/null. Output and
/// errors are appended to `log_file`, or shared with the caller if `log_file` is empty. A log that cannot be opened
/// (full disk) is no error: the output is discarded. Returns the process id, which is also the id of its process group.
/// Throws std::system_error if the program cannot be executed.
[[nodiscard]] pid_t spawn(const Command& command, const std::filesystem::path& log_file);

/// False for a process that has ended, also if nobody has waited for it yet.
[[nodiscard]] bool is_running(pid_t pid);

/// "exit code 3", "signal 9 (Killed)": the wait status in words.
[[nodiscard]] std::string describe_exit(int wait_status);

}  // namespace boresight::supervisor
