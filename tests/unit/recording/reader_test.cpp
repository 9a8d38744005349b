#include "services/common/recording/reader.hpp"

#include <algorithm>
#include <cstdio>

#include <fcntl.h>

#include "services/common/recording/byte_source.hpp"
#include "services/common/recording/line_reader.hpp"
#include "tests/unit/recording/capture_files.hpp"
#include "tests/unit/recording/files.hpp"

namespace boresight::recording {
namespace {

class CandumpFiles : public Files {};
class Captures : public Files {};

TEST_F(CandumpFiles, DosLineEndsErrorFramesAndAMissingLastNewline) {
  const Contents c = read(write("dos.log",
                                "(1.0) can0 123#01\r\n(2.0) can0 20000004#0004000000000000\r\n\r\n"
                                "(1.5) can0 123#02\r\n(3.0) can0 123#03"));
  ASSERT_EQ(c.frames.size(), 3u);
  EXPECT_EQ(c.frames[2].data, "\x03");
  EXPECT_EQ(c.counts.frames, 3u);
  EXPECT_EQ(c.counts.error_frames, 1u);
  EXPECT_EQ(c.counts.backwards, 0u);
  EXPECT_TRUE(problems_.empty());
}

TEST_F(CandumpFiles, StampsThatGoBackAreCountedAndKept) {
  const Contents c = read(write("back.log", "(2.0) can0 123#01\n(1.0) can1 123#02\n(3.0) can0 123#03\n"));
  ASSERT_EQ(c.frames.size(), 3u);
  EXPECT_EQ(c.frames[1].frame.stamp_ns, 1'000'000'000);
  EXPECT_EQ(c.counts.backwards, 1u);
}

TEST_F(CandumpFiles, ConsoleStampsSinceTheFirstFrameAndSinceThePreviousOne) {
  const std::vector<int> milliseconds = {0, 50, 51, 52, 102, 103, 104, 1150};
  std::string since_first, since_last;
  int last = 0;
  for (const int now : milliseconds) {
    char text[80];
    std::snprintf(text, sizeof text, " (%03d.%03d000)  can0  123   [1]  01\n", now / 1000, now % 1000);
    since_first += text;
    std::snprintf(text, sizeof text, " (%03d.%03d000)  can0  123   [1]  01\n", (now - last) / 1000,
                  (now - last) % 1000);
    since_last += text;
    last = now;
  }
  for (const auto& text : {since_first, since_last}) {
    const Contents c = read(write("console.log", text));
    ASSERT_EQ(c.frames.size(), milliseconds.size());
    for (std::size_t i = 0; i < milliseconds.size(); ++i) {
      EXPECT_EQ(c.frames[i].frame.stamp_ns, milliseconds[i] * 1'000'000LL) << text;
    }
  }
}

TEST_F(CandumpFiles, OtherTextIsRejectedLineByLineInFixedMemory) {
  // Three megabytes without a line end, then a good line: one problem, and the good line is read.
  const Contents c = read(write("noise.log", std::string(3'000'000, 'x') + "\n(1.0) can0 123#01\n"));
  EXPECT_EQ(c.frames.size(), 1u);
  ASSERT_EQ(problems_.size(), 1u);
  EXPECT_NE(problems_[0].find("noise.log:1: longer than any line"), std::string::npos) << problems_[0];
  EXPECT_EQ(c.progress.position_bytes, c.progress.total_bytes);
  problems_.clear();
  EXPECT_TRUE(read(write("noise.log", std::string(3'000'000, 'x'))).frames.empty());
  EXPECT_EQ(problems_.size(), 1u);
}

TEST_F(CandumpFiles, LinesMeetEveryBorderOfTheBuffer) {
  // 128 KiB buffers: lines of many lengths so that their ends fall anywhere.
  std::string text;
  int lines = 0;
  for (; text.size() < 1'500'000; ++lines) {
    text += "(" + std::to_string(lines) + ".0) can0 123##1" +
            std::string(static_cast<std::size_t>(lines % 9) * 2, 'A') +
            std::string(static_cast<std::size_t>(lines % 31), ' ') + "\n";
  }
  const Contents c = read(write("long.log", text));
  ASSERT_EQ(c.frames.size(), static_cast<std::size_t>(lines));
  EXPECT_TRUE(problems_.empty());
  for (std::size_t i = 0; i < c.frames.size(); ++i) {
    ASSERT_EQ(c.frames[i].frame.stamp_ns, static_cast<std::int64_t>(i) * 1'000'000'000);
    ASSERT_EQ(c.frames[i].data.size(), i % 9);
  }
}

TEST_F(CandumpFiles, ProgressGoesFromNothingToAll) {
  std::string text;
  for (int i = 0; i < 50'000; ++i) text += "(1.0) can0 123#0102030405060708\n";
  const auto reader = open_recording(write("progress.log", text), note_);
  EXPECT_EQ(reader->progress().position_bytes, 0u);
  EXPECT_EQ(reader->progress().total_bytes, text.size());
  Frame frame;
  ASSERT_TRUE(reader->next(frame));
  EXPECT_EQ(reader->progress().position_bytes, 32u);
  std::uint64_t last = 0;
  while (reader->next(frame)) {
    ASSERT_GT(reader->progress().position_bytes, last);
    last = reader->progress().position_bytes;
  }
  EXPECT_EQ(reader->progress().position_bytes, text.size());
}

TEST_F(CandumpFiles, StandardInputIsReadByContentToo) {
  const auto read_by_pipe = [&](const std::filesystem::path& file) {
    const int keep = dup(STDIN_FILENO);
    std::FILE* const pipe = popen(("cat '" + file.string() + "'").c_str(), "r");
    dup2(fileno(pipe), STDIN_FILENO);
    const Contents contents = read("-");
    dup2(keep, STDIN_FILENO);
    close(keep);
    pclose(pipe);
    EXPECT_EQ(contents.progress.total_bytes, 0u);
    return contents.frames.size();
  };
  EXPECT_EQ(read_by_pipe(write("a.log", "(1.0) can0 123#01\n(1.0) can0 123#02\n")), 2u);
  EXPECT_EQ(read_by_pipe(write("a.pcap", pcap_file(227, {{1, 0, socketcan_packet(0x123, "a")}}))), 1u);
}

TEST_F(CandumpFiles, UnsupportedFormatsAreNamed) {
  for (const auto& [magic, name] : {std::pair{"\x1F\x8B\x08", "gzip"}, {"LOGG", "BLF"}, {"MDF     4.10", "MDF"}}) {
    try {
      static_cast<void>(open_recording(write("other", magic), note_));
      ADD_FAILURE() << name;
    } catch (const OpenError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(static_cast<void>(open_recording(folder_, note_)), OpenError);
}

TEST_F(Captures, SocketCanClassicExtendedFdRemoteErrorAndXl) {
  const std::string xl = std::string("\x00\x00\x01\x23\x80\x00\x04\x00\x00\x00\x00\x00", 12) + "data";
  const Contents c = read(write("can.pcap", pcap_file(227, {{1, 5, socketcan_packet(0x123, "abc")},
                                                            {1, 6, socketcan_packet(0x98DAF110, "12345678")},
                                                            {1, 7, socketcan_packet(0x123, "fd", true, 0x04 | 0x01)},
                                                            {1, 8, socketcan_packet(0x123, "old", true)},
                                                            {1, 9, socketcan_packet(0x40000123, "x")},
                                                            {1, 10, socketcan_packet(0x20000004, "12345678")},
                                                            {1, 11, xl},
                                                            {1, 12, socketcan_packet(0x124, "").substr(0, 8)}})));
  ASSERT_EQ(c.frames.size(), 6u);
  EXPECT_EQ(c.frames[0].frame.stamp_ns, 1'000'000'005);
  EXPECT_EQ(c.frames[0].frame.interface_name(), "can0");
  EXPECT_EQ(c.frames[0].frame.kind, FrameKind::kCan);
  EXPECT_EQ(c.frames[0].data, "abc");
  EXPECT_TRUE(c.frames[1].frame.can_extended);
  EXPECT_EQ(c.frames[1].frame.can_id, 0x18DAF110u);
  EXPECT_EQ(c.frames[2].frame.kind, FrameKind::kCanFd) << "flagged";
  EXPECT_EQ(c.frames[2].frame.can_fd_flags, 1);
  EXPECT_EQ(c.frames[3].frame.kind, FrameKind::kCanFd) << "as large as the kernel's CAN FD frame";
  EXPECT_TRUE(c.frames[4].frame.can_remote);
  EXPECT_EQ(c.frames[4].data, "");
  EXPECT_EQ(c.frames[5].frame.can_id, 0x124u);
  EXPECT_EQ(c.counts.error_frames, 1u);
  ASSERT_EQ(problems_.size(), 1u);
  EXPECT_NE(problems_[0].find("can.pcap: packet 7: CAN XL"), std::string::npos) << problems_[0];
  EXPECT_EQ(read(folder_ / "can.pcap", {.can_interface = "can3"}).frames[0].frame.interface_name(), "can3");
}

TEST_F(Captures, EveryLinkLayerByteOrderAndUnitOfTime) {
  const std::string zero4(4, '\0');
  const std::string ethernet4 = std::string(12, '\1') + std::string("\x08\x00", 2);
  const std::string ethernet6 = std::string(12, '\1') + std::string("\x86\xDD", 2);
  const std::string tagged = std::string(12, '\1') + std::string("\x88\xA8\x00\x05\x81\x00\x00\x07\x08\x00", 10);
  const std::string cooked(14, '\0');
  const std::string cooked2 = std::string(18, '\0');
  const std::string v4 = udp_packet("hello"), v6 = udp_packet("hello", true);
  const std::string can = socketcan_packet(0x123, "hello", false, 0, false);
  const std::vector<std::pair<std::uint32_t, std::string>> packets = {
      {1, ethernet4 + v4},
      {1, ethernet6 + v6},
      {1, tagged + v4},
      {101, v4},
      {101, v6},
      {228, v4},
      {229, v6},
      {0, std::string("\x02\x00\x00\x00", 4) + v4},
      {0, std::string("\x1E\x00\x00\x00", 4) + v6},
      {108, std::string("\x00\x00\x00\x02", 4) + v4},
      {113, cooked + std::string("\x08\x00", 2) + v4},
      {113, cooked + std::string("\x86\xDD", 2) + v6},
      {113, cooked + std::string("\x81\x00\x00\x07\x08\x00", 6) + v4},
      {113, cooked + std::string("\x00\x0C", 2) + can},
      {276, std::string("\x08\x00", 2) + cooked2 + v4},
      {276, std::string("\x86\xDD", 2) + cooked2 + v6},
      {276, std::string("\x00\x0C", 2) + cooked2 + can},
  };
  for (const auto& [link, bytes] : packets) {
    for (const bool big_endian : {false, true}) {
      // Cooked captures hold CAN ids in the byte order of the capturing machine; libpcap converts them, in v1 only.
      if (link == 276 && big_endian && bytes.find(can) != std::string::npos) continue;
      std::string packet = bytes;
      if (const auto at = packet.find(can); big_endian && at != std::string::npos) {
        std::reverse(packet.begin() + static_cast<std::ptrdiff_t>(at),
                     packet.begin() + static_cast<std::ptrdiff_t>(at) + 4);
      }
      for (const bool nanoseconds : {false, true}) {
        const Contents c = read(write("link.pcap", pcap_file(link, {{7, 5, packet}}, nanoseconds, big_endian)));
        ASSERT_EQ(c.frames.size(), 1u) << link << testing::PrintToString(problems_);
        EXPECT_EQ(c.frames[0].frame.stamp_ns, 7'000'000'000 + (nanoseconds ? 5 : 5000)) << link;
        EXPECT_EQ(c.frames[0].data, "hello") << link;
        if (c.frames[0].frame.kind != FrameKind::kUdp) {
          EXPECT_EQ(c.frames[0].frame.can_id, 0x123u);
          continue;
        }
        EXPECT_EQ(c.frames[0].frame.source.port, 1000) << link;
        EXPECT_EQ(c.frames[0].frame.destination.port, 2000) << link;
        const std::string address = to_text(c.frames[0].frame.destination.address);
        EXPECT_TRUE(address == "10.0.0.2" || address == "fd00::2") << address;
      }
    }
    for (std::size_t size = 0; size < bytes.size(); ++size) {  // truncated anywhere
      problems_.clear();
      const Contents cut = read(write("cut.pcap", pcap_file(link, {{7, 5, bytes.substr(0, size), 2000}})));
      const bool is_can = bytes.find(can) != std::string::npos;
      if (is_can && size >= bytes.size() - 3) continue;  // only padding after the data is missing
      EXPECT_TRUE(cut.frames.empty()) << link << " " << size;
      ASSERT_EQ(problems_.size(), 1u) << link << " " << size;
      EXPECT_NE(problems_[0].find("bytes were captured (snapshot length)"), std::string::npos) << problems_[0];
    }
  }
}

TEST_F(Captures, OtherTrafficIsCountedAndUnsupportedLinksAreNamed) {
  const std::string arp = std::string(12, '\1') + std::string("\x08\x06", 2) + std::string(28, '\0');
  const Contents c = read(write("arp.pcap", pcap_file(1, {{1, 0, arp}})));
  EXPECT_TRUE(c.frames.empty());
  EXPECT_EQ(c.counts.ignored, 1u);
  EXPECT_TRUE(problems_.empty());
  try {
    static_cast<void>(open_recording(write("wifi.pcap", pcap_file(105, {})), note_));
    ADD_FAILURE() << "opened";
  } catch (const OpenError& error) {
    EXPECT_NE(std::string(error.what()).find("wifi.pcap: link type IEEE802_11 is not supported"), std::string::npos)
        << error.what();
  }
}

TEST_F(Captures, PcapngInterfacesAreDistinguished) {
  const std::string ethernet = std::string(12, '\1') + std::string("\x08\x00", 2);
  const std::string file = pcapng_file({{227, "can1"}, {1, "eth0"}, {227, "can2", false}, {105, "wlan0"}},
                                       {{5, 7, socketcan_packet(0x123, "one"), 0, 0},
                                        {6, 7, ethernet + udp_packet("hello"), 0, 1},
                                        {7, 7, socketcan_packet(0x123, "two"), 0, 2},
                                        {8, 7, "radio", 0, 3},
                                        {9, 7, ethernet + udp_packet("again"), 0, 1}});
  const Contents c = read(write("many.pcapng", file));
  ASSERT_EQ(c.frames.size(), 4u);
  EXPECT_EQ(c.frames[0].frame.interface_name(), "can1");
  EXPECT_EQ(c.frames[0].frame.stamp_ns, 5'000'000'007);
  EXPECT_EQ(c.frames[0].data, "one");
  EXPECT_EQ(c.frames[1].data, "hello");
  EXPECT_EQ(c.frames[1].frame.interface_name(), "");
  EXPECT_EQ(c.frames[2].frame.interface_name(), "can2");
  EXPECT_EQ(c.frames[2].frame.stamp_ns, 7'000'007'000) << "microseconds";
  EXPECT_EQ(c.frames[3].data, "again");
  ASSERT_EQ(problems_.size(), 1u);
  EXPECT_NE(problems_[0].find("interface wlan0 has link type 105"), std::string::npos) << problems_[0];
  EXPECT_EQ(c.progress.position_bytes, file.size());
}

TEST_F(Captures, PcapngOfTwoSectionsAndUnknownBlocks) {
  std::string huge(700'000, 'n');
  const std::string file = pcapng_file({{227, "can1"}}, {{1, 0, socketcan_packet(1, "a")}}) + pcapng_block(4, huge) +
                           pcapng_block(0x77777777, "what") +
                           pcapng_file({{227, "can2"}}, {{2, 0, socketcan_packet(2, "b")}});
  const Contents c = read(write("two.pcapng", file));
  ASSERT_EQ(c.frames.size(), 2u);
  EXPECT_EQ(c.frames[1].frame.interface_name(), "can2") << "interfaces are those of the section";
  EXPECT_TRUE(problems_.empty());
}

TEST_F(Captures, PcapngUnitsOfTime) {
  const auto stamp_of = [&](std::uint8_t resolution, std::uint64_t stamp) {
    std::string file = pcapng_file({{227, "can1"}}, {{0, 0, socketcan_packet(1, "a")}});
    const auto unit = file.find(std::string("\x09\x00\x01\x00\x09", 5));
    file[unit + 4] = static_cast<char>(resolution);
    std::string halves;
    append_number(halves, stamp >> 32, 4);
    append_number(halves, stamp & 0xFFFFFFFF, 4);
    const auto packet = file.find(std::string("\x06\x00\x00\x00", 4), unit + 8);
    file.replace(packet + 12, 8, halves);
    const Contents c = read(write("unit.pcapng", file));
    return c.frames.size() == 1 ? c.frames[0].frame.stamp_ns : -1;
  };
  EXPECT_EQ(stamp_of(9, 1'700'000'000'123'456'789), 1'700'000'000'123'456'789);
  EXPECT_EQ(stamp_of(6, 1'700'000'000'123'456), 1'700'000'000'123'456'000);
  EXPECT_EQ(stamp_of(0, 17), 17'000'000'000);
  EXPECT_EQ(stamp_of(12, 1'500'000'000'007'000), 1'500'000'000'007);
  EXPECT_EQ(stamp_of(0x80 | 1, 3), 1'500'000'000);
  EXPECT_EQ(stamp_of(0x80 | 32, std::uint64_t{5} << 32 | 0x80000000), 5'500'000'000);
  EXPECT_EQ(stamp_of(0x80 | 63, 0xC000000000000000), 1'500'000'000);
  EXPECT_EQ(stamp_of(0, ~std::uint64_t{0}), -1) << "beyond the last valid second";
  EXPECT_EQ(stamp_of(20, 1), -1) << "no such unit";
}

TEST_F(Captures, DamageInPcapngLosesOnlyTheDamagedBlocks) {
  std::vector<CapturedPacket> packets;
  for (std::uint32_t i = 0; i < 100; ++i) packets.push_back({i, 0, socketcan_packet(i, "12345678")});
  const std::string whole = pcapng_file({{227, "can1"}}, packets);
  ASSERT_EQ(read(write("whole.pcapng", whole)).frames.size(), 100u);
  for (const char garbage : {'\0', '\xFF', '\x06'}) {
    std::string damaged = whole;
    std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2), 60, garbage);
    problems_.clear();
    const std::size_t frames = read(write("damaged.pcapng", damaged)).frames.size();
    EXPECT_GE(frames, 97u);
    EXPECT_LT(frames, 100u);
    EXPECT_GE(problems_.size(), 1u);
    EXPECT_LE(problems_.size(), 3u);
  }
  problems_.clear();
  EXPECT_EQ(read(write("cut.pcapng", whole.substr(0, whole.size() - 10))).frames.size(), 99u);
  EXPECT_EQ(problems_.size(), 1u);
  std::string other_order;
  append_number(other_order, 0x0A0D0D0A, 4, true);
  append_number(other_order, 28, 4, true);
  append_number(other_order, 0x1A2B3C4D, 4, true);
  append_number(other_order, 0x00010000FFFFFFFF, 8, true);
  append_number(other_order, 0xFFFFFFFF, 4, true);
  append_number(other_order, 28, 4, true);
  append_number(other_order, 1, 4, true);
  append_number(other_order, 20, 4, true);
  append_number(other_order, 227u << 16, 4, true);
  append_number(other_order, 65535, 4, true);
  append_number(other_order, 20, 4, true);
  append_number(other_order, 6, 4, true);
  append_number(other_order, 48, 4, true);
  append_number(other_order, 0, 4, true);
  append_number(other_order, 2'000'003, 8, true);
  append_number(other_order, 16, 4, true);
  append_number(other_order, 16, 4, true);
  other_order += socketcan_packet(0x123, "big");
  append_number(other_order, 48, 4, true);
  const Contents c = read(write("big.pcapng", other_order));
  ASSERT_EQ(c.frames.size(), 1u);
  EXPECT_EQ(c.frames[0].data, "big");
  EXPECT_EQ(c.frames[0].frame.stamp_ns, 2'000'003'000) << "microseconds by default";
  EXPECT_EQ(c.frames[0].frame.interface_name(), "can0");
}

TEST_F(Captures, StampsThatGoBackAreCountedAndMissingFragmentsReported) {
  std::string first = udp_packet(std::string(16, 'a'));
  first[6] = 0x20;  // more fragments follow
  const Contents c =
      read(write("raw.pcap", pcap_file(101, {{5, 0, udp_packet("a")}, {4, 0, udp_packet("b")}, {6, 0, first}})));
  EXPECT_EQ(c.frames.size(), 2u);
  EXPECT_EQ(c.counts.backwards, 1u);
  ASSERT_EQ(problems_.size(), 1u);
  EXPECT_NE(problems_[0].find("1 datagrams are incomplete"), std::string::npos) << problems_[0];
}

}  // namespace
}  // namespace boresight::recording
