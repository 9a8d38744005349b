#include "deploy/supervisor/log_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace boresight::supervisor {

namespace {

std::filesystem::path kept_log(const std::filesystem::path& log, std::size_t number) {
  return log.string() + "." + std::to_string(number);
}

/// Copies until the end of `from`, which may grow meanwhile; false if there is no room.
bool copy_all(int from, int to) {
  std::array<char, 1 << 16> buffer{};
  for (ssize_t got = 0; (got = read(from, buffer.data(), buffer.size())) > 0;) {
    if (write(to, buffer.data(), static_cast<std::size_t>(got)) != got) return false;
  }
  return true;
}

}  // namespace

bool rotate_log(const std::filesystem::path& log, const LogLimits& limits) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(log, error);
  if (error || bytes <= limits.max_bytes) return false;
  const int from = open(log.c_str(), O_RDWR | O_CLOEXEC);
  if (from < 0) return false;
  if (limits.kept_files > 0) {
    // The oldest goes first, which makes room for the copy.
    std::filesystem::remove(kept_log(log, limits.kept_files), error);
    for (std::size_t number = limits.kept_files; number > 1; --number) {
      std::filesystem::rename(kept_log(log, number - 1), kept_log(log, number), error);
    }
    const int to = open(kept_log(log, 1).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    const bool is_copied = to >= 0 && copy_all(from, to);
    if (to >= 0) close(to);
    if (!is_copied) std::filesystem::remove(kept_log(log, 1), error);
  }
  const bool is_empty = ftruncate(from, 0) == 0;
  close(from);
  return is_empty;
}

std::string last_lines(const std::filesystem::path& log, std::size_t lines) {
  // Enough for some lines; a longer one is cut.
  constexpr std::streamoff kTail = 4096;
  std::ifstream input(log, std::ios::binary | std::ios::ate);
  if (!input) return {};
  const std::streamoff size = input.tellg();
  input.seekg(std::max<std::streamoff>(0, size - kTail));
  std::ostringstream text;
  text << input.rdbuf();
  std::string tail = text.str();
  while (!tail.empty() && tail.back() == '\n') tail.pop_back();
  std::size_t begin = tail.size();
  for (std::size_t found = 0; found < lines && begin != std::string::npos && begin > 0; ++found) {
    begin = tail.rfind('\n', begin - 1);
  }
  return begin == std::string::npos || lines == 0 ? tail : tail.substr(std::min(tail.size(), begin + 1));
}

}  // namespace boresight::supervisor
