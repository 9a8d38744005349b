// A file that grows while a program runs, by whole lines.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace boresight::terminal {

/// Appends to a file under its own name. A last line that an earlier program did not finish is removed. The first error
/// is kept until check(), so that the program goes on; nothing is written after it.
class AppendedFile {
 public:
  /// Throws OutputError.
  explicit AppendedFile(const std::filesystem::path& file);
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  /// Writes complete lines.
  void write(std::string_view lines);
  void flush();
  /// Throws OutputError if anything was lost.
  void check();

 private:
  std::string name_;
  std::FILE* stream_ = nullptr;
  int error_ = 0;
};

}  // namespace boresight::terminal
