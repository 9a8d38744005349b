#include "services/common/recording/ip.hpp"

#include <algorithm>
#include <bitset>
#include <cstdlib>
#include <cstring>

namespace boresight::recording {

namespace {

constexpr std::size_t kMaxDatagram = 65536;
constexpr std::size_t kMaxAssemblies = 16;
constexpr std::size_t kBlock = 8;  // fragment offsets count in blocks of eight bytes
constexpr std::uint8_t kUdpProtocol = 17;
constexpr std::uint16_t kEtherIpv4 = 0x0800, kEtherIpv6 = 0x86DD;

std::uint16_t read_u16(const std::uint8_t* p) {
  return static_cast<std::uint16_t>(p[0] << 8 | p[1]);
}
std::uint32_t read_u32(const std::uint8_t* p) {
  return static_cast<std::uint32_t>(read_u16(p)) << 16 | static_cast<std::uint32_t>(read_u16(p + 2));
}

/// Strips Ethernet and up to two VLAN tags; false if truncated.
bool strip_ethernet(std::span<const std::uint8_t>& bytes, std::uint16_t& type) {
  constexpr std::uint16_t kVlan = 0x8100, kServiceVlan = 0x88A8, kOldServiceVlan = 0x9100;
  if (bytes.size() < 14) return false;
  type = read_u16(bytes.data() + 12);
  bytes = bytes.subspan(14);
  for (int tags = 0; tags < 2 && (type == kVlan || type == kServiceVlan || type == kOldServiceVlan); ++tags) {
    if (bytes.size() < 4) return false;
    type = read_u16(bytes.data() + 2);
    bytes = bytes.subspan(4);
  }
  return true;
}

/// Content of a packet's IP headers; `data` follows them.
struct IpHeader {
  IpAddress source, destination;
  std::uint8_t protocol = 0;
  std::size_t offset = 0;  // of the fragment
  bool more = false;
  std::uint32_t identification = 0;
  std::span<const std::uint8_t> data;
};

}  // namespace

struct UdpDecoder::Assembly {
  bool active = false;
  std::uint64_t order = 0;
  IpAddress source, destination;
  std::uint32_t identification = 0;
  std::int64_t stamp_ns = 0;  // of the newest fragment
  std::size_t received = 0;
  std::size_t end = 0;    // of the fragment with the largest offset
  std::size_t total = 0;  // 0 before the last fragment
  std::bitset<kMaxDatagram / kBlock> blocks;
  std::array<std::uint8_t, kMaxDatagram> bytes;

