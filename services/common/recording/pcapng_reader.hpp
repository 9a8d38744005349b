// Reads pcapng captures as frames, without libpcap: libpcap hides the interfaces' names, which distinguish CAN buses,
// and rejects captures of two kinds of interfaces, such as dumpcap's captures of CAN and Ethernet.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/packet_decoder.hpp"
#include "services/common/recording/reader.hpp"

namespace boresight::recording {

/// True if these first bytes are those of a pcapng capture.
[[nodiscard]] bool is_pcapng(std::span<const std::uint8_t> head);

/// Reads sections of either byte order with up to 64 interfaces each, and enhanced and obsolete packet blocks. Skips
/// all other blocks. After damage, reading continues at the next complete block.
class PcapngReader : public Reader {
 public:
  PcapngReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] Counts counts() const override { return decoder_.counts(); }
  [[nodiscard]] Progress progress() const override { return {source_->position() - (end_ - begin_), source_->total()}; }

 private:
  struct Interface {
    CaptureInterface capture;
    std::string name;
    bool supported = false;
    std::uint8_t resolution = 6;  // as in the option if_tsresol
    std::int64_t offset_s = 0;
  };
  /// Makes `size` bytes available at begin_; false if the file ends before.
  bool need(std::size_t size);
  void skip(std::uint64_t size);
  [[nodiscard]] std::uint16_t read_u16(std::size_t at) const;
  [[nodiscard]] std::uint32_t read_u32(std::size_t at) const;
  /// Size of the block at begin_; nullopt if there is no complete block.
  [[nodiscard]] std::optional<std::size_t> block_size();
  void begin_section();
  void end_section();
  void add_interface(std::size_t block_size);
  [[nodiscard]] bool take_packet(std::uint32_t type, std::size_t block_size, Frame& frame);

  std::unique_ptr<ByteSource> source_;
  PacketDecoder decoder_;
  ReadOptions options_;
  std::unique_ptr<std::uint8_t[]> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::size_t delivered_ = 0;  // size of the block with the last delivered packet
  bool big_endian_ = false;
  bool damaged_ = false;  // since the last complete block
  bool source_ended_ = false;
  bool ended_ = false;
  std::vector<std::unique_ptr<Interface>> interfaces_;
};

}  // namespace boresight::recording
