#include "services/common/recording/candump.hpp"

#include <random>

#include <gtest/gtest.h>

namespace boresight::recording {
namespace {

struct Parsed {
  explicit Parsed(std::string_view text) : result(parse_candump_line(text, line)) {}
  CandumpLine line;
  CandumpResult result;
  const Frame& frame = line.frame;
  const std::array<std::uint8_t, 64>& bytes = line.bytes;
  std::vector<int> data() const { return {frame.payload.begin(), frame.payload.end()}; }
};

Parsed parse(std::string_view line) {
  return Parsed(line);
}

TEST(Candump, ClassicExtendedFdAndRemoteFrames) {
  const Parsed classic = parse("(1700000000.123456) can1 210#93382608AC0901C9");
  ASSERT_EQ(classic.result, CandumpResult::kFrame);
  EXPECT_EQ(classic.frame.stamp_ns, 1'700'000'000'123'456'000);
  EXPECT_EQ(classic.frame.interface_name(), "can1");
  EXPECT_EQ(classic.frame.can_id, 0x210u);
  EXPECT_FALSE(classic.frame.can_extended);
  ASSERT_EQ(classic.frame.payload.size(), 8u);
  EXPECT_EQ(classic.bytes[0], 0x93);
  EXPECT_EQ(classic.bytes[7], 0xC9);
  const Parsed extended = parse("(1.0) vcan0 18DAF110#0102");
  ASSERT_EQ(extended.result, CandumpResult::kFrame);
  EXPECT_TRUE(extended.frame.can_extended);
  EXPECT_EQ(extended.frame.can_id, 0x18DAF110u);
  const Parsed fd = parse("(1.0) can0 123##1" + std::string(128, 'A'));
  ASSERT_EQ(fd.result, CandumpResult::kFrame);
  EXPECT_EQ(fd.frame.kind, FrameKind::kCanFd);
  EXPECT_EQ(fd.frame.payload.size(), 64u);
  const Parsed remote = parse("(1.0) can0 123#R8");
  ASSERT_EQ(remote.result, CandumpResult::kFrame);
  EXPECT_TRUE(remote.frame.can_remote);
  EXPECT_EQ(parse("(1.0) can0 123#").frame.payload.size(), 0u);
  EXPECT_EQ(parse("(1.0) can0 123#01.02.03 R\r").frame.payload.size(), 3u);
  EXPECT_EQ(parse("(1.0) can0 123#0102 T").result, CandumpResult::kFrame);
}

TEST(Candump, StampsKeepEveryDigit) {
  EXPECT_EQ(parse("(0.000001) c 001#").frame.stamp_ns, 1000);
  EXPECT_EQ(parse("(1700000000.999999999) c 001#").frame.stamp_ns, 1'700'000'000'999'999'999);
  EXPECT_EQ(parse("(1700000000.9999999999) c 001#").frame.stamp_ns, 1'700'000'000'999'999'999);
}

// Both notations accept the same stamps: a written recording must be readable.
TEST(Candump, BothNotationsEndAtTheSameSecond) {
  EXPECT_EQ(parse("(9000000000.5) can0 123#").frame.stamp_ns, 9'000'000'000'500'000'000);
  EXPECT_EQ(parse("(9000000001.0) can0 123#").result, CandumpResult::kBadStamp);
  // `date -u -d @9000000000` says 2255-03-14 16:00:00.
  EXPECT_EQ(parse(" (2255-03-14 16:00:00.5)  can0  123   [0]").frame.stamp_ns, 9'000'000'000'500'000'000);
  EXPECT_EQ(parse(" (2255-03-14 16:00:01.0)  can0  123   [0]").result, CandumpResult::kBadStamp);
  EXPECT_EQ(parse(" (9999-12-31 23:59:60.0)  can0  123   [0]").result, CandumpResult::kBadStamp);
}

TEST(Candump, EveryFaultHasItsResult) {
  EXPECT_EQ(parse("").result, CandumpResult::kEmpty);
  EXPECT_EQ(parse("  \r").result, CandumpResult::kEmpty);
  for (const char* line : {"1.0 can0 123#00", "can0 123#00", " can0  123   [1]  00", "nonsense"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kNoStamp) << line;
  }
  for (const char* line : {"(1) can0 123#00", "(.5) can0 123#", "(99999999999.0) can0 123#", "(-1.0) can0 123#",
                           "(1.0.0) can0 123#", "()"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadStamp) << line;
  }
  EXPECT_EQ(parse("(1.0)").result, CandumpResult::kBadName);
  EXPECT_EQ(parse("(1.0) a_name_of_17_chars 123#00").result, CandumpResult::kBadName);
  EXPECT_EQ(parse(std::string_view("(1.0) \0can0 123#00", 18)).result, CandumpResult::kBadName);
  for (const char* line : {"(1.0) can0 12#00", "(1.0) can0 1234#00", "(1.0) can0 800#00", "(1.0) can0 4FFFFFFF#00",
                           "(1.0) can0 12G#00", "(1.0) can0"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadId) << line;
  }
  for (const char* line : {"(1.0) can0 123#0", "(1.0) can0 123#0G", "(1.0) can0 123#000102030405060708",
                           "(1.0) can0 123##", "(1.0) can0 123##1000000000000000000", "(1.0) can0 123#R9"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadData) << line;
  }
  EXPECT_EQ(parse("(1.0) can0 123#00 R and more").result, CandumpResult::kTrailingText);
  for (int i = 0; i <= static_cast<int>(CandumpResult::kTooLong); ++i) {
    EXPECT_FALSE(describe(static_cast<CandumpResult>(i)).empty());
  }
}

TEST(Candump, NewerLogsWithRawLengthCodesAndDirections) {
  EXPECT_EQ(parse("(1.0)  can0 123#1122334455667788_9").data(), (std::vector<int>{17, 34, 51, 68, 85, 102, 119, 136}));
  EXPECT_TRUE(parse("(1.0) can0 123#R8_D T").frame.can_remote);
  EXPECT_EQ(parse("(1.0) can0 123##3AA").frame.can_fd_flags, 3);
  EXPECT_EQ(parse("(1.0) can0 123#0_1").result, CandumpResult::kBadData);
}

TEST(Candump, ConsoleWithStamps) {
  const Parsed absolute = parse(" (1700000000.123456)  can0  123   [8]  11 22 33 44 55 66 77 88");
  ASSERT_EQ(absolute.result, CandumpResult::kFrame);
  EXPECT_EQ(absolute.line.stamp, CandumpStamp::kAbsolute);
  EXPECT_EQ(absolute.frame.stamp_ns, 1'700'000'000'123'456'000);
  EXPECT_EQ(absolute.frame.interface_name(), "can0");
  EXPECT_EQ(absolute.frame.can_id, 0x123u);
  EXPECT_EQ(absolute.data(), (std::vector<int>{0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}));
  const Parsed relative = parse(" (001.234567)  can0  12345678   [4]  DE AD BE EF               '....'\r\n");
  ASSERT_EQ(relative.result, CandumpResult::kFrame);
  EXPECT_EQ(relative.line.stamp, CandumpStamp::kRelative);
  EXPECT_EQ(relative.frame.stamp_ns, 1'234'567'000);
  EXPECT_TRUE(relative.frame.can_extended);
  EXPECT_EQ(relative.data(), (std::vector<int>{0xDE, 0xAD, 0xBE, 0xEF}));
  // `date -u -d '2006-11-20 20:20:26' +%s` says 1164054026; 2024-02-29 tests the leap day.
  EXPECT_EQ(parse(" (2006-11-20 20:20:26.000001)  can0  123   [0]").frame.stamp_ns, 1'164'054'026'000'001'000);
  EXPECT_EQ(parse(" (2024-02-29 12:00:00.5)  can0  123   [0]").frame.stamp_ns, 1'709'208'000'500'000'000);
  EXPECT_EQ(parse(" (2006-13-20 20:20:26.000001)  can0  123   [0]").result, CandumpResult::kBadStamp);
}

TEST(Candump, ConsoleFdRemoteErrorAndOtherViews) {
  std::string text = " (0000000001.000000)  can1       123  [24] ";
  for (int i = 0; i < 24; ++i) text += i % 2 == 0 ? " 0A" : " f0";
  const Parsed fd = parse(text);
  ASSERT_EQ(fd.result, CandumpResult::kFrame);
  EXPECT_EQ(fd.frame.kind, FrameKind::kCanFd);
  ASSERT_EQ(fd.frame.payload.size(), 24u);
  EXPECT_EQ(fd.bytes[23], 0xF0);
  EXPECT_EQ(parse(" (0000000001.0)  can0  123  [08]  01 02 03 04 05 06 07 08").frame.kind, FrameKind::kCanFd);
  EXPECT_TRUE(parse(" (0000000001.0)  can0  123   [8]  remote request").frame.can_remote);
  EXPECT_EQ(parse(" (0000000001.0)  can0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME").result,
            CandumpResult::kErrorFrame);
  EXPECT_EQ(parse("(1.0) can0 20000004#0004000000000000").result, CandumpResult::kErrorFrame);
  EXPECT_EQ(parse(" (0000000001.0)  can0  20000004   [8]  remote request").result, CandumpResult::kErrorFrame);
  EXPECT_EQ(parse("\tcontroller-problem{rx-error-warning}").result, CandumpResult::kEmpty);
  const Parsed extra = parse(" (0000000001.0)  can0  TX B E  123  [02]  01 02");
  ASSERT_EQ(extra.result, CandumpResult::kFrame);
  EXPECT_EQ(extra.frame.can_fd_flags, 3);
  EXPECT_EQ(parse(" (0000000001.0)  can0  RX - -  123   [2]  01 02").data(), (std::vector<int>{1, 2}));
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [3]  33`22`11                  `\"3\".`").data(),
            (std::vector<int>{0x11, 0x22, 0x33}))
      << "candump -S prints the last byte first";
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [2]  00000001 10000000").data(), (std::vector<int>{1, 128}));
  EXPECT_EQ(parse(" \x1B[31m(0000000001.0)  \x1B[0mcan0  123   [1]  07\x1B[0m").data(), (std::vector<int>{7}));
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   {C}  01 02 03 04 05 06 07 08").frame.payload.size(), 8u);
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [2]  41 42                     'AB'").result, CandumpResult::kFrame);
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [2]  20 27                     ' ''").result, CandumpResult::kFrame);
}

TEST(Candump, ContradictoryConsoleLines) {
  for (const char* line : {" (0000000001.0)  can0  123   [3]  01 02", " (0000000001.0)  can0  123   [9]  01",
                           " (0000000001.0)  can0  123  [09]  01 02 03 04 05 06 07 08 09",
                           " (0000000001.0)  can0  123   [2]  01 2", " (0000000001.0)  can0  123   [2]  01 002",
                           " (0000000001.0)  can0  123   [1]  00000002", " (0000000001.0)  can0  123"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadData) << line;
  }
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [1]  01 02").result, CandumpResult::kTrailingText);
  EXPECT_EQ(parse(" (0000000001.0)  can0  8FF   [1]  01").result, CandumpResult::kBadId);
}

TEST(Candump, CanXlAndDropsAreReportedAndLengthIsBounded) {
  EXPECT_EQ(parse("(1.0) can0 00123#81:00:12345678#1122").result, CandumpResult::kCanXl);
  EXPECT_EQ(parse(" (0000000001.0)  can0  123   [0002] (00|81:00:12345678)  11 22").result, CandumpResult::kCanXl);
  EXPECT_EQ(parse("DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)").result,
            CandumpResult::kDropCount);
  EXPECT_EQ(parse(std::string(kMaxCandumpLine + 1, '(')).result, CandumpResult::kTooLong);
  EXPECT_FALSE(is_problem(CandumpResult::kErrorFrame));
  EXPECT_TRUE(is_problem(CandumpResult::kDropCount));
}

TEST(Candump, MutationsAreParsedOrRejected) {
  std::mt19937 random(1);
  const std::array<std::string, 2> goods = {
      "(1700000000.123456) can1 18DAF110##193382608AC0901C9 T",
      " (1700000000.123456)  can1  RX - -  18DAF110  [08]  93 38 26 08 AC 09 01 C9   '.8&.....'"};
  std::uniform_int_distribution<int> byte(0, 255);
  int accepted = 0;
  for (int round = 0; round < 50'000; ++round) {
    std::string line = goods[static_cast<std::size_t>(round) % 2];
    for (int n = round % 4; n >= 0; --n) {
      line[static_cast<std::size_t>(byte(random)) % line.size()] = static_cast<char>(byte(random));
    }
    if (round % 3 == 0) line.resize(static_cast<std::size_t>(byte(random)) % line.size());
    const Parsed p = parse(line);
    if (p.result != CandumpResult::kFrame) continue;
    ++accepted;
    ASSERT_LE(p.frame.payload.size(), 64u);
    ASSERT_LE(p.frame.can_id, 0x1FFFFFFFu);
    ASSERT_GE(p.frame.stamp_ns, 0);
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace boresight::recording
