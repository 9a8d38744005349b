#include "services/common/runtime/config/read_text.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::config {

namespace {

[[noreturn]] void throw_unreadable(const std::filesystem::path& file, std::string_view reason) {
  throw Error(fmt::format("{}: cannot be read: {}", file.string(), reason));
}

std::string_view kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

void expect_regular(const std::filesystem::path& file, const struct stat& status) {
  if (!S_ISREG(status.st_mode)) {
    throw_unreadable(file, fmt::format("it is {}; must be a regular file", kind_of(status.st_mode)));
  }
}

/// Closes a file descriptor.
struct OpenFile {
  explicit OpenFile(const std::filesystem::path& file) : fd(open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~OpenFile() {
    if (fd >= 0) close(fd);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int fd;
};

}  // namespace

std::string read_text(const std::filesystem::path& file, std::size_t max_bytes) {
  // Before opening: to open a device may have an effect. After it: another file may have taken the name.
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) throw_unreadable(file, std::strerror(errno));
  expect_regular(file, status);
  const OpenFile input(file);
  if (input.fd < 0 || fstat(input.fd, &status) != 0) throw_unreadable(file, std::strerror(errno));
  expect_regular(file, status);
  std::string text;
  std::array<char, 1U << 16> part{};
  while (true) {
    const ssize_t got = read(input.fd, part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_unreadable(file, std::strerror(errno));
    if (got == 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
    if (text.size() > max_bytes) {
      throw_unreadable(file, fmt::format("it is larger than {} MiB", max_bytes >> 20));
    }
  }
}

}  // namespace boresight::config
