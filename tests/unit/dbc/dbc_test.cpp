// The reader of DBC files.
#include "services/ingest_gateway/dbc/dbc.hpp"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boresight::ingest::dbc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::string_view kPreamble = R"(VERSION "1"

NS_ :
	CM_
	BO_
	SG_
	SIG_VALTYPE_
	SG_MUL_VAL_

BS_:

BU_: ECU RADAR
)";

Database parse(const std::string& text) {
  return parse_dbc(std::string(kPreamble) + text, "t.dbc");
}

std::vector<std::string> names_of(const Message& message) {
  std::vector<std::string> names;
  for (const Signal& signal : message.signals) names.push_back(signal.name);
  return names;
}

TEST(Dbc, EveryFieldOfASignalIsRead) {
  const Database database = parse(R"(
BO_ 528 TRACK: 8 RADAR
 SG_ DIST : 15|13@0- (0.01,-500) [-500|300.5] "m" ECU,RADAR
 SG_ SPEED : 8|12@1+ (+2.5E-002,0) [0|1E3] "" Vector__XXX
BO_ 2566844672 LONG_ID: 64 RADAR
 SG_ LAST : 448|64@1- (1,0) [0|0] "rad/s" ECU
)");
  EXPECT_THAT(database.problems, IsEmpty());
  ASSERT_THAT(database.messages, SizeIs(2));
  const Message& track = database.messages[0];
  EXPECT_EQ(track.id, 528u);
  EXPECT_FALSE(track.extended);
  EXPECT_EQ(track.name, "TRACK");
  EXPECT_EQ(track.length_bytes, 8);
  const Signal* const distance = track.find("DIST");
  ASSERT_NE(distance, nullptr);
  EXPECT_EQ(distance->start_bit, 15);
  EXPECT_EQ(distance->length, 13);
  EXPECT_EQ(distance->order, wire::ByteOrder::kMotorola);
  EXPECT_TRUE(distance->is_signed);
  EXPECT_DOUBLE_EQ(distance->factor, 0.01);
  EXPECT_DOUBLE_EQ(distance->offset, -500.0);
  EXPECT_DOUBLE_EQ(distance->minimum, -500.0);
  EXPECT_DOUBLE_EQ(distance->maximum, 300.5);
  EXPECT_EQ(distance->unit, "m");
  EXPECT_EQ(distance->role, MultiplexRole::kNone);
  const Signal* const speed = track.find("SPEED");
  ASSERT_NE(speed, nullptr);
  EXPECT_EQ(speed->order, wire::ByteOrder::kIntel);
  EXPECT_FALSE(speed->is_signed);
  EXPECT_DOUBLE_EQ(speed->factor, 0.025);
  EXPECT_DOUBLE_EQ(speed->maximum, 1000.0);
  const Message& long_id = database.messages[1];
  EXPECT_TRUE(long_id.extended);
  EXPECT_EQ(long_id.id, 2566844672u & 0x1FFFFFFFu);
  EXPECT_EQ(long_id.signals.front().length, 64);
  EXPECT_EQ(track.find("NOTHING"), nullptr);
  EXPECT_EQ(database.find("LONG_ID"), &long_id);
  EXPECT_EQ(database.find("NOTHING"), nullptr);
}

TEST(Dbc, PlainMultiplexing) {
  const Database database = parse(R"(BO_ 1 M: 8 X
 SG_ SWITCH M : 0|8@1+ (1,0) [0|0] "" X
 SG_ A m0 : 8|8@1+ (1,0) [0|0] "" X
 SG_ B m17 : 8|8@1+ (1,0) [0|0] "" X
 SG_ ALWAYS : 16|8@1+ (1,0) [0|0] "" X
)");
  EXPECT_THAT(database.problems, IsEmpty());
  const Message& message = database.messages.at(0);
  EXPECT_EQ(message.find("SWITCH")->role, MultiplexRole::kSwitch);
  EXPECT_EQ(message.find("ALWAYS")->role, MultiplexRole::kNone);
  const Signal& b = *message.find("B");
  EXPECT_EQ(b.role, MultiplexRole::kValue);
  EXPECT_EQ(message.signals.at(b.switch_index).name, "SWITCH");
  ASSERT_THAT(b.switch_values, SizeIs(1));
  EXPECT_EQ(b.switch_values[0].first, 17u);
  EXPECT_EQ(b.switch_values[0].last, 17u);
}

