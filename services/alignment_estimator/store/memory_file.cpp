#include "services/alignment_estimator/store/memory_file.hpp"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace boresight::alignment {

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

/// A file descriptor that the destructor closes. Opening does not wait for a pipe's other end.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(open(path.c_str(), flags | O_NONBLOCK | O_CLOEXEC, 0660)) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

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

}  // namespace

LoadedMemory load_memory(const fs::path& file, const Identity& identity) {
  LoadedMemory loaded;
  unlink(with_suffix(file, ".tmp").c_str());
  std::array<std::uint8_t, kMaxMemoryBytes + 1> bytes;
  ssize_t size = 0;
  {
    const Descriptor input(file, O_RDONLY);
    if (input.get() < 0) {
      if (errno == ENOENT) return loaded;
      loaded.kind = LoadedMemory::Kind::kUnreadable;
      loaded.reason = failure("open");
      return loaded;
    }
    size = read_all(input.get(), bytes);
    if (size < 0) {
      loaded.kind = LoadedMemory::Kind::kUnreadable;
      loaded.reason = failure("read");
      return loaded;
    }
  }
  loaded.verdict = decode_memory(std::span(bytes.data(), static_cast<std::size_t>(size)), identity, loaded.memory,
                                 loaded.rejected_radars);
  if (loaded.verdict == MemoryVerdict::kTaken) {
    loaded.kind = LoadedMemory::Kind::kTaken;
    return loaded;
  }
  loaded.kind = LoadedMemory::Kind::kRejected;
  loaded.reason = describe(loaded.verdict);
  if (rename(file.c_str(), with_suffix(file, ".rejected").c_str()) != 0) {
    loaded.reason += ", and the file cannot be renamed: " + failure("rename");
  }
  return loaded;
}

std::string write_memory_file(const fs::path& file, std::span<const std::uint8_t> bytes) {
  const fs::path temporary = with_suffix(file, ".tmp");
  {
    const Descriptor output(temporary, O_WRONLY | O_CREAT | O_TRUNC);
    if (output.get() < 0) return failure("open");
    // The content must be on the medium before the rename.
    if (!write_all(output.get(), bytes)) return failure("write");
    if (fsync(output.get()) != 0) return failure("fsync");
  }
  if (rename(temporary.c_str(), file.c_str()) != 0) return failure("rename");
  const Descriptor folder(file.has_parent_path() ? file.parent_path() : fs::path("."), O_RDONLY | O_DIRECTORY);
  if (folder.get() < 0 || fsync(folder.get()) != 0) return failure("fsync of the folder");
  return {};
}

}  // namespace boresight::alignment
