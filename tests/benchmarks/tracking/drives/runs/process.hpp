// A program that is run to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boresight::bench::tracking {

/// Exit code of the program; its output is appended to `log`. Throws std::runtime_error if it cannot be started.
[[nodiscard]] int run_program(const std::vector<std::string>& words, const std::filesystem::path& log);
/// The same; throws std::runtime_error, with the end of the log, unless the exit code is one of `allowed`.
int run_program(const std::vector<std::string>& words, const std::filesystem::path& log,
                const std::vector<int>& allowed);

}  // namespace boresight::bench::tracking
