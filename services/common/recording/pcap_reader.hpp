// Reads classic pcap captures as frames, by libpcap.
#pragma once

#include <cstdio>
#include <memory>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/packet_decoder.hpp"
#include "services/common/recording/reader.hpp"

struct pcap;

namespace boresight::recording {

/// True if these first bytes are those of a pcap capture.
[[nodiscard]] bool is_pcap(std::span<const std::uint8_t> head);

class PcapReader : public Reader {
 public:
  /// Throws OpenError if libpcap cannot read the file, or if its link type is not supported.
  PcapReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options);
  ~PcapReader() override;
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] Counts counts() const override { return decoder_.counts(); }
  [[nodiscard]] Progress progress() const override { return {source_->position(), source_->total()}; }

 private:
  std::unique_ptr<ByteSource> source_;
  PacketDecoder decoder_;
  CaptureInterface interface_;
  std::unique_ptr<char[]> buffer_;  ///< of the stream that libpcap reads
  pcap* pcap_ = nullptr;
  bool ended_ = false;
};

}  // namespace boresight::recording
