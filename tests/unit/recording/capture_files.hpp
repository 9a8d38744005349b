// Captures written byte by byte, as by other tools and machines.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::recording {

struct CapturedPacket {
  std::uint32_t seconds = 0;
  std::uint32_t fraction = 0;  ///< in the unit of the file
  std::string bytes;
  std::uint32_t original_size = 0;  ///< 0: as captured
  std::uint32_t interface = 0;      ///< pcapng
};

inline void append_number(std::string& text, std::uint64_t value, int bytes, bool big_endian = false) {
  for (int i = 0; i < bytes; ++i) {
    text += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - i : i) & 0xFF);
  }
}

/// Classic pcap, of nanoseconds or microseconds, of this machine's or the other byte order.
inline std::string pcap_file(std::uint32_t link_type, const std::vector<CapturedPacket>& packets,
                             bool nanoseconds = true, bool big_endian = false) {
  std::string file;
  append_number(file, nanoseconds ? 0xA1B23C4D : 0xA1B2C3D4, 4, big_endian);
  append_number(file, 2, 2, big_endian);
  append_number(file, 4, 2, big_endian);
  append_number(file, 0, 8, big_endian);
  append_number(file, 65535, 4, big_endian);
  append_number(file, link_type, 4, big_endian);
  for (const CapturedPacket& packet : packets) {
    append_number(file, packet.seconds, 4, big_endian);
    append_number(file, packet.fraction, 4, big_endian);
    append_number(file, packet.bytes.size(), 4, big_endian);
    append_number(file, packet.original_size == 0 ? packet.bytes.size() : packet.original_size, 4, big_endian);
    file += packet.bytes;
  }
  return file;
}

inline std::string pcapng_block(std::uint32_t type, std::string body) {
  body.resize((body.size() + 3) / 4 * 4);
  std::string block;
  append_number(block, type, 4);
  append_number(block, body.size() + 12, 4);
  block += body;
  append_number(block, body.size() + 12, 4);
  return block;
}

struct PcapngInterface {
  std::uint16_t link_type;
  std::string name;
  bool nanoseconds = true;
};

/// pcapng with enhanced packet blocks; stamps are seconds and fraction joined in the interface's unit.
inline std::string pcapng_file(const std::vector<PcapngInterface>& interfaces,
                               const std::vector<CapturedPacket>& packets) {
  std::string body;
  append_number(body, 0x1A2B3C4D, 4);
  append_number(body, 1, 2);
  append_number(body, 0, 2);
  append_number(body, ~std::uint64_t{0}, 8);
  std::string file = pcapng_block(0x0A0D0D0A, body);
  for (const PcapngInterface& interface : interfaces) {
    body.clear();
    append_number(body, interface.link_type, 2);
    append_number(body, 0, 2);
    append_number(body, 262144, 4);
    append_number(body, 2, 2);  // if_name
    append_number(body, interface.name.size(), 2);
    body += interface.name;
    body.resize((body.size() + 3) / 4 * 4);
    append_number(body, 9, 2);  // if_tsresol
    append_number(body, 1, 2);
    append_number(body, interface.nanoseconds ? 9 : 6, 4);
    append_number(body, 0, 4);
    file += pcapng_block(1, body);
  }
  for (const CapturedPacket& packet : packets) {
    const std::uint64_t unit = interfaces[packet.interface].nanoseconds ? 1'000'000'000 : 1'000'000;
    const std::uint64_t stamp = packet.seconds * unit + packet.fraction;
    body.clear();
    append_number(body, packet.interface, 4);
    append_number(body, stamp >> 32, 4);
    append_number(body, stamp & 0xFFFFFFFF, 4);
    append_number(body, packet.bytes.size(), 4);
    append_number(body, packet.original_size == 0 ? packet.bytes.size() : packet.original_size, 4);
    body += packet.bytes;
    file += pcapng_block(6, body);
  }
  return file;
}

/// The kernel's can_frame (16 bytes) or canfd_frame (72 bytes).
inline std::string socketcan_packet(std::uint32_t id_and_flags, std::string_view data, bool fd = false,
                                    std::uint8_t fd_flags = 0, bool big_endian_id = true) {
  std::string packet;
  append_number(packet, id_and_flags, 4, big_endian_id);
  append_number(packet, data.size(), 1);
  append_number(packet, fd_flags, 1);
  append_number(packet, 0, 2);
  packet += data;
  packet.resize(fd ? 72 : 16);
  return packet;
}

/// IPv4 or IPv6 with UDP from port 1000 to port 2000.
inline std::string udp_packet(std::string_view data, bool ipv6 = false) {
  std::string packet;
  if (ipv6) {
    append_number(packet, 0x60000000, 4, true);
    append_number(packet, data.size() + 8, 2, true);
    append_number(packet, 17, 1);
    append_number(packet, 64, 1);
    append_number(packet, 0xFD00000000000000, 8, true);
    append_number(packet, 1, 8, true);
    append_number(packet, 0xFD00000000000000, 8, true);
    append_number(packet, 2, 8, true);
  } else {
    append_number(packet, 0x4500, 2, true);
    append_number(packet, data.size() + 28, 2, true);
    append_number(packet, 0, 4);
    append_number(packet, 0x4011, 2, true);
    append_number(packet, 0, 2);
    append_number(packet, 0x0A000001, 4, true);
    append_number(packet, 0x0A000002, 4, true);
  }
  append_number(packet, 1000, 2, true);
  append_number(packet, 2000, 2, true);
  append_number(packet, data.size() + 8, 2, true);
  append_number(packet, 0, 2);
  packet += data;
  return packet;
}

}  // namespace boresight::recording
