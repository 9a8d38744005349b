#include "services/boresight/terminal/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

namespace boresight::terminal {

namespace {

namespace fs = std::filesystem;

std::string partial_suffix() {
  return ".partial-" + std::to_string(getpid());
}

[[noreturn]] void throw_output_error(const std::string& name, int error_number) {
  if (error_number == EPIPE) throw ReaderGone(name, error_number);
  throw OutputError(name, error_number);
}

}  // namespace

OutputError::OutputError(const std::string& name, int error_number)
    : std::runtime_error(name + ": cannot be written: " + std::strerror(error_number)) {}

OutputFile::OutputFile(const fs::path& file) : name_(file == "-" ? "standard output" : file.string()) {
  if (file == "-") {
    stream_ = stdout;
    return;
  }
  std::error_code ignored;
  struct stat status {};
  const bool exists = stat(file.c_str(), &status) == 0;
  if (exists && !S_ISREG(status.st_mode)) {
    stream_ = std::fopen(file.c_str(), "we");
  } else {
    // A link stays a link to the new file.
    const fs::path resolved = exists ? fs::canonical(file, ignored) : file;
    target_ = resolved.empty() ? file : resolved;
    written_ = target_;
    written_ += partial_suffix();
    stream_ = std::fopen(written_.c_str(), "we");
    if (stream_ != nullptr && exists) static_cast<void>(fchmod(fileno(stream_), status.st_mode & 07777));
  }
  if (stream_ == nullptr) throw_output_error(name_, errno);
}

OutputFile::~OutputFile() {
  discard();
}

void OutputFile::discard() {
  if (stream_ != nullptr && stream_ != stdout) std::fclose(stream_);
  stream_ = nullptr;
  if (!written_.empty()) unlink(written_.c_str());
  written_.clear();
}

void OutputFile::fail(int error_number) {
  discard();
  throw_output_error(name_, error_number);
}

void OutputFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) fail(errno);
}

void OutputFile::flush() {
  if (std::fflush(stream_) != 0) fail(errno);
}

void OutputFile::commit() {
  flush();
  if (stream_ == stdout) return;
  // The data must be on the disk before the name is, or a crash leaves an empty file of that name.
  if (!target_.empty() && fsync(fileno(stream_)) != 0) fail(errno);
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) fail(errno);
  if (target_.empty()) return;
  if (std::rename(written_.c_str(), target_.c_str()) != 0) fail(errno);
  written_.clear();
}

void write_file(const fs::path& file, std::string_view text) {
  OutputFile output(file);
  output.write(text);
  output.commit();
}

void print(std::string_view text) {
  write_file("-", text);
}

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  for (fs::path each = fs::absolute(folder_, error); !error && !each.empty() && !fs::exists(each);
       each = each.parent_path()) {
    made_ = each;
  }
  fs::create_directories(folder_, error);
  if (error) throw OutputError(folder_.string(), error.value());
  temporary_ = folder_ / partial_suffix();
  fs::remove_all(temporary_, error);
  if (!fs::create_directory(temporary_, error)) throw OutputError(folder_.string(), error ? error.value() : EEXIST);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
  if (committed_ || made_.empty()) return;
  // Only folders that are empty, and only those that were made here.
  for (fs::path each = fs::absolute(folder_, ignored); fs::remove(each, ignored) && each != made_;) {
    each = each.parent_path();
  }
}

fs::path OutputFolder::final_place(const fs::path& written) const {
  return folder_ / written.filename();
}

std::string OutputFolder::with_final_places(std::string text) const {
  const std::string from = temporary_.string() + "/", to = (folder_ / "").string();
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

void OutputFolder::commit() {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(temporary_, error)) {
    fs::rename(entry.path(), final_place(entry.path()), error);
    if (error) throw OutputError(final_place(entry.path()).string(), error.value());
  }
  if (error) throw OutputError(folder_.string(), error.value());
  committed_ = true;
}

}  // namespace boresight::terminal
