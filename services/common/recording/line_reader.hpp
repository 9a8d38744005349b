// Reads the lines of a text of any size in fixed memory.
#pragma once

#include <memory>
#include <string_view>

#include "services/common/recording/byte_source.hpp"

namespace boresight::recording {

class LineReader {
 public:
  /// Lines longer than `max_line` bytes are cut to max_line + 1, so that the parser sees that they are too long.
  LineReader(ByteSource& source, std::size_t max_line);

  /// The next line without its end; false at the end of the text or if reading failed. Valid until the next call.
  [[nodiscard]] bool next(std::string_view& line);
  /// Fills the buffer and returns its content that is not delivered yet: for look-ahead.
  [[nodiscard]] std::string_view peek();
  /// errno if the text ended because of a read error, else 0.
  [[nodiscard]] int error() const { return error_; }
  /// Bytes of the source that have been delivered or skipped.
  [[nodiscard]] std::uint64_t position() const { return source_.position() - (end_ - begin_); }

 private:
  /// Appends to the buffer; false at the end.
  bool fill();

  ByteSource& source_;
  std::size_t max_line_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool ended_ = false;
  int error_ = 0;
};

}  // namespace boresight::recording
