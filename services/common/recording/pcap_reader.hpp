// Captures (pcap, pcapng) as frames, by libpcap.
#pragma once

#include <cstdio>
#include <memory>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/ip.hpp"
#include "services/common/recording/reader.hpp"

struct pcap;

namespace boresight::recording {

/// Whether a file that begins so is a capture.
[[nodiscard]] bool is_capture(std::span<const std::uint8_t> head);

class PcapReader : public Reader {
 public:
  /// Throws OpenError if libpcap does not understand the file or nothing here its link type.
  PcapReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options);
  ~PcapReader() override;
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] Counts counts() const override { return counts_; }
  [[nodiscard]] Progress progress() const override { return {source_->position(), source_->total()}; }

 private:
  void problem(std::string_view text);
  void end(int status);

  std::unique_ptr<ByteSource> source_;
  OnProblem on_problem_;
  ReadOptions options_;
  std::unique_ptr<char[]> buffer_;  ///< of the stream that libpcap reads
  pcap* pcap_ = nullptr;
  int link_type_ = 0;
  UdpDecoder udp_;
  std::uint64_t given_up_ = 0;
  std::uint64_t number_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  Counts counts_;
  bool ended_ = false;
};

}  // namespace boresight::recording
