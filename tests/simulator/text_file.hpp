// A text file for writing.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace boresight::simulator {

class TextFile {
 public:
  /// Throws std::runtime_error if the file cannot be written.
  explicit TextFile(const std::filesystem::path& file) : name_(file), file_(std::fopen(file.c_str(), "we")) {
    if (file_ == nullptr) throw std::runtime_error(file.string() + ": cannot be written: " + std::strerror(errno));
  }
  ~TextFile() { std::fclose(file_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  [[nodiscard]] std::FILE* get() const { return file_; }
  /// Throws std::runtime_error if a write failed, as on a full disk.
  void finish() const {
    errno = 0;
    if (std::fflush(file_) == 0 && std::ferror(file_) == 0) return;
    throw std::runtime_error(name_.string() + ": cannot be written: " + std::strerror(errno != 0 ? errno : EIO));
  }

 private:
  std::filesystem::path name_;
  std::FILE* file_;
};

}  // namespace boresight::simulator
