// Writes recordings that the readers here, can-utils, tshark and Wireshark can read: candump logs and pcap captures.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "services/common/recording/frame.hpp"

struct pcap;
struct pcap_dumper;

namespace boresight::recording {

/// A recording that cannot be written; what() names the file and the cause.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The longest line of format_candump(), with its line end.
constexpr std::size_t kMaxCandumpText = 192;

/// Writes a CAN frame as a line of `candump -l`, with microseconds; returns the number of characters. A remote frame's
/// requested length is the size of its payload. With `error_frame`, can_id is an error class. Returns 0 for UDP frames,
/// and for ids and payloads beyond the limits of CAN.
[[nodiscard]] std::size_t format_candump(const Frame& frame, bool error_frame, std::span<char, kMaxCandumpText> text);

/// Writes through its own buffer; regular calls of flush() limit the loss at a crash. All members throw WriteError.
class CandumpWriter {
 public:
  explicit CandumpWriter(const std::filesystem::path& file);
  ~CandumpWriter();
  CandumpWriter(const CandumpWriter&) = delete;
  CandumpWriter& operator=(const CandumpWriter&) = delete;

  void write(const Frame& frame, bool error_frame = false);
  /// The line of `candump -d` for frames that the kernel dropped.
  void write_drops(std::string_view interface, std::uint32_t frames, std::uint32_t total);
  void flush();
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void append(std::string_view text);

  std::string name_;
  std::unique_ptr<char[]> buffer_;
  std::FILE* file_;
  std::uint64_t bytes_ = 0;
};

/// Writes raw packets of one link type (libpcap's DLT_…) to a pcap file with nanoseconds. All members throw WriteError.
class PcapWriter {
 public:
  PcapWriter(const std::filesystem::path& file, int link_type, int snapshot_length);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// `original_size` is the packet's size on the wire, if only a part was captured.
  void write(std::int64_t stamp_ns, std::span<const std::uint8_t> packet, std::size_t original_size);
  void flush();
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::unique_ptr<char[]> buffer_;
  pcap* pcap_ = nullptr;
  pcap_dumper* dumper_ = nullptr;
  std::uint64_t bytes_ = 0;
};

}  // namespace boresight::recording