TEST(Dbc, ExtendedMultiplexing) {
  const Database database = parse(R"(BO_ 2147483649 M: 8 X
 SG_ OUTER M : 0|4@1+ (1,0) [0|0] "" X
 SG_ INNER m1M : 4|4@1+ (1,0) [0|0] "" X
 SG_ DEEP m3 : 8|8@1+ (1,0) [0|0] "" X
 SG_ WIDE m0 : 16|8@1+ (1,0) [0|0] "" X
SG_MUL_VAL_ 2147483649 INNER OUTER 1-1;
SG_MUL_VAL_ 2147483649 DEEP INNER 3-5, 8-8,10-12;
)");
  EXPECT_THAT(database.problems, IsEmpty());
  const Message& message = database.messages.at(0);
  const Signal& inner = *message.find("INNER");
  const Signal& deep = *message.find("DEEP");
  EXPECT_EQ(inner.role, MultiplexRole::kValueAndSwitch);
  EXPECT_EQ(message.signals.at(inner.switch_index).name, "OUTER");
  EXPECT_EQ(message.signals.at(deep.switch_index).name, "INNER");
  ASSERT_THAT(deep.switch_values, SizeIs(3));
  EXPECT_EQ(deep.switch_values[0].last, 5u);
  EXPECT_EQ(deep.switch_values[1].first, 8u);
  EXPECT_EQ(deep.switch_values[2].last, 12u);
  // Without its own statement it depends on the only plain switch.
  EXPECT_EQ(message.signals.at(message.find("WIDE")->switch_index).name, "OUTER");
}

TEST(Dbc, MultiplexingInCirclesOrWithoutASwitchIsReportedAndSkipped) {
  const Database database = parse(R"(BO_ 1 M: 8 X
 SG_ A m1M : 0|4@1+ (1,0) [0|0] "" X
 SG_ B m1M : 4|4@1+ (1,0) [0|0] "" X
 SG_ C m1 : 8|8@1+ (1,0) [0|0] "" X
 SG_ KEPT : 16|8@1+ (1,0) [0|0] "" X
BO_ 2 N: 8 X
 SG_ D m1 : 0|4@1+ (1,0) [0|0] "" X
SG_MUL_VAL_ 1 A B 1-1;
SG_MUL_VAL_ 1 B A 1-1;
SG_MUL_VAL_ 1 C KEPT 1-1;
SG_MUL_VAL_ 1 KEPT A 1-1;
SG_MUL_VAL_ 1 A A 3-1;
)");
  EXPECT_THAT(names_of(database.messages.at(0)), ElementsAre("KEPT"));
  EXPECT_THAT(names_of(database.messages.at(1)), IsEmpty());
  EXPECT_THAT(database.problems,
              testing::UnorderedElementsAre(HasSubstr("t.dbc:22: there is no such switch"),
                                            HasSubstr("t.dbc:23: signal is not multiplexed"),
                                            HasSubstr("t.dbc:24: SG_MUL_VAL_ must be"),
                                            HasSubstr("t.dbc:19: multiplexed signal, but its message has no"),
                                            HasSubstr("t.dbc:14: signal depends on more than 4 switches"),
                                            HasSubstr("t.dbc:15: signal depends on more than 4 switches")));
}

