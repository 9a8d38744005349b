#include "services/common/recording/pcap_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <pcap/pcap.h>

#include "services/common/recording/link_layer.hpp"

namespace boresight::recording {

namespace {

constexpr std::size_t kBuffer = 256 * 1024;

ssize_t read_cookie(void* cookie, char* buffer, std::size_t size) {
  return static_cast<ByteSource*>(cookie)->read(buffer, size);
}

}  // namespace

bool is_capture(std::span<const std::uint8_t> head) {
  using Magic = std::array<std::uint8_t, 4>;
  constexpr std::array<Magic, 5> kMagics = {{{0xA1, 0xB2, 0xC3, 0xD4},
                                             {0xD4, 0xC3, 0xB2, 0xA1},
                                             {0xA1, 0xB2, 0x3C, 0x4D},
                                             {0x4D, 0x3C, 0xB2, 0xA1},
                                             {0x0A, 0x0D, 0x0D, 0x0A}}};
  if (head.size() < 4) return false;
  return std::any_of(kMagics.begin(), kMagics.end(),
                     [&](const Magic& magic) { return std::equal(magic.begin(), magic.end(), head.begin()); });
}

PcapReader::PcapReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options)
    : source_(std::move(source)), on_problem_(std::move(on_problem)), options_(options), buffer_(new char[kBuffer]) {
  // A stream of our own instead of a file name: it tells the position, takes a pipe and reads in large pieces.
  std::FILE* const stream = fopencookie(source_.get(), "r", {read_cookie, nullptr, nullptr, nullptr});
  if (stream == nullptr) throw OpenError(source_->name() + ": " + std::strerror(errno));
  static_cast<void>(std::setvbuf(stream, buffer_.get(), _IOFBF, kBuffer));
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_ = pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data());
  if (pcap_ == nullptr) {
    std::fclose(stream);
    throw OpenError(source_->name() + ": " + error.data());
  }
  link_type_ = pcap_datalink(pcap_);
  if (!is_supported_link(link_type_)) {
    const char* const type = pcap_datalink_val_to_name(link_type_);
    const std::string text = source_->name() + ": link type " + (type == nullptr ? std::to_string(link_type_) : type) +
                             " is not supported; supported: " + std::string(supported_links());
    pcap_close(pcap_);
    throw OpenError(text);
  }
}

PcapReader::~PcapReader() {
  pcap_close(pcap_);
}

void PcapReader::problem(std::string_view text) {
  ++counts_.problems;
  on_problem_(source_->name() + ": packet " + std::to_string(number_) + ": " + std::string(text));
}

void PcapReader::end(int status) {
  if (ended_) return;
  ended_ = true;
  if (status == PCAP_ERROR) {
    ++number_;
    problem(pcap_geterr(pcap_));
  }
  if (udp_.unfinished() > 0) {
    problem(std::to_string(udp_.unfinished()) + " datagrams lack fragments at the end of the capture");
  }
}

bool PcapReader::next(Frame& frame) {
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  int status = 0;
  while (!ended_ && (status = pcap_next_ex(pcap_, &header, &bytes)) == 1) {
    ++number_;
    constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // beyond the year 2262 nanoseconds do not fit
    const std::int64_t seconds = header->ts.tv_sec;
    if (seconds < 0 || seconds > kMaxSeconds) {
      problem("time stamp out of range");
      continue;
    }
    frame = Frame{};
    frame.stamp_ns = seconds * 1'000'000'000 + header->ts.tv_usec;  // in fact nanoseconds, as asked for
    const PacketResult result = decode_packet({bytes, header->caplen}, link_type_, udp_, frame);
    for (; given_up_ < udp_.given_up(); ++given_up_) problem(describe(PacketResult::kFragmentLost));
    if (result == PacketResult::kErrorFrame) ++counts_.error_frames;
    if (result == PacketResult::kIgnored) ++counts_.ignored;
    if (result == PacketResult::kTruncated && header->caplen < header->len) {
      problem("only " + std::to_string(header->caplen) + " of " + std::to_string(header->len) +
              " bytes were captured (snapshot length)");
    } else if (is_problem(result)) {
      problem(describe(result));
    }
    if (result != PacketResult::kFrame) continue;
    if (frame.kind != FrameKind::kUdp) frame.set_interface(options_.can_interface);
    if (frame.stamp_ns < last_stamp_ns_) ++counts_.backwards;
    last_stamp_ns_ = frame.stamp_ns;
    ++counts_.frames;
    return true;
  }
  end(status);
  return false;
}

}  // namespace boresight::recording
