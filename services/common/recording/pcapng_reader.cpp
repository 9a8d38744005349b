#include "services/common/recording/pcapng_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <pcap/dlt.h>

#include "services/common/recording/link_layer.hpp"

namespace boresight::recording {

namespace {

// Longer blocks are skipped; the largest packets have 256 KiB.
constexpr std::size_t kMaxBlock = 512 * 1024;
constexpr std::size_t kPcapngBuffer_bytes = 2 * kMaxBlock;
constexpr std::size_t kMaxInterfaces = 64;

constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kObsoletePacket = 2, kSimplePacket = 3, kPacket = 6;
constexpr std::size_t kBlockHeader = 8, kBlockTrailer = 4, kMinBlock = kBlockHeader + kBlockTrailer;

/// Name, statistics, secret and custom blocks may have any size; a packet or interface block of such a size is damaged.
bool may_be_huge(std::uint32_t type) {
  constexpr std::uint32_t kNames = 4, kStatistics = 5, kSecrets = 10, kCustom = 0xBAD, kCustomUncopied = 0x40000BAD;
  return type == kNames || type == kStatistics || type == kSecrets || type == kCustom || type == kCustomUncopied;
}

/// Time stamps in the unit of an interface's if_tsresol: 10^−r, or 2^−r with the highest bit set.
struct Stamp {
  std::int64_t seconds, nanoseconds;
};
Stamp convert(std::uint64_t stamp, std::uint8_t resolution) {
  constexpr std::uint64_t kNanoseconds = 1'000'000'000;
  const unsigned exponent = resolution & 0x7Fu;
  if ((resolution & 0x80u) != 0) {
    const std::uint64_t fraction = exponent == 0 ? 0 : stamp & ((std::uint64_t{1} << exponent) - 1);
    // Units below 2^−30 s are finer than a nanosecond, and the product would overflow.
    constexpr unsigned kFine = 30;
    const unsigned cut = exponent > kFine ? exponent - kFine : 0;
    return {static_cast<std::int64_t>(stamp >> exponent),
            static_cast<std::int64_t>((fraction >> cut) * kNanoseconds >> (exponent - cut))};
  }
  std::uint64_t unit = 1;
  for (unsigned i = 0; i < exponent; ++i) unit *= 10;
  const std::uint64_t fraction = stamp % unit;
  return {static_cast<std::int64_t>(stamp / unit),
          static_cast<std::int64_t>(unit <= kNanoseconds ? fraction * (kNanoseconds / unit)
                                                         : fraction / (unit / kNanoseconds))};
}

bool is_resolution(std::uint8_t resolution) {
  constexpr unsigned kMaxBinary = 63, kMaxDecimal = 19;  // limits of 64 bits
  return (resolution & 0x7Fu) <= ((resolution & 0x80u) != 0 ? kMaxBinary : kMaxDecimal);
}

}  // namespace

bool is_pcapng(std::span<const std::uint8_t> head) {
  return head.size() >= 4 && head[0] == 0x0A && head[1] == 0x0D && head[2] == 0x0D && head[3] == 0x0A;
}

PcapngReader::PcapngReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options)
    : source_(std::move(source)),
      decoder_(source_->name(), std::move(on_problem)),
      options_(options),
      buffer_(new std::uint8_t[kPcapngBuffer_bytes]) {}