TEST(Dbc, FloatKinds) {
  const Database database = parse(R"(BO_ 9 M: 16 X
 SG_ F : 0|32@1- (1,0) [0|0] "" X
 SG_ D : 64|64@1- (1,0) [0|0] "" X
 SG_ I : 32|16@1- (1,0) [0|0] "" X
SIG_VALTYPE_ 9 F : 1;
SIG_VALTYPE_ 9 D 2;
SIG_VALTYPE_ 9 I : 1;
SIG_VALTYPE_ 9 I : 7;
SIG_VALTYPE_ 9 NONE : 1;
)");
  const Message& message = database.messages.at(0);
  EXPECT_EQ(message.find("F")->kind, wire::SignalKind::kFloat32);
  EXPECT_EQ(message.find("D")->kind, wire::SignalKind::kFloat64);
  EXPECT_EQ(message.find("I")->kind, wire::SignalKind::kInteger);
  EXPECT_THAT(database.problems, ElementsAre(HasSubstr("t.dbc:19: a float has 32 bits"), HasSubstr("t.dbc:20:"),
                                             HasSubstr("t.dbc:21: there is no such signal")));
}

TEST(Dbc, OtherStatementsAreSkippedEvenOverManyLines) {
  const Database database = parse(R"(BO_ 1 M: 8 X
 SG_ A : 0|8@1+ (1,0) [0|0] "" X

CM_ SG_ 1 A "a comment that speaks of
BO_ 2 NOT_A_MESSAGE: 8 X
 SG_ NOT_A_SIGNAL : 0|8@1+ (1,0) [0|0] "" X
and of \"quotes\" and ends here";
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
VAL_ 1 A 0 "zero" 1 "one";
BO_ 3 N: 8 X
 SG_ B : 0|8@1+ (1,0) [0|0] "" X
)");
  EXPECT_THAT(database.problems, IsEmpty());
  ASSERT_THAT(database.messages, SizeIs(2));
  EXPECT_EQ(database.messages[1].name, "N");
}

TEST(Dbc, AnUnclosedStringLosesOnlyItsOwnLine) {
  const Database database = parse("CM_ \"open\nBO_ 3 N: 8 X\nCM_ \\\"\nCM_ \\\"\n");
  EXPECT_THAT(database.problems, testing::Contains(HasSubstr("t.dbc:13: string is not closed")));
  EXPECT_THAT(database.messages, SizeIs(1));
}

TEST(Dbc, EveryBadLineIsNamedAndTheRestIsRead) {
  const Database database = parse(R"( SG_ ORPHAN : 0|8@1+ (1,0) [0|0] "" X
BO_ 1 A: 8 X
 SG_ GOOD : 0|8@1+ (1,0) [0|0] "" X
 SG_ GOOD : 8|8@1+ (1,0) [0|0] "" X
 SG_ NO_COLON 0|8@1+ (1,0) [0|0] "" X
 SG_ BAD_ORDER : 0|8@2+ (1,0) [0|0] "" X
 SG_ BAD_FACTOR : 0|8@1+ (nan,0) [0|0] "" X
 SG_ ZERO : 0|8@1+ (0,0) [0|0] "" X
 SG_ OUTSIDE : 60|8@1+ (1,0) [0|0] "" X
 SG_ WIDE : 0|320@1+ (1,0) [0|0] "" X
 SG_ FAR : 65536|8@1+ (1,0) [0|0] "" X
 SG_ BAD_MUX m : 0|8@1+ (1,0) [0|0] "" X
 SG_ BAD_UNIT : 0|8@1+ (1,0) [0|0] "m X
BO_ 1 B: 8 X
 SG_ IN_NO_MESSAGE : 0|8@1+ (1,0) [0|0] "" X
BO_ 2 A: 8 X
BO_ 2048 C: 8 X
BO_ 3 D: 65 X
BO_ x E: 8 X
BO_ 2 F: 8 X
 SG_ ALSO_GOOD : 7|8@0+ (1,0) [0|0] "" X
BOO_ 4 G: 8 X
 SG_ NOT_OF_F : 15|8@0+ (1,0) [0|0] "" X
)");
  ASSERT_THAT(database.messages, SizeIs(2));
  EXPECT_THAT(names_of(database.messages[0]), ElementsAre("GOOD"));
  EXPECT_EQ(database.messages[1].name, "F");
  EXPECT_THAT(names_of(database.messages[1]), ElementsAre("ALSO_GOOD"));
  EXPECT_THAT(
      database.problems,
      ElementsAre(HasSubstr("t.dbc:13: signal without a message"), HasSubstr("t.dbc:16: signal name occurs twice"),
                  HasSubstr("t.dbc:17: SG_ must be"), HasSubstr("t.dbc:18: SG_ must be"),
                  HasSubstr("t.dbc:19: SG_ must be"), HasSubstr("t.dbc:20: factor"),
                  HasSubstr("t.dbc:21: signal reaches beyond"), HasSubstr("t.dbc:22: signal reaches beyond"),
                  HasSubstr("t.dbc:23: signal reaches beyond"), HasSubstr("t.dbc:24: SG_ must be"),
                  HasSubstr("t.dbc:25: SG_ must be"), HasSubstr("t.dbc:26: message id occurs twice"),
                  HasSubstr("t.dbc:28: message name occurs twice"), HasSubstr("t.dbc:29: message id is out of range"),
                  HasSubstr("t.dbc:30: message is too long"), HasSubstr("t.dbc:31: BO_ must be"),
                  HasSubstr("t.dbc:35: signal without a message")));
}

