#include "services/common/recording/pcap_reader.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <pcap/pcap.h>

#include "services/common/recording/link_layer.hpp"

namespace boresight::recording {

namespace {

constexpr std::size_t kPcapBuffer_bytes = 128 * 1024;

ssize_t read_cookie(void* cookie, char* buffer, std::size_t size) {
  return static_cast<ByteSource*>(cookie)->read(buffer, size);
}

}  // namespace

bool is_pcap(std::span<const std::uint8_t> head) {
  using Magic = std::array<std::uint8_t, 4>;
  constexpr std::array<Magic, 4> kMagics = {
      {{0xA1, 0xB2, 0xC3, 0xD4}, {0xD4, 0xC3, 0xB2, 0xA1}, {0xA1, 0xB2, 0x3C, 0x4D}, {0x4D, 0x3C, 0xB2, 0xA1}}};
  if (head.size() < 4) return false;
  return std::any_of(kMagics.begin(), kMagics.end(),
                     [&](const Magic& magic) { return std::equal(magic.begin(), magic.end(), head.begin()); });
}

PcapReader::PcapReader(std::unique_ptr<ByteSource> source, OnProblem on_problem, const ReadOptions& options)
    : source_(std::move(source)),
      decoder_(source_->name(), std::move(on_problem)),
      buffer_(new char[kPcapBuffer_bytes]) {
  interface_.can_name = options.can_interface;
  // A stream instead of a file name: it has a position, accepts a pipe and reads large blocks.
  std::FILE* const stream = fopencookie(source_.get(), "r", {read_cookie, nullptr, nullptr, nullptr});
  if (stream == nullptr) throw OpenError(source_->name() + ": " + std::strerror(errno));
  static_cast<void>(std::setvbuf(stream, buffer_.get(), _IOFBF, kPcapBuffer_bytes));
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_ = pcap_fopen_offline_with_tstamp_precision(stream, PCAP_TSTAMP_PRECISION_NANO, error.data());
  if (pcap_ == nullptr) {
    std::fclose(stream);
    throw OpenError(source_->name() + ": " + error.data());
  }
  interface_.link_type = pcap_datalink(pcap_);
  if (!is_supported_link(interface_.link_type)) {
    const char* const type = pcap_datalink_val_to_name(interface_.link_type);
    const std::string text = source_->name() + ": link type " +
                             (type == nullptr ? std::to_string(interface_.link_type) : type) +
                             " is not supported; supported: " + std::string(supported_links());
    pcap_close(pcap_);
    throw OpenError(text);
  }
}

PcapReader::~PcapReader() {
  pcap_close(pcap_);
}

bool PcapReader::next(Frame& frame) {
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  int status = 0;
  while (!ended_ && (status = pcap_next_ex(pcap_, &header, &bytes)) == 1) {
    decoder_.begin_packet();
    // tv_usec holds nanoseconds, as requested.
    if (decoder_.take(interface_, header->ts.tv_sec, header->ts.tv_usec, {bytes, header->caplen}, header->len, frame)) {
      return true;
    }
  }
  if (!ended_) {
    ended_ = true;
    if (status == PCAP_ERROR) {
      decoder_.begin_packet();
      decoder_.problem(pcap_geterr(pcap_));
    }
    decoder_.end(interface_);
  }
  return false;
}

}  // namespace boresight::recording
