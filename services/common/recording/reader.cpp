#include "services/common/recording/reader.hpp"

#include <array>
#include <cstdio>
#include <cstring>
#include <optional>

#include <pcap/pcap.h>

#include "services/common/recording/candump.hpp"
#include "services/common/recording/ip.hpp"

namespace boresight::recording {

namespace {

class CandumpReader : public Reader {
 public:
  CandumpReader(const std::filesystem::path& file, OnProblem on_problem)
      : name_(file.string()), on_problem_(std::move(on_problem)), file_(std::fopen(name_.c_str(), "re")) {
    if (file_ == nullptr) throw OpenError(name_ + ": " + std::strerror(errno));
  }
  ~CandumpReader() override {
    std::free(line_);
    std::fclose(file_);
  }
  CandumpReader(const CandumpReader&) = delete;
  CandumpReader& operator=(const CandumpReader&) = delete;

  bool next(Frame& frame) override {
    ssize_t length = 0;
    while ((length = getline(&line_, &capacity_, file_)) >= 0) {
      ++number_;
      const CandumpResult result = parse_candump_line({line_, static_cast<std::size_t>(length)}, frame, bytes_);
      if (result == CandumpResult::kFrame) return true;
      if (result == CandumpResult::kEmpty) continue;
      ++problems_;
      on_problem_(name_ + ":" + std::to_string(number_) + ": " + std::string(describe(result)));
    }
    return false;
  }
  std::uint64_t problems() const override { return problems_; }

 private:
  std::string name_;
  OnProblem on_problem_;
  std::FILE* file_;
  char* line_ = nullptr;
  std::size_t capacity_ = 0;
  std::uint64_t number_ = 0;
  std::uint64_t problems_ = 0;
  std::array<std::uint8_t, 64> bytes_{};
};

/// A frame of linktype 227: the kernel's can_frame with the id in network byte order.
PacketResult decode_socketcan(std::span<const std::uint8_t> packet, Frame& frame) {
  if (packet.size() < 8) return PacketResult::kTruncated;
  constexpr std::uint32_t kExtended = 0x80000000, kRemote = 0x40000000, kError = 0x20000000;
  const std::uint32_t id = static_cast<std::uint32_t>(packet[0]) << 24 | static_cast<std::uint32_t>(packet[1]) << 16 |
                           static_cast<std::uint32_t>(packet[2]) << 8 | packet[3];
  if ((id & kError) != 0) return PacketResult::kIgnored;
  const std::size_t length = packet[4];
  if (length > 64 || packet.size() < 8 + length) return PacketResult::kTruncated;
  constexpr std::uint8_t kFdFlag = 0x04;
  frame.kind = length > 8 || (packet[5] & kFdFlag) != 0 ? FrameKind::kCanFd : FrameKind::kCan;
  frame.can_extended = (id & kExtended) != 0;
  frame.can_remote = (id & kRemote) != 0;
  frame.can_id = id & (frame.can_extended ? 0x1FFFFFFFu : 0x7FFu);
  frame.set_interface("can0");  // classic pcap does not say which interface it was
  frame.payload = packet.subspan(8, frame.can_remote ? 0 : length);
  return PacketResult::kFrame;
}

class PcapReader : public Reader {
 public:
  PcapReader(const std::filesystem::path& file, OnProblem on_problem)
      : name_(file.string()), on_problem_(std::move(on_problem)) {
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    pcap_ = pcap_open_offline_with_tstamp_precision(name_.c_str(), PCAP_TSTAMP_PRECISION_NANO, error.data());
    if (pcap_ == nullptr) throw OpenError(name_ + ": " + error.data());
    link_type_ = pcap_datalink(pcap_);
    if (link_type_ != DLT_EN10MB && link_type_ != DLT_RAW && link_type_ != DLT_CAN_SOCKETCAN) {
      const char* const type = pcap_datalink_val_to_name(link_type_);
      const std::string text = name_ + ": link type " + (type == nullptr ? std::to_string(link_type_) : type) +
                               " is not supported; supported: Ethernet, raw IP, SocketCAN";
      pcap_close(pcap_);
      throw OpenError(text);
    }
  }
  ~PcapReader() override { pcap_close(pcap_); }
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  bool next(Frame& frame) override {
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    int status = 0;
    while ((status = pcap_next_ex(pcap_, &header, &bytes)) == 1) {
      ++number_;
      frame = Frame{};
      frame.stamp_ns = static_cast<std::int64_t>(header->ts.tv_sec) * 1'000'000'000 + header->ts.tv_usec;
      const std::span<const std::uint8_t> packet(bytes, header->caplen);
      const PacketResult result =
          link_type_ == DLT_CAN_SOCKETCAN
              ? decode_socketcan(packet, frame)
              : udp_.decode(packet, link_type_ == DLT_EN10MB ? LinkLayer::kEthernet : LinkLayer::kRawIp, frame);
      if (result == PacketResult::kFrame) return true;
      if (result == PacketResult::kIncomplete || result == PacketResult::kIgnored) continue;
      problem(describe(result));
    }
    if (status == PCAP_ERROR && !failed_) {
      failed_ = true;
      ++number_;
      problem(pcap_geterr(pcap_));
    }
    return false;
  }
  std::uint64_t problems() const override { return problems_; }

