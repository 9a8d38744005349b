#include "services/common/recording/writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <pcap/pcap.h>

namespace boresight::recording {

namespace {

constexpr std::size_t kWriteBuffer_bytes = 256 * 1024;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

char* put_hex(char* at, std::uint32_t value, int digits) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  for (int i = digits - 1; i >= 0; --i) *at++ = kDigits[value >> 4 * i & 0xF];
  return at;
}

char* put_decimal(char* at, std::int64_t value, int digits) {
  for (int i = digits - 1; i >= 0; --i, value /= 10) at[i] = static_cast<char>('0' + value % 10);
  return at + digits;
}

char* put_text(char* at, std::string_view text) {
  return std::copy(text.begin(), text.end(), at);
}

std::FILE* open_file(const std::string& name, char* buffer) {
  std::FILE* const file = std::fopen(name.c_str(), "we");
  if (file == nullptr) throw WriteError(name + ": " + std::strerror(errno));
  static_cast<void>(std::setvbuf(file, buffer, _IOFBF, kWriteBuffer_bytes));
  return file;
}

}  // namespace

std::size_t format_candump(const Frame& frame, bool error_frame, std::span<char, kMaxCandumpText> text) {
  const bool is_fd = frame.kind == FrameKind::kCanFd;
  const std::uint32_t max_id = frame.can_extended || error_frame ? 0x1FFFFFFF : 0x7FF;
  if (frame.kind == FrameKind::kUdp || frame.can_id > max_id || frame.payload.size() > (is_fd ? 64u : 8u)) return 0;
  const std::int64_t stamp_us = std::max<std::int64_t>(frame.stamp_ns, 0) / 1000;
  char* at = text.data();
  *at++ = '(';
  at = put_decimal(at, stamp_us / 1'000'000, 10);
  *at++ = '.';
  at = put_decimal(at, stamp_us % 1'000'000, 6);
  at = put_text(at, ") ");
  at = put_text(at, frame.interface_name().empty() ? std::string_view("can0") : frame.interface_name());
  *at++ = ' ';
  constexpr std::uint32_t kErrorFlag = 0x20000000;
  at = error_frame ? put_hex(at, frame.can_id | kErrorFlag, 8) : put_hex(at, frame.can_id, frame.can_extended ? 8 : 3);
  *at++ = '#';
  if (is_fd) {
    *at++ = '#';
    at = put_hex(at, frame.can_fd_flags, 1);
  }
  if (frame.can_remote && !is_fd) {
    *at++ = 'R';
    if (!frame.payload.empty()) at = put_decimal(at, static_cast<std::int64_t>(frame.payload.size()), 1);
  } else {
    for (const std::uint8_t byte : frame.payload) at = put_hex(at, byte, 2);
  }
  *at++ = '\n';
  return static_cast<std::size_t>(at - text.data());
}

CandumpWriter::CandumpWriter(const std::filesystem::path& file)
    : name_(file.string()), buffer_(new char[kWriteBuffer_bytes]), file_(open_file(name_, buffer_.get())) {}

CandumpWriter::~CandumpWriter() {
  std::fclose(file_);
}

void CandumpWriter::append(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
    throw WriteError(name_ + ": " + std::strerror(errno));
  }
  bytes_ += text.size();
}

void CandumpWriter::write(const Frame& frame, bool error_frame) {
  std::array<char, kMaxCandumpText> text;
  const std::size_t size = format_candump(frame, error_frame, text);
  if (size == 0) throw WriteError(name_ + ": a candump line cannot hold the frame");
  append({text.data(), size});
}

void CandumpWriter::write_drops(std::string_view interface, std::uint32_t frames, std::uint32_t total) {
  append("DROPCOUNT: dropped " + std::to_string(frames) + " CAN frame" + (frames > 1 ? "s" : "") + " on '" +
         std::string(interface) + "' socket (total drops " + std::to_string(total) + ")\n");
}

void CandumpWriter::flush() {
  if (std::fflush(file_) != 0) throw WriteError(name_ + ": " + std::strerror(errno));
}

PcapWriter::PcapWriter(const std::filesystem::path& file, int link_type, int snapshot_length)
    : name_(file.string()), buffer_(new char[kWriteBuffer_bytes]) {
  std::FILE* const stream = open_file(name_, buffer_.get());
  pcap_ = pcap_open_dead_with_tstamp_precision(link_type, snapshot_length, PCAP_TSTAMP_PRECISION_NANO);
  dumper_ = pcap_ == nullptr ? nullptr : pcap_dump_fopen(pcap_, stream);
  if (dumper_ == nullptr) {
    const std::string cause = pcap_ == nullptr ? "out of memory" : pcap_geterr(pcap_);
    if (pcap_ != nullptr) pcap_close(pcap_);
    std::fclose(stream);
    throw WriteError(name_ + ": " + cause);
  }
  constexpr std::uint64_t kFileHeader = 24;
  bytes_ = kFileHeader;
}

PcapWriter::~PcapWriter() {
  pcap_dump_close(dumper_);
  pcap_close(pcap_);
}

void PcapWriter::write(std::int64_t stamp_ns, std::span<const std::uint8_t> packet, std::size_t original_size) {
  constexpr std::uint64_t kPacketHeader = 16;
  pcap_pkthdr header{};
  header.ts.tv_sec = std::max<std::int64_t>(stamp_ns, 0) / kSecond_ns;
  header.ts.tv_usec = std::max<std::int64_t>(stamp_ns, 0) % kSecond_ns;  // in fact nanoseconds, as requested
  header.caplen = static_cast<bpf_u_int32>(packet.size());
  header.len = static_cast<bpf_u_int32>(std::max(original_size, packet.size()));
  pcap_dump(reinterpret_cast<u_char*>(dumper_), &header, packet.data());
  // libpcap does not report write errors.
  if (std::ferror(pcap_dump_file(dumper_)) != 0) throw WriteError(name_ + ": " + std::strerror(errno));
  bytes_ += kPacketHeader + packet.size();
}

void PcapWriter::flush() {
  if (pcap_dump_flush(dumper_) != 0) throw WriteError(name_ + ": " + std::strerror(errno));
}

}  // namespace boresight::recording
