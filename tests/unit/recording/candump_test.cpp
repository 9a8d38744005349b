#include "services/common/recording/candump.hpp"

#include <random>

#include <gtest/gtest.h>

namespace boresight::recording {
namespace {

struct Parsed {
  CandumpResult result;
  Frame frame;
  std::array<std::uint8_t, 64> bytes;
};

Parsed parse(std::string_view line) {
  Parsed p{};
  p.result = parse_candump_line(line, p.frame, p.bytes);
  return p;
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

TEST(Candump, SaysWhatIsWrong) {
  EXPECT_EQ(parse("").result, CandumpResult::kEmpty);
  EXPECT_EQ(parse("  \r").result, CandumpResult::kEmpty);
  for (const char* line : {"1.0 can0 123#00", "(1) can0 123#00", "(.5) can0 123#", "(99999999999.0) can0 123#",
                           "(-1.0) can0 123#", "(1.0.0) can0 123#", "()"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadStamp) << line;
  }
  EXPECT_EQ(parse("(1.0)").result, CandumpResult::kBadName);
  EXPECT_EQ(parse("(1.0) a_name_of_17_chars 123#00").result, CandumpResult::kBadName);
  for (const char* line : {"(1.0) can0 12#00", "(1.0) can0 1234#00", "(1.0) can0 800#00", "(1.0) can0 2FFFFFFF#00",
                           "(1.0) can0 12G#00", "(1.0) can0 123", "(1.0) can0"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadId) << line;
  }
  for (const char* line : {"(1.0) can0 123#0", "(1.0) can0 123#0G", "(1.0) can0 123#000102030405060708",
                           "(1.0) can0 123##", "(1.0) can0 123##1000000000000000000", "(1.0) can0 123#R9"}) {
    EXPECT_EQ(parse(line).result, CandumpResult::kBadData) << line;
  }
  EXPECT_EQ(parse("(1.0) can0 123#00 R and more").result, CandumpResult::kTrailingText);
  for (int i = 0; i <= static_cast<int>(CandumpResult::kTrailingText); ++i) {
    EXPECT_FALSE(describe(static_cast<CandumpResult>(i)).empty());
  }
}

TEST(Candump, MutationsAreParsedOrRefused) {
  std::mt19937 random(1);
  const std::string good = "(1700000000.123456) can1 18DAF110##193382608AC0901C9 T";
  std::uniform_int_distribution<int> byte(0, 255);
  int accepted = 0;
  for (int round = 0; round < 50'000; ++round) {
    std::string line = good;
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
