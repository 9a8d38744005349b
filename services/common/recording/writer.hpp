// Recordings as files that the readers here, can-utils, tshark and Wireshark read: candump logs and pcap captures.
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

/// A recording that cannot be written (on); what() names the file and the cause.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The longest line that format_candump() makes, with its end.
constexpr std::size_t kMaxCandumpText = 192;

/// A CAN frame as a line of `candump -l`, microseconds as there; returns the number of characters. A remote frame's
/// requested length is the size of its payload. `error_frame` says that can_id is an error class. Frames of UDP, and
/// ids and payloads beyond what CAN has, give 0.
[[nodiscard]] std::size_t format_candump(const Frame& frame, bool error_frame, std::span<char, kMaxCandumpText> text);

/// Writes through a buffer of its own; flush() from time to time bounds what a crash loses. All members throw
/// WriteError.
class CandumpWriter {
 public:
  explicit CandumpWriter(const std::filesystem::path& file);
  ~CandumpWriter();
  CandumpWriter(const CandumpWriter&) = delete;
  CandumpWriter& operator=(const CandumpWriter&) = delete;

  void write(const Frame& frame, bool error_frame = false);
  /// The line that `candump -d` writes where the kernel dropped frames.
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

/// Raw packets of one link type (libpcap's DLT_…) into a pcap file with nanoseconds. All members throw WriteError.
class PcapWriter {
 public:
  PcapWriter(const std::filesystem::path& file, int link_type, int snapshot_length);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// `original_size` is the packet's size on the wire, if less was captured.
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
