// A text file for writing.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace boresight::simulator {

/// The error of a file that could not be written. stdio does not keep the cause of an earlier failure, so a full disk
/// is recognised by its free space.
[[nodiscard]] inline std::runtime_error write_error(const std::filesystem::path& file, int error_number) {
  std::error_code ignored;
  const bool is_full = std::filesystem::space(file, ignored).available == 0;
  const int cause = error_number != 0 ? error_number : is_full ? ENOSPC : EIO;
  return std::runtime_error(file.string() + ": cannot be written: " + std::strerror(cause));
}

class TextFile {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  explicit TextFile(const std::filesystem::path& file) : name_(file), file_(std::fopen(file.c_str(), "we")) {
    if (file_ == nullptr) throw write_error(file, errno);
  }
  ~TextFile() { std::fclose(file_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  [[nodiscard]] std::FILE* get() const { return file_; }
  /// Throws std::runtime_error if a write failed, as on a full disk.
  void finish() const {
    errno = 0;
    if (std::fflush(file_) == 0 && std::ferror(file_) == 0) return;
    throw write_error(name_, errno);
  }

 private:
  std::filesystem::path name_;
  std::FILE* file_;
};

}  // namespace boresight::simulator
