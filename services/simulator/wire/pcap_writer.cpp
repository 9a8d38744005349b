#include "services/simulator/wire/pcap_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <pcap/pcap.h>

#include "services/simulator/text_file.hpp"
#include "services/simulator/wire/byte_writer.hpp"

namespace boresight::simulator::wire {

namespace {

constexpr std::size_t kEthernet = 14, kIp = 20, kUdp = 8;

std::uint16_t ones_complement(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) sum += static_cast<std::uint32_t>(bytes[i] << 8 | bytes[i + 1]);
  while (sum >> 16 != 0) sum = (sum & 0xFFFFu) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

}  // namespace

PcapWriter::PcapWriter(const std::filesystem::path& file, std::size_t mtu)
    : name_(file),
      pcap_(pcap_open_dead_with_tstamp_precision(DLT_EN10MB, 262144, PCAP_TSTAMP_PRECISION_NANO)),
      dumper_(pcap_dump_open(pcap_, file.c_str())),
      mtu_(mtu) {
  if (dumper_ != nullptr) return;
  const std::string text = file.string() + ": " + pcap_geterr(pcap_);
  pcap_close(pcap_);
  throw std::runtime_error(text);
}

PcapWriter::~PcapWriter() {
  pcap_dump_close(dumper_);
  pcap_close(pcap_);
}

void PcapWriter::finish() {
  errno = 0;
  if (pcap_dump_flush(dumper_) == 0 && std::ferror(pcap_dump_file(dumper_)) == 0) return;
  throw write_error(name_, errno);
}

void PcapWriter::write(std::int64_t stamp_ns, const Endpoint& source, const Endpoint& destination,
                       std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> datagram(kUdp + payload.size());
  put_u16(datagram, 0, source.port);
  put_u16(datagram, 2, destination.port);
  put_u16(datagram, 4, static_cast<std::uint16_t>(datagram.size()));
  std::copy(payload.begin(), payload.end(), datagram.begin() + kUdp);  // UDP checksum 0: none, as IPv4 allows
  ++identification_;
  const std::size_t step = (mtu_ - kIp) / 8 * 8;
  for (std::size_t offset = 0; offset < datagram.size(); offset += step) {
    const std::size_t length = std::min(step, datagram.size() - offset);
    const bool more = offset + length < datagram.size();
    std::vector<std::uint8_t> packet(kEthernet + kIp + length);
    packet[5] = 1;  // destination and source hardware addresses, made up
    packet[11] = 2;
    put_u16(packet, 12, 0x0800);
    const std::span<std::uint8_t> ip = std::span(packet).subspan(kEthernet);
    ip[0] = 0x45;
    put_u16(ip, 2, static_cast<std::uint16_t>(kIp + length));
    put_u16(ip, 4, identification_);
    put_u16(ip, 6, static_cast<std::uint16_t>((more ? 0x2000u : 0u) | offset / 8));
    ip[8] = 16;  // time to live
    ip[9] = 17;  // UDP
    put_u32(ip, 12, source.ipv4);
    put_u32(ip, 16, destination.ipv4);
    put_u16(ip, 10, ones_complement(ip.first(kIp)));
    std::copy_n(datagram.begin() + static_cast<std::ptrdiff_t>(offset), length, ip.begin() + kIp);
    pcap_pkthdr header{};
    header.ts.tv_sec = stamp_ns / 1'000'000'000;
    header.ts.tv_usec = stamp_ns % 1'000'000'000;  // nanoseconds, as the file was opened for them
    header.caplen = header.len = static_cast<bpf_u_int32>(packet.size());
    pcap_dump(reinterpret_cast<u_char*>(dumper_), &header, packet.data());
  }
}

}  // namespace boresight::simulator::wire
