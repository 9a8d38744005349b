// Output that is complete or absent: every write, flush and close is checked, and a file gets its name at the end.
#pragma once

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace boresight::terminal {

/// Output that cannot be written; what() names the file and the cause.
class OutputError : public std::runtime_error {
 public:
  OutputError(const std::string& name, int error_number);
  using std::runtime_error::runtime_error;
};

/// The reader of a pipe has gone away, as `head` does: no reason for a message.
class ReaderGone : public OutputError {
 public:
  using OutputError::OutputError;
};

/// Text to a file or to standard output. A file is written under a temporary name beside its own and renamed by
/// commit(); without commit() it is removed, and an earlier file of that name stays. What exists and is no regular file
/// (/dev/full, a pipe) is written directly. All members throw OutputError.
class OutputFile {
 public:
  /// "-" is standard output.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view text);
  /// What was written reaches the file, or the reader of standard output.
  void flush();
  /// Closes the file and gives it its name.
  void commit();

 private:
  [[noreturn]] void fail(int error_number);
  void discard();

  std::string name_;               // in messages
  std::filesystem::path target_;   // empty: written directly
  std::filesystem::path written_;  // the temporary name
  std::FILE* stream_ = nullptr;
};

/// Writes a whole file, or standard output if it is "-".
void write_file(const std::filesystem::path& file, std::string_view text);
/// Writes to standard output at once.
void print(std::string_view text);

/// A folder of output files. They are written into a temporary folder in it, and commit() moves them to their places;
/// without commit() they are removed, and files of an earlier run stay. All members throw OutputError.
class OutputFolder {
 public:
  /// Makes the folder if it does not exist.
  explicit OutputFolder(std::filesystem::path folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where the files are written until commit().
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  /// The place of a file after commit().
  [[nodiscard]] std::filesystem::path final_place(const std::filesystem::path& written) const;
  /// `text` with the files' final places instead of the temporary ones, for messages.
  [[nodiscard]] std::string with_final_places(std::string text) const;
  /// Moves every file to its place.
  void commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path made_;  // the outermost folder that did not exist before; empty: none
  std::filesystem::path temporary_;
  bool committed_ = false;
};

}  // namespace boresight::terminal
