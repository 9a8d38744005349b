// Packets of one network interface into a pcap file, by libpcap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "services/boresight/record/capture_plan.hpp"
#include "services/common/recording/writer.hpp"
#include "services/ingest_gateway/links/socket.hpp"

struct pcap;

namespace boresight::record {

class PacketCapture {
 public:
  /// Opens the interface with whole packets, nanosecond stamps and a large buffer, and joins the source's multicast
  /// groups. Throws CaptureError, and std::invalid_argument for a filter that libpcap does not understand.
  explicit PacketCapture(PacketSource source);
  ~PacketCapture();
  PacketCapture(const PacketCapture&) = delete;
  PacketCapture& operator=(const PacketCapture&) = delete;

  /// A file for what this captures.
  [[nodiscard]] std::unique_ptr<recording::PcapWriter> make_writer(const std::filesystem::path& file) const;
  /// Takes what has come. Throws recording::WriteError. `problem` says what went wrong with the interface, or is
  /// empty; the capture is closed then.
  void read(recording::PcapWriter& writer, std::string& problem);
  /// Tries to open an interface again that was closed.
  void reopen();

  [[nodiscard]] bool is_open() const { return pcap_ != nullptr; }
  [[nodiscard]] int descriptor() const;  ///< to wait on; −1 if closed
  [[nodiscard]] const std::string& interface() const { return source_.interface; }
  [[nodiscard]] std::uint64_t packets() const { return packets_; }
  /// Packets that the kernel or the interface dropped.
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  void open();
  void close();

  PacketSource source_;
  pcap* pcap_ = nullptr;
  int link_type_ = 0;
  bool nanoseconds_ = false;
  std::vector<ingest::Socket> memberships_;
  std::uint64_t packets_ = 0;
  std::uint64_t dropped_before_ = 0;  ///< by captures that were closed
};

}  // namespace boresight::record