bool PcapngReader::need(std::size_t size) {
  while (end_ - begin_ < size && !source_ended_) {
    if (begin_ + size > kPcapngBuffer_bytes || begin_ > kMaxBlock) {
      std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    const std::ptrdiff_t got = source_->read(reinterpret_cast<char*>(buffer_.get() + end_), kPcapngBuffer_bytes - end_);
    if (got < 0) decoder_.problem(std::string("cannot be read further: ") + std::strerror(errno));
    source_ended_ = got <= 0;
    end_ += static_cast<std::size_t>(std::max<std::ptrdiff_t>(got, 0));
  }
  return end_ - begin_ >= size;
}

void PcapngReader::skip(std::uint64_t size) {
  while (size > 0) {
    const std::uint64_t now = std::min<std::uint64_t>(size, kMaxBlock);
    if (!need(static_cast<std::size_t>(now))) {
      begin_ = end_;
      return;
    }
    begin_ += static_cast<std::size_t>(now);
    size -= now;
  }
}

std::uint16_t PcapngReader::read_u16(std::size_t at) const {
  const std::uint8_t* const p = buffer_.get() + begin_ + at;
  return static_cast<std::uint16_t>(big_endian_ ? p[0] << 8 | p[1] : p[1] << 8 | p[0]);
}

std::uint32_t PcapngReader::read_u32(std::size_t at) const {
  const std::uint32_t first = read_u16(at), second = read_u16(at + 2);
  return big_endian_ ? first << 16 | second : second << 16 | first;
}

std::optional<std::size_t> PcapngReader::block_size() {
  if (!need(kMinBlock)) return std::nullopt;
  // The type of a section block is the same in both byte orders; the next field gives the order of the section.
  if (read_u32(0) == kSection) {
    const bool was_big_endian = big_endian_;
    constexpr std::uint32_t kMagic = 0x1A2B3C4D;
    big_endian_ = false;
    if (read_u32(kBlockHeader) != kMagic) {
      big_endian_ = true;
      if (read_u32(kBlockHeader) != kMagic) {
        big_endian_ = was_big_endian;
        return std::nullopt;
      }
    }
  }
  const std::size_t size = read_u32(4);
  if (size < kMinBlock || size % 4 != 0) return std::nullopt;
  if (size > kMaxBlock) return may_be_huge(read_u32(0)) && !damaged_ ? std::optional<std::size_t>(size) : std::nullopt;
  if (!need(size) || read_u32(size - kBlockTrailer) != size) return std::nullopt;
  return size;
}

void PcapngReader::begin_section() {
  end_section();
  interfaces_.clear();
}

void PcapngReader::end_section() {
  for (const auto& interface : interfaces_) decoder_.end(interface->capture);
}

void PcapngReader::add_interface(std::size_t block_size) {
  constexpr std::size_t kOptions = 16;
  constexpr std::uint16_t kName = 2, kResolution = 9, kOffset = 14;
  if (block_size < kOptions + kBlockTrailer || interfaces_.size() == kMaxInterfaces) {
    decoder_.problem(interfaces_.size() == kMaxInterfaces ? "more than 64 interfaces" : "interface block is truncated");
    return;
  }
  auto interface = std::make_unique<Interface>();
  interface->capture.link_type = data_link_of(read_u16(kBlockHeader));
  interface->capture.can_name = options_.can_interface;
  const std::size_t end = block_size - kBlockTrailer;
  for (std::size_t at = kOptions; at + 4 <= end;) {
    const std::uint16_t code = read_u16(at);
    const std::size_t size = read_u16(at + 2);
    at += 4;
    if (code == 0 || at + size > end) break;
    const std::uint8_t* const value = buffer_.get() + begin_ + at;
    if (code == kName) {
      // In a cooked capture this is the common name of all interfaces ("any").
      const std::string name(reinterpret_cast<const char*>(value), size);
      if (interface->capture.link_type == DLT_CAN_SOCKETCAN)
        interface->capture.can_name = name.substr(0, name.find('\0'));
      interface->name = name.substr(0, name.find('\0'));
    } else if (code == kResolution && size == 1) {
      interface->resolution = *value;
    } else if (code == kOffset && size == 8) {
      const std::uint64_t first = read_u32(at), second = read_u32(at + 4);
      interface->offset_s = static_cast<std::int64_t>(big_endian_ ? first << 32 | second : second << 32 | first);
    }
    at += (size + 3) / 4 * 4;
  }
  interface->supported = is_supported_link(interface->capture.link_type);
  if (!interface->supported) {
    decoder_.problem("interface " + interface->name + " has link type " + std::to_string(interface->capture.link_type) +
                     ", which is not supported: its packets are skipped; supported: " + std::string(supported_links()));
  } else if (!is_resolution(interface->resolution) || interface->offset_s < -kLastStamp_s ||
             interface->offset_s > kLastStamp_s) {
    interface->supported = false;
    decoder_.problem("interface " + interface->name + " has an invalid time unit or offset: its packets are skipped");
  }
  interfaces_.push_back(std::move(interface));
}

bool PcapngReader::take_packet(std::uint32_t type, std::size_t block_size, Frame& frame) {
  constexpr std::size_t kData = 28;
  decoder_.begin_packet();
  if (type == kSimplePacket) {
    decoder_.problem("has no time stamp (simple packet block)");
    return false;
  }
  if (block_size < kData + kBlockTrailer) {
    decoder_.problem("packet block is truncated");
    return false;
  }
  const std::uint32_t index = type == kPacket ? read_u32(kBlockHeader) : read_u16(kBlockHeader);
  const std::uint64_t stamp = static_cast<std::uint64_t>(read_u32(12)) << 32 | read_u32(16);
  const std::size_t captured = read_u32(20), original = read_u32(24);
  if (captured > block_size - kData - kBlockTrailer) {
    decoder_.problem("packet is longer than its block");
    return false;
  }
  if (index >= interfaces_.size()) {
    decoder_.problem("packet of an unknown interface");
    return false;
  }
  Interface& interface = *interfaces_[index];
  if (!interface.supported) return false;
  const Stamp time = convert(stamp, interface.resolution);
  // An invalid stamp remains invalid with the offset, which is small.
  const std::int64_t seconds =
      time.seconds < 0 || time.seconds > 100'000'000'000 ? -1 : time.seconds + interface.offset_s;
  return decoder_.take(interface.capture, seconds, time.nanoseconds, {buffer_.get() + begin_ + kData, captured},
                       original, frame);
}

bool PcapngReader::next(Frame& frame) {
  begin_ += std::exchange(delivered_, 0);
  while (!ended_) {
    const std::optional<std::size_t> size = block_size();
    if (!size) {
      if (end_ == begin_) break;
      if (!damaged_) decoder_.problem("damaged: no complete block follows");
      damaged_ = true;
      skip(4);  // blocks begin at multiples of four
      continue;
    }
    damaged_ = false;
    const std::uint32_t type = read_u32(0);
    const bool is_packet = type == kPacket || type == kObsoletePacket || type == kSimplePacket;
    if (*size > kMaxBlock) {
      skip(*size);
      continue;
    }
    if (type == kSection) begin_section();
    if (type == kInterface) add_interface(*size);
    if (is_packet && take_packet(type, *size, frame)) {
      delivered_ = *size;  // the payload stays valid until the next call
      return true;
    }
    begin_ += *size;
  }
  if (!ended_) {
    ended_ = true;
    end_section();
  }
  return false;
}

}  // namespace boresight::recording
