#include "services/common/runtime/state_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace boresight::runtime {

namespace {

namespace fs = std::filesystem;

fs::path with_suffix(const fs::path& file, const char* suffix) {
  fs::path other = file;
  other += suffix;
  return other;
}

std::string failure(const char* what) {
  return std::string(what) + ": " + std::strerror(errno);
}

/// A file descriptor that the destructor closes.
class OpenFile {
 public:
  OpenFile(const fs::path& path, int flags) : fd_(open(path.c_str(), flags | O_CLOEXEC, 0660)) {}
  ~OpenFile() {
    if (fd_ >= 0) close(fd_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool is_regular() const {
    struct stat status {};
    return fstat(fd_, &status) == 0 && S_ISREG(status.st_mode);
  }

 private:
  int fd_;
};

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// Reads up to the capacity; −1 on errors. A longer file fills the buffer.
ssize_t read_all(int fd, std::span<std::uint8_t> into) {
  std::size_t size = 0;
  while (size < into.size()) {
    const ssize_t got = read(fd, into.data() + size, into.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(size);
}

StateBytes unreadable(std::string reason) {
  return {.kind = StateBytes::Kind::kUnreadable, .size = 0, .reason = std::move(reason)};
}

}  // namespace

StateBytes read_state_file(const fs::path& file, std::span<std::uint8_t> into) {
  unlink(with_suffix(file, ".tmp").c_str());
  const OpenFile input(file, O_RDONLY | O_NONBLOCK);  // a FIFO without a writer would block
  if (input.get() < 0) return errno == ENOENT ? StateBytes{} : unreadable(failure("open"));
  if (!input.is_regular()) return unreadable("no regular file");
  const ssize_t size = read_all(input.get(), into);
  if (size < 0) return unreadable(failure("read"));
  return {.kind = StateBytes::Kind::kRead, .size = static_cast<std::size_t>(size), .reason = {}};
}

std::string set_state_file_aside(const fs::path& file) {
  if (rename(file.c_str(), with_suffix(file, ".rejected").c_str()) == 0) return {};
  return "the file cannot be renamed: " + failure("rename");
}

std::string write_state_file(const fs::path& file, std::span<const std::uint8_t> bytes) {
  const fs::path temporary = with_suffix(file, ".tmp");
  {
    // A new file: what an earlier or foreign process left under this name, even a FIFO, is not opened.
    unlink(temporary.c_str());
    const OpenFile output(temporary, O_WRONLY | O_CREAT | O_EXCL);
    if (output.get() < 0) return failure("open");
    // The content must be on the medium before the rename.
    if (!write_all(output.get(), bytes)) return failure("write");
    if (fsync(output.get()) != 0) return failure("fsync");
  }
  if (rename(temporary.c_str(), file.c_str()) != 0) return failure("rename");
  const OpenFile folder(file.has_parent_path() ? file.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
  if (folder.get() < 0 || fsync(folder.get()) != 0) return failure("fsync of the folder");
  return {};
}

}  // namespace boresight::runtime
