// Logs of processes that keep their file open: limited in size, and read for messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace boresight::supervisor {

struct LogLimits {
  std::uintmax_t max_bytes = 10'000'000;  ///< a longer log is moved to <name>.1
  std::size_t kept_files = 3;             ///< <name>.1 is the newest of them
};

/// If `log` is longer than allowed, its content moves to `log`.1, that of .1 to .2 and so on, and `log` becomes empty.
/// Its writer goes on in the same file, which it must have opened for appending. A line that is written in the
/// microseconds between copy and truncation is lost. Without room for the copy, the content is lost, and its room free.
/// Returns true if the log has become empty.
bool rotate_log(const std::filesystem::path& log, const LogLimits& limits);

/// At most the last `lines` lines of a log, without the final line break; empty if it cannot be read.
[[nodiscard]] std::string last_lines(const std::filesystem::path& log, std::size_t lines);

}  // namespace boresight::supervisor
