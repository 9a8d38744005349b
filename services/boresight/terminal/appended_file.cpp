#include "services/boresight/terminal/appended_file.hpp"

#include <array>
#include <cerrno>

#include <sys/stat.h>
#include <unistd.h>

#include "services/boresight/terminal/output_file.hpp"

namespace boresight::terminal {

namespace {

/// Place after the last line feed, searched from the end; 0 if there is none, negative if the file cannot be read.
off_t end_of_lines(int descriptor, off_t size) {
  std::array<char, 4096> block;
  for (off_t end = size; end > 0;) {
    const off_t begin = end > static_cast<off_t>(block.size()) ? end - static_cast<off_t>(block.size()) : 0;
    const ssize_t read = pread(descriptor, block.data(), static_cast<std::size_t>(end - begin), begin);
    if (read != end - begin) return -1;
    const std::string_view text(block.data(), static_cast<std::size_t>(read));
    if (const std::size_t at = text.rfind('\n'); at != std::string_view::npos)
      return begin + static_cast<off_t>(at) + 1;
    end = begin;
  }
  return 0;
}

}  // namespace

AppendedFile::AppendedFile(const std::filesystem::path& file) : name_(file.string()) {
  errno = 0;
  struct stat status {};
  const bool is_regular = stat(file.c_str(), &status) != 0 || S_ISREG(status.st_mode);
  stream_ = std::fopen(file.c_str(), is_regular ? "a+e" : "we");
  if (stream_ == nullptr) throw OutputError(name_, errno);
  if (!is_regular || status.st_size == 0) return;
  const off_t end = end_of_lines(fileno(stream_), status.st_size);
  if (end >= 0 && (end == status.st_size || ftruncate(fileno(stream_), end) == 0)) return;
  const int error = errno != 0 ? errno : EIO;
  std::fclose(stream_);
  throw OutputError(name_, error);
}

AppendedFile::~AppendedFile() {
  std::fclose(stream_);
}

void AppendedFile::write(std::string_view lines) {
  if (error_ == 0 && std::fwrite(lines.data(), 1, lines.size(), stream_) != lines.size()) error_ = errno;
}

void AppendedFile::flush() {
  if (error_ == 0 && std::fflush(stream_) != 0) error_ = errno;
}

void AppendedFile::check() {
  flush();
  if (error_ != 0) throw OutputError(name_, error_);
}

}  // namespace boresight::terminal
