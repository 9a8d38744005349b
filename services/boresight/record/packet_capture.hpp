// Records the packets of one network interface into a pcap file with libpcap.
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

  /// Creates the file for the captured packets.
  [[nodiscard]] std::unique_ptr<recording::PcapWriter> make_writer(const std::filesystem::path& file) const;
  /// Writes the packets that have arrived. Throws recording::WriteError. Sets `problem` to the problem of the
  /// interface, and closes the capture then, or to "".
  void read(recording::PcapWriter& writer, std::string& problem);
  /// Tries to open a closed interface again.
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
  std::uint64_t dropped_before_ = 0;  ///< by earlier captures of this interface
};

}  // namespace boresight::record