  void begin(const IpHeader& header, std::uint64_t new_order) {
    active = true;
    order = new_order;
    source = header.source;
    destination = header.destination;
    identification = header.identification;
    received = end = total = 0;
    blocks.reset();
  }
  [[nodiscard]] bool is_of(const IpHeader& header) const {
    return active && source == header.source && destination == header.destination &&
           identification == header.identification;
  }
  enum class Fit : std::uint8_t { kNew, kRepeated, kContradicting };
  [[nodiscard]] Fit fit(const IpHeader& header) const {
    const std::size_t fragment_end = header.offset + header.data.size();
    const std::size_t last = (fragment_end - 1) / kBlock;
    std::size_t present = 0;
    for (std::size_t block = header.offset / kBlock; block <= last; ++block) present += blocks[block] ? 1 : 0;
    if (present == 0) {
      const bool beyond = (total != 0 && fragment_end > total) || (!header.more && end > fragment_end);
      return beyond ? Fit::kContradicting : Fit::kNew;
    }
    const bool same_bytes = present == last - header.offset / kBlock + 1 && fragment_end <= end &&
                            std::memcmp(bytes.data() + header.offset, header.data.data(), header.data.size()) == 0;
    return same_bytes && (header.more || total == fragment_end) ? Fit::kRepeated : Fit::kContradicting;
  }
  void add(const IpHeader& header) {
    const std::size_t fragment_end = header.offset + header.data.size();
    for (std::size_t block = header.offset / kBlock; block <= (fragment_end - 1) / kBlock; ++block) blocks.set(block);
    std::memcpy(bytes.data() + header.offset, header.data.data(), header.data.size());
    received += header.data.size();
    end = std::max(end, fragment_end);
    if (!header.more) total = fragment_end;
  }
};

struct UdpDecoder::State {
  std::array<Assembly, kMaxAssemblies> assemblies;
  std::uint64_t order = 0;
  std::uint64_t given_up = 0;
};

UdpDecoder::UdpDecoder() = default;
UdpDecoder::~UdpDecoder() = default;
UdpDecoder::UdpDecoder(UdpDecoder&&) noexcept = default;
UdpDecoder& UdpDecoder::operator=(UdpDecoder&&) noexcept = default;

std::string_view describe(PacketResult result) {
  switch (result) {
    case PacketResult::kFrame:
      return "datagram";
    case PacketResult::kIncomplete:
      return "fragment";
    case PacketResult::kIgnored:
      return "not UDP over IP";
    case PacketResult::kTruncated:
      return "packet is shorter than its headers state";
    case PacketResult::kBadHeader:
      return "header is contradictory";
    case PacketResult::kFragmentLost:
      return "a datagram was dropped: fragments are missing or contradict each other";
    case PacketResult::kErrorFrame:
      return "CAN error frame";
    case PacketResult::kUnsupported:
      return "CAN XL is not supported";
  }
  return "unknown";
}

bool is_problem(PacketResult result) {
  return result == PacketResult::kTruncated || result == PacketResult::kBadHeader ||
         result == PacketResult::kUnsupported;
}

namespace {

PacketResult parse_ipv4(std::span<const std::uint8_t> ip, IpHeader& out) {
  if (ip.size() < 20) return PacketResult::kTruncated;
  const std::size_t header = static_cast<std::size_t>(ip[0] & 0x0F) * 4;
  const std::size_t total = read_u16(ip.data() + 2);
  if (header < 20 || total < header) return PacketResult::kBadHeader;
  if (total > ip.size()) return PacketResult::kTruncated;
  const std::uint16_t fragment = read_u16(ip.data() + 6);
  out = {.source = IpAddress::v4(read_u32(ip.data() + 12)),
         .destination = IpAddress::v4(read_u32(ip.data() + 16)),
         .protocol = ip[9],
         .offset = static_cast<std::size_t>(fragment & 0x1FFF) * kBlock,
         .more = (fragment & 0x2000) != 0,
         .identification = read_u16(ip.data() + 4),
         .data = ip.subspan(header, total - header)};
  return PacketResult::kFrame;
}

PacketResult parse_ipv6(std::span<const std::uint8_t> ip, IpHeader& out) {
  constexpr std::uint8_t kHopByHop = 0, kRouting = 43, kFragment = 44, kDestinationOptions = 60;
  constexpr std::size_t kHeader = 40;
  if (ip.size() < kHeader) return PacketResult::kTruncated;
  const std::size_t length = read_u16(ip.data() + 4);
  if (kHeader + length > ip.size()) return PacketResult::kTruncated;
  out = {.source = IpAddress::v6(ip.subspan<8, 16>()),
         .destination = IpAddress::v6(ip.subspan<24, 16>()),
         .protocol = ip[6],
         .data = ip.subspan(kHeader, length)};
  // Each extension header has at least eight bytes, so the loop ends.
  while (out.protocol == kHopByHop || out.protocol == kRouting || out.protocol == kFragment ||
         out.protocol == kDestinationOptions) {
    if (out.data.size() < kBlock) return PacketResult::kTruncated;
    const std::uint8_t* const extension = out.data.data();
    std::size_t size = kBlock;
    if (out.protocol == kFragment) {
      const std::uint16_t fragment = read_u16(extension + 2);
      out.offset = static_cast<std::size_t>(fragment >> 3) * kBlock;
      out.more = (fragment & 1) != 0;
      out.identification = read_u32(extension + 4);
    } else {
      size += static_cast<std::size_t>(extension[1]) * kBlock;
    }
    if (size > out.data.size()) return PacketResult::kTruncated;
    const bool is_later_fragment = out.protocol == kFragment && out.offset > 0;
    out.protocol = extension[0];
    out.data = out.data.subspan(size);
    // Only the first fragment has further headers. Data follow here; their protocol is known after reassembly.
    if (is_later_fragment) break;
  }
  return PacketResult::kFrame;
}

PacketResult take_udp(std::span<const std::uint8_t> datagram, Frame& frame) {
  if (datagram.size() < 8) return PacketResult::kTruncated;
  const std::size_t length = read_u16(datagram.data() + 4);
  if (length < 8) return PacketResult::kBadHeader;
  if (length > datagram.size()) return PacketResult::kTruncated;
  frame.kind = FrameKind::kUdp;
  frame.source.port = read_u16(datagram.data());
  frame.destination.port = read_u16(datagram.data() + 2);
  frame.payload = datagram.subspan(8, length - 8);
  return PacketResult::kFrame;
}

}  // namespace

PacketResult UdpDecoder::decode(std::span<const std::uint8_t> packet, LinkLayer link, Frame& frame) {
  std::span<const std::uint8_t> ip = packet;
  if (link == LinkLayer::kEthernet) {
    std::uint16_t type = 0;
    if (!strip_ethernet(ip, type)) return PacketResult::kTruncated;
    if (type != kEtherIpv4 && type != kEtherIpv6) return PacketResult::kIgnored;
    if (!ip.empty() && ip[0] >> 4 != (type == kEtherIpv4 ? 4 : 6)) return PacketResult::kBadHeader;
  }
  if (ip.empty()) return PacketResult::kTruncated;
  IpHeader header;
  PacketResult parsed = PacketResult::kIgnored;
  if (ip[0] >> 4 == 4) parsed = parse_ipv4(ip, header);
  if (ip[0] >> 4 == 6) parsed = parse_ipv6(ip, header);
  if (parsed != PacketResult::kFrame) return parsed;
  if (header.protocol != kUdpProtocol) return PacketResult::kIgnored;
  frame.source.address = header.source;
  frame.destination.address = header.destination;
  const std::span<const std::uint8_t> data = header.data;
  const std::size_t offset = header.offset;
  const bool more = header.more;
  if (offset == 0 && !more) return take_udp(data, frame);

  if (data.empty() || offset + data.size() > kMaxDatagram || (more && data.size() % kBlock != 0)) {
    return PacketResult::kBadHeader;
  }
  if (!state_) state_ = std::make_unique<State>();
  constexpr std::int64_t kTimeout_ns = 30'000'000'000;  // as in Linux; identifications repeat
  const std::uint64_t given_up_before = state_->given_up;
  Assembly* assembly = nullptr;
  Assembly* oldest = &state_->assemblies.front();
  for (Assembly& a : state_->assemblies) {
    if (a.active && std::abs(frame.stamp_ns - a.stamp_ns) > kTimeout_ns) {
      a.active = false;
      ++state_->given_up;
    }
    if (a.is_of(header)) assembly = &a;
    if (!a.active ? oldest->active : (oldest->active && a.order < oldest->order)) oldest = &a;
  }
  if (assembly == nullptr) {
    state_->given_up += oldest->active ? 1 : 0;
    assembly = oldest;
    assembly->begin(header, ++state_->order);
  }
  assembly->stamp_ns = frame.stamp_ns;
  const Assembly::Fit fit = assembly->fit(header);
  if (fit == Assembly::Fit::kContradicting) {
    ++state_->given_up;
    assembly->begin(header, ++state_->order);
  }
  if (fit != Assembly::Fit::kRepeated) assembly->add(header);
  if (assembly->total == 0 || assembly->received < assembly->total) {
    return state_->given_up > given_up_before ? PacketResult::kFragmentLost : PacketResult::kIncomplete;
  }
  assembly->active = false;
  return take_udp({assembly->bytes.data(), assembly->total}, frame);
}

std::size_t UdpDecoder::unfinished() const {
  if (!state_) return 0;
  return static_cast<std::size_t>(std::count_if(state_->assemblies.begin(), state_->assemblies.end(),
                                                [](const Assembly& assembly) { return assembly.active; }));
}

std::uint64_t UdpDecoder::given_up() const {
  return state_ ? state_->given_up : 0;
}

}  // namespace boresight::recording
