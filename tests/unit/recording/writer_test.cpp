#include "services/common/recording/writer.hpp"

#include <cstdlib>
#include <random>

#include <gmock/gmock.h>

#include "tests/unit/recording/capture_files.hpp"
#include "tests/unit/recording/files.hpp"

namespace boresight::recording {
namespace {

class Writers : public Files {};

std::string line_of(const Frame& frame, bool error_frame = false) {
  std::array<char, kMaxCandumpText> text{};
  return {text.data(), format_candump(frame, error_frame, text)};
}

TEST_F(Writers, LinesAreThoseOfCandump) {
  const std::array<std::uint8_t, 8> data = {0x01, 0xAB, 0x00, 0xFF, 4, 5, 6, 7};
  Frame frame;
  frame.stamp_ns = 1'345'212'884'318'850'999;
  frame.set_interface("can1");
  frame.can_id = 0x7F;
  frame.payload = std::span(data).first(3);
  EXPECT_EQ(line_of(frame), "(1345212884.318850) can1 07F#01AB00\n");
  frame.can_extended = true;
  EXPECT_EQ(line_of(frame), "(1345212884.318850) can1 0000007F#01AB00\n");
  frame.kind = FrameKind::kCanFd;
  frame.can_fd_flags = 1;
  EXPECT_EQ(line_of(frame), "(1345212884.318850) can1 0000007F##101AB00\n");
  frame.kind = FrameKind::kCan;
  frame.can_remote = true;
  frame.payload = data;
  EXPECT_EQ(line_of(frame), "(1345212884.318850) can1 0000007F#R8\n");
  frame.can_remote = false;
  frame.can_id = 4;
  EXPECT_EQ(line_of(frame, true), "(1345212884.318850) can1 20000004#01AB00FF04050607\n");
  frame.stamp_ns = 5'000;
  frame.can_extended = false;
  frame.payload = {};
  EXPECT_EQ(line_of(frame), "(0000000000.000005) can1 004#\n");
}

TEST_F(Writers, FramesBeyondTheLimitsOfCanAreRejected) {
  const std::array<std::uint8_t, 65> data{};
  Frame frame;
  frame.payload = std::span(data).first(9);
  EXPECT_EQ(line_of(frame), "");
  frame.kind = FrameKind::kCanFd;
  frame.payload = data;
  EXPECT_EQ(line_of(frame), "");
  frame.payload = {};
  frame.can_id = 0x800;
  EXPECT_EQ(line_of(frame), "");
  frame.can_id = 0;
  frame.kind = FrameKind::kUdp;
  EXPECT_EQ(line_of(frame), "");
  CandumpWriter writer(folder_ / "a.log");
  EXPECT_THROW(writer.write(frame), WriteError);
}

TEST_F(Writers, AnyFrameWrittenIsReadAsItWas) {
  std::mt19937 random(5);
  std::vector<Copied> written;
  {
    CandumpWriter writer(folder_ / "all.log");
    for (int i = 0; i < 5000; ++i) {
      constexpr std::array<std::size_t, 16> kLengths = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
      Frame frame;
      frame.kind = random() % 2 == 0 ? FrameKind::kCan : FrameKind::kCanFd;
      frame.stamp_ns = 1'700'000'000'000'000'000 + i * 1'234'000LL;
      frame.set_interface(random() % 2 == 0 ? "can0" : "a_longer_name15");
      frame.can_extended = random() % 2 == 0;
      frame.can_id = static_cast<std::uint32_t>(random() % (frame.can_extended ? 0x20000000u : 0x800u));
      frame.can_remote = frame.kind == FrameKind::kCan && random() % 8 == 0;
      if (frame.kind == FrameKind::kCanFd) frame.can_fd_flags = static_cast<std::uint8_t>(random() % 4);
      std::string data(kLengths[random() % (frame.kind == FrameKind::kCan ? 9 : 16)], '\0');
      for (char& c : data) c = static_cast<char>(random());
      if (frame.can_remote) data.clear();
      frame.payload = {reinterpret_cast<const std::uint8_t*>(data.data()), data.size()};
      writer.write(frame);
      written.push_back({frame, data});
    }
    writer.write_drops("can0", 3, 7);
    writer.flush();
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(folder_ / "all.log"));
  }
  const Contents c = read(folder_ / "all.log");
  ASSERT_EQ(c.frames.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    const Frame &in = written[i].frame, &out = c.frames[i].frame;
    ASSERT_EQ(std::tuple(in.kind, in.stamp_ns, in.interface, in.can_extended, in.can_id, in.can_remote),
              std::tuple(out.kind, out.stamp_ns, out.interface, out.can_extended, out.can_id, out.can_remote))
        << i;
    ASSERT_EQ(in.can_fd_flags, out.can_fd_flags);
    ASSERT_EQ(written[i].data, c.frames[i].data);
  }
  EXPECT_THAT(problems_, testing::ElementsAre(testing::HasSubstr("the kernel dropped frames here")));
}

TEST_F(Writers, TheConsoleFormatOfCanUtilsReadsAsItsLog) {
  if (std::system("command -v log2long > /dev/null") != 0) GTEST_SKIP() << "skipped: no can-utils";
  {
    CandumpWriter writer(folder_ / "log");
    const std::array<std::uint8_t, 64> data = {0x41, 0x27, 0x20, 0x60, 0xFF, 0x5B, 0x28, 0x23, 0x0A};
    for (std::size_t size : {0, 1, 4, 8, 12, 64}) {
      for (const bool extended : {false, true}) {
        Frame frame;
        frame.kind = size > 8 ? FrameKind::kCanFd : FrameKind::kCan;
        frame.stamp_ns = 1'700'000'000'000'001'000;
        frame.set_interface("can1");
        frame.can_extended = extended;
        frame.can_id = 0x7F0;
        frame.payload = std::span(data).first(size);
        writer.write(frame);
        if (size > 8) continue;
        writer.write(frame, true);
        frame.can_remote = true;
        writer.write(frame);
        frame.kind = FrameKind::kCanFd;
        frame.can_remote = false;
        writer.write(frame);
      }
    }
    writer.flush();
  }
  const std::string in = (folder_ / "log").string(), out = (folder_ / "long").string();
  ASSERT_EQ(std::system(("log2long < " + in + " > " + out).c_str()), 0);
  const Contents log = read(in), console = read(out);
  EXPECT_TRUE(problems_.empty()) << problems_[0];
  ASSERT_EQ(log.frames.size(), 28u);
  ASSERT_EQ(console.frames.size(), log.frames.size());
  EXPECT_EQ(console.counts.error_frames, 8u);
  EXPECT_EQ(log.counts.error_frames, 8u);
  for (std::size_t i = 0; i < log.frames.size(); ++i) {
    const Frame &a = log.frames[i].frame, &b = console.frames[i].frame;
    EXPECT_EQ(std::tuple(a.kind, a.stamp_ns, a.interface, a.can_id, a.can_extended, a.can_remote),
              std::tuple(b.kind, b.stamp_ns, b.interface, b.can_id, b.can_extended, b.can_remote))
        << i;
    EXPECT_EQ(log.frames[i].data, console.frames[i].data) << i;
  }
}

TEST_F(Writers, PacketsKeepTheirNanosecondsAndTheirSizeOnTheWire) {
  {
    PcapWriter writer(folder_ / "raw.pcap", 12 /* DLT_RAW */, 65535);
    const std::string whole = udp_packet("hello");
    const auto bytes = std::span(reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size());
    writer.write(1'700'000'000'123'456'789, bytes, whole.size());
    writer.write(1'700'000'001'000'000'001, bytes.first(30), whole.size());
    writer.flush();
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(folder_ / "raw.pcap"));
  }
  const Contents c = read(folder_ / "raw.pcap");
  ASSERT_EQ(c.frames.size(), 1u);
  EXPECT_EQ(c.frames[0].frame.stamp_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(c.frames[0].data, "hello");
  EXPECT_THAT(problems_, testing::ElementsAre(testing::HasSubstr("only 30 of 33 bytes")));
}

TEST_F(Writers, AFullDiskAndAMissingFolderAreNamed) {
  EXPECT_THROW(CandumpWriter(folder_ / "absent" / "a.log"), WriteError);
  EXPECT_THROW(PcapWriter(folder_ / "absent" / "a.pcap", 1, 65535), WriteError);
  CandumpWriter writer("/dev/full");
  Frame frame;
  writer.write(frame);
  EXPECT_THROW(writer.flush(), WriteError);
  PcapWriter packets("/dev/full", 1, 65535);
  const std::vector<std::uint8_t> packet(100);
  packets.write(1, packet, packet.size());
  EXPECT_THROW(packets.flush(), WriteError);
}

}  // namespace
}  // namespace boresight::recording
