#include "services/common/recording/byte_source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"

namespace boresight::recording {

namespace {

/// Not repeated after a signal (EINTR): the only signals that are handled are those that end the program.
std::ptrdiff_t read_some(int descriptor, void* buffer, std::size_t size) {
  return ::read(descriptor, buffer, size);
}

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& file) : name_(file == "-" ? "standard input" : file.string()) {
  descriptor_ = file == "-" ? dup(STDIN_FILENO) : open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) throw OpenError(name_ + ": " + std::strerror(errno));
  struct stat status {};
  if (fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    total_ = static_cast<std::uint64_t>(status.st_size);
    static_cast<void>(posix_fadvise(descriptor_, 0, 0, POSIX_FADV_SEQUENTIAL));
  }
  while (head_size_ < head_.size()) {
    const std::ptrdiff_t got = read_some(descriptor_, head_.data() + head_size_, head_.size() - head_size_);
    if (got < 0) {
      const std::string cause = errno == EISDIR ? "is a folder" : std::strerror(errno);
      close(descriptor_);
      throw OpenError(name_ + ": " + cause);
    }
    if (got == 0) break;
    head_size_ += static_cast<std::size_t>(got);
  }
}

ByteSource::~ByteSource() {
  close(descriptor_);
}

std::ptrdiff_t ByteSource::read(char* buffer, std::size_t size) {
  std::ptrdiff_t got = 0;
  if (position_ < head_size_) {
    got = static_cast<std::ptrdiff_t>(std::min(size, head_size_ - static_cast<std::size_t>(position_)));
    std::memcpy(buffer, head_.data() + position_, static_cast<std::size_t>(got));
  } else {
    got = read_some(descriptor_, buffer, size);
  }
  if (got > 0) position_ += static_cast<std::uint64_t>(got);
  return got;
}

}  // namespace boresight::recording
