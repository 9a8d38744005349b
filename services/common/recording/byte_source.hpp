// The bytes of a recording in order, from a file or from standard input ("-"), with the position reached.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace boresight::recording {

class ByteSource {
 public:
  /// Throws OpenError naming the file and the cause.
  explicit ByteSource(const std::filesystem::path& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// The first bytes (fewer at the end of the file), which read() delivers all the same.
  [[nodiscard]] std::span<const std::uint8_t> head() const { return {head_.data(), head_size_}; }
  /// Up to `size` bytes; 0 at the end, −1 with errno if the file cannot be read on.
  [[nodiscard]] std::ptrdiff_t read(char* buffer, std::size_t size);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Bytes in all when it was opened; 0 if that is not known (a pipe).
  [[nodiscard]] std::uint64_t total() const { return total_; }

 private:
  std::string name_;
  int descriptor_ = -1;
  std::array<std::uint8_t, 8> head_{};
  std::size_t head_size_ = 0;
  std::uint64_t position_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace boresight::recording
