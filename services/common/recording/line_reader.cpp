#include "services/common/recording/line_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace boresight::recording {

namespace {

constexpr std::size_t kCapacity = 128 * 1024;

}  // namespace

LineReader::LineReader(ByteSource& source, std::size_t max_line)
    : source_(source), max_line_(std::min(max_line, kCapacity / 2)), buffer_(new char[kCapacity]) {}

bool LineReader::fill() {
  if (ended_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == kCapacity) return false;
  const std::ptrdiff_t got = source_.read(buffer_.get() + end_, kCapacity - end_);
  if (got <= 0) {
    ended_ = true;
    error_ = got < 0 ? errno : 0;
    return false;
  }
  end_ += static_cast<std::size_t>(got);
  return true;
}

std::string_view LineReader::peek() {
  while (fill()) {
  }
  return {buffer_.get() + begin_, end_ - begin_};
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  while (true) {
    const char* const start = buffer_.get() + begin_;
    const std::size_t size = end_ - begin_;
    const void* const newline = size > searched ? std::memchr(start + searched, '\n', size - searched) : nullptr;
    if (newline != nullptr) {
      const auto length = static_cast<std::size_t>(static_cast<const char*>(newline) - start);
      line = {start, std::min(length, max_line_ + 1)};
      begin_ += length + 1;
      return true;
    }
    searched = size;
    if (size > max_line_) break;
    if (!fill()) {
      line = {start, size};
      begin_ = end_;
      return size > 0;
    }
  }
  // Too long: keeps its beginning at the front of the buffer and skips the rest.
  const std::size_t kept = max_line_ + 1;
  std::memmove(buffer_.get(), buffer_.get() + begin_, kept);
  line = {buffer_.get(), kept};
  begin_ = end_ = kept;
  while (!ended_) {
    const std::ptrdiff_t got = source_.read(buffer_.get() + kept, kCapacity - kept);
    if (got <= 0) {
      ended_ = true;
      error_ = got < 0 ? errno : 0;
      break;
    }
    const void* const newline = std::memchr(buffer_.get() + kept, '\n', static_cast<std::size_t>(got));
    if (newline == nullptr) continue;
    begin_ = static_cast<std::size_t>(static_cast<const char*>(newline) - buffer_.get()) + 1;
    end_ = kept + static_cast<std::size_t>(got);
    break;
  }
  return true;
}

}  // namespace boresight::recording
