// Writes UDP datagrams to a pcap file, fragmented as on Ethernet.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

struct pcap;
struct pcap_dumper;

namespace boresight::simulator::wire {

struct Endpoint {
  std::uint32_t ipv4;  ///< host byte order
  std::uint16_t port;
};

class PcapWriter {
 public:
  /// Throws std::runtime_error if the file cannot be made. The default of `mtu` is that of Ethernet.
  explicit PcapWriter(const std::filesystem::path& file, std::size_t mtu = 1500);
  ~PcapWriter();
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  void write(std::int64_t stamp_ns, const Endpoint& source, const Endpoint& destination,
             std::span<const std::uint8_t> payload);
  /// Throws std::runtime_error if a write failed, as on a full disk.
  void finish();

 private:
  std::filesystem::path name_;
  pcap* pcap_;
  pcap_dumper* dumper_;
  std::size_t mtu_;
  std::uint16_t identification_ = 0;
};

}  // namespace boresight::simulator::wire