TEST(Dbc, SignalsOnNoBusAreNoProblem) {
  const Database database = parse(R"(BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX
 SG_ LOOSE : 0|8@1+ (1,0) [0|0] "" X
SIG_VALTYPE_ 3221225472 LOOSE : 1;
)");
  EXPECT_THAT(database.problems, IsEmpty());
  EXPECT_THAT(database.messages, IsEmpty());
}

TEST(Dbc, CarriageReturnsAndAByteOrderMark) {
  const Database database = parse_dbc(
      "\xEF\xBB\xBF"
      "BO_ 1 A: 8 X\r\n SG_ S : 0|8@1+ (1,0) [0|0] \"\xB0\" X\r\n\r\n",
      "t.dbc");
  EXPECT_THAT(database.problems, IsEmpty());
  EXPECT_THAT(names_of(database.messages.at(0)), ElementsAre("S"));
}

TEST(Dbc, ABigFileIsReadCompletely) {
  std::string text(kPreamble);
  for (int m = 0; m < 2000; ++m) {
    text += "BO_ " + std::to_string(m) + " MESSAGE_" + std::to_string(m) + ": 64 X\n";
    for (int s = 0; s < 32; ++s) {
      text += " SG_ SIGNAL_" + std::to_string(s) + " : " + std::to_string(s * 16) + "|16@1+ (1,0) [0|0] \"\" X\n";
    }
  }
  const Database database = parse_dbc(text, "big.dbc");
  EXPECT_THAT(database.problems, IsEmpty());
  ASSERT_THAT(database.messages, SizeIs(2000));
  EXPECT_TRUE(std::ranges::all_of(database.messages, [](const Message& m) { return m.signals.size() == 32; }));
}

// Each of these takes hours if a reader searches ahead from every line, and would exceed the test's time limit.
TEST(Dbc, HostileTextsAreReadInBoundedTime) {
  constexpr std::size_t kLines = 200'000;
  const auto repeated = [](std::string_view line) {
    std::string text = "BO_ 1 A: 8 X\n";
    for (std::size_t i = 0; i < kLines; ++i) text += line;
    return text + "\"";
  };
  for (const std::string_view line :
       {"X \\\"\n", "X \"\n", "X y\n", "SG_ A : 0|1@1+ (1,0) [0|0] \"\n", "BO_ 1 A: 8 X\n",
        " SG_ A m1M : 0|8@1+ (1,0) [0|0] \"\" X\n", "SG_MUL_VAL_ 1 A A 1-1,\n"}) {
    EXPECT_LE(parse_dbc(repeated(line), "big.dbc").problems.size(), kMaxProblems) << line;
  }
  const Database database = parse_dbc(repeated("BO_ 1 A: 8 X\n"), "t.dbc");
  EXPECT_THAT(database.problems, SizeIs(kMaxProblems));
  EXPECT_THAT(database.problems.back(), HasSubstr("further problems are not listed"));
}

}  // namespace
}  // namespace boresight::ingest::dbc
