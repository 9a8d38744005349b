#include "tests/benchmarks/bad_input/verdicts/verdicts.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace boresight::bench::bad_input {
namespace {

const Verdict kSound{0.0, true, "AVAILABLE NORMAL", "NORMAL"};

Verdict fault(double since_s, const std::string& reason) {
  return {since_s, false, "NOT_AVAILABLE " + reason, reason};
}
Verdict sound(double since_s) {
  Verdict v = kSound;
  v.since_s = since_s;
  return v;
}

constexpr Window kDamage{20.0, 35.0};

TEST(Verdicts, FirstRightReasonCountsNotTheFirstFault) {
  const Outcome o =
      outcome_of({kSound, fault(20.5, "NO_DATA"), fault(23.0, "RATE_REDUCED"), sound(40.0)}, kDamage, {"RATE_REDUCED"});
  EXPECT_DOUBLE_EQ(o.right_after_s, 3.0);
  EXPECT_EQ(o.returns, 0);
  EXPECT_TRUE(o.is_right_at_end);
  EXPECT_DOUBLE_EQ(o.clear_after_s, 5.0);
}

TEST(Verdicts, EachReturnToNoFaultDuringTheDamageCounts) {
  const Outcome o = outcome_of({kSound, fault(21.0, "BLOCKED"), sound(25.0), fault(26.0, "BLOCKED"), sound(30.0)},
                               kDamage, {"BLOCKED"});
  EXPECT_EQ(o.returns, 2);
  EXPECT_FALSE(o.is_right_at_end);
  EXPECT_DOUBLE_EQ(o.clear_after_s, 0.0);
}

TEST(Verdicts, FaultThatIsNeverReportedOrNeverClearedIsInfinite) {
  EXPECT_TRUE(std::isinf(outcome_of({kSound}, kDamage, {"BLOCKED"}).right_after_s));
  const Outcome o = outcome_of({kSound, fault(22.0, "BLOCKED")}, kDamage, {"BLOCKED"});
  EXPECT_TRUE(std::isinf(o.clear_after_s));
  EXPECT_EQ(o.at_end, "NOT_AVAILABLE BLOCKED");
}

TEST(Verdicts, FaultOfBeforeTheDamageIsNoAnswerToIt) {
  EXPECT_TRUE(std::isinf(outcome_of({kSound, fault(5.0, "BLOCKED"), sound(10.0)}, kDamage, {"BLOCKED"}).right_after_s));
}

TEST(Verdicts, DamagedFileIsAnErrorWithItsLine) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("verdicts_" + std::to_string(getpid()) + ".jsonl");
  std::ofstream(file) << R"({"t_s": 1.0, "radars": [{"radar": 3, "data_qualifier": "AVAILABLE_REDUCED",)"
                      << R"( "extended_qualifier": "INITIALISING"}]})"
                      << "\n";
  const History history = read_verdicts(file);
  ASSERT_EQ(history.at(3).size(), 1u);
  EXPECT_TRUE(history.at(3)[0].is_available) << "not tested yet is no fault";
  std::ofstream(file, std::ios::app) << "{\"t_s\": 2.0}\n";
  try {
    static_cast<void>(read_verdicts(file));
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(".jsonl:2: "));
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace boresight::bench::bad_input