 private:
  void problem(std::string_view text) {
    ++problems_;
    on_problem_(name_ + ": packet " + std::to_string(number_) + ": " + std::string(text));
  }
  std::string name_;
  OnProblem on_problem_;
  pcap_t* pcap_ = nullptr;
  int link_type_ = 0;
  UdpDecoder udp_;
  std::uint64_t number_ = 0;
  std::uint64_t problems_ = 0;
  bool failed_ = false;
};

bool looks_like_pcap(const std::filesystem::path& file) {
  std::FILE* const stream = std::fopen(file.c_str(), "re");
  if (stream == nullptr) throw OpenError(file.string() + ": " + std::strerror(errno));
  std::array<unsigned char, 4> magic{};
  const std::size_t read = std::fread(magic.data(), 1, magic.size(), stream);
  std::fclose(stream);
  if (read < magic.size()) return false;
  constexpr std::array<std::array<unsigned char, 4>, 5> kMagics = {{{0xA1, 0xB2, 0xC3, 0xD4},
                                                                    {0xD4, 0xC3, 0xB2, 0xA1},
                                                                    {0xA1, 0xB2, 0x3C, 0x4D},
                                                                    {0x4D, 0x3C, 0xB2, 0xA1},
                                                                    {0x0A, 0x0D, 0x0D, 0x0A}}};
  for (const auto& known : kMagics) {
    if (magic == known) return true;
  }
  return false;
}

class MergedReader : public Reader {
 public:
  explicit MergedReader(std::vector<std::unique_ptr<Reader>> readers) {
    for (auto& reader : readers) sources_.push_back({std::move(reader), {}, false, false});
  }
  bool next(Frame& frame) override {
    Source* earliest = nullptr;
    for (Source& source : sources_) {
      // Only now: the payload handed out last must stay valid until this call.
      if (!source.loaded && !source.ended) source.ended = !(source.loaded = source.reader->next(source.frame));
      if (source.loaded && (earliest == nullptr || source.frame.stamp_ns < earliest->frame.stamp_ns)) {
        earliest = &source;
      }
    }
    if (earliest == nullptr) return false;
    frame = earliest->frame;
    earliest->loaded = false;
    return true;
  }
  std::uint64_t problems() const override {
    std::uint64_t sum = 0;
    for (const Source& source : sources_) sum += source.reader->problems();
    return sum;
  }

 private:
  struct Source {
    std::unique_ptr<Reader> reader;
    Frame frame;
    bool loaded;
    bool ended;
  };
  std::vector<Source> sources_;
};

}  // namespace

std::unique_ptr<Reader> open_recording(const std::filesystem::path& file, OnProblem on_problem) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) throw OpenError(file.string() + ": is a folder");
  if (looks_like_pcap(file)) return std::make_unique<PcapReader>(file, std::move(on_problem));
  return std::make_unique<CandumpReader>(file, std::move(on_problem));
}

std::unique_ptr<Reader> open_recordings(const std::vector<std::filesystem::path>& files, const OnProblem& on_problem) {
  if (files.empty()) throw OpenError("no recording given");
  std::vector<std::unique_ptr<Reader>> readers;
  for (const auto& file : files) readers.push_back(open_recording(file, on_problem));
  if (readers.size() == 1) return std::move(readers.front());
  return std::make_unique<MergedReader>(std::move(readers));
}

}  // namespace boresight::recording
