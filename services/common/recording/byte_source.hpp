// Reads the bytes of a recording, from a file or from standard input ("-"), and keeps the position.
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

  /// The first bytes (fewer at the end of the file); read() delivers them as well.
  [[nodiscard]] std::span<const std::uint8_t> head() const { return {head_.data(), head_size_}; }
  /// Reads up to `size` bytes; returns 0 at the end, −1 with errno if reading fails.
  [[nodiscard]] std::ptrdiff_t read(char* buffer, std::size_t size);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// Size in bytes when it was opened; 0 if unknown (a pipe).
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
