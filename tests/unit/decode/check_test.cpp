#include "services/boresight/decode/check.hpp"

#include <memory>

#include <gmock/gmock.h>

namespace boresight::decode {
namespace {

using testing::HasSubstr;

class CheckTest : public testing::Test {
 protected:
  CheckTest() { check_.add_source(1, "front"); }
  void scan(std::int64_t time_ms, std::uint16_t integrity = 0) {
    scan_->integrity = integrity;
    scan_->number_of_valid_detections = 10;
    check_.take_scan(1, *scan_, {time_ms * 1'000'000, TimeSource::kLinkArrival});
  }
  void scans(int count, int from = 0) {
    for (int i = 0; i < count; ++i) scan(1000 + 50 * (from + i));
  }
  bool is_damaged() {
    bool damaged = false;
    report_ = check_.report(statistics_, counts_, damaged);
    return damaged;
  }
  Check check_;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  std::array<SourceStatistics, kMaxRadars + 1> statistics_{};
  recording::Counts counts_;
  std::string report_;
};

TEST_F(CheckTest, RegularScansAreSound) {
  scans(100);
  EXPECT_FALSE(is_damaged()) << report_;
  EXPECT_THAT(report_, HasSubstr("radar 1 front: SOUND, 100 scans, 1000 detections, 4.950 s"));
  EXPECT_THAT(report_, HasSubstr("ego: ABSENT"));
  EXPECT_THAT(report_, testing::EndsWith("\nSOUND\n"));
}

TEST_F(CheckTest, NothingAtAllIsDamaged) {
  EXPECT_TRUE(is_damaged());
  EXPECT_THAT(report_, HasSubstr("no message of any source"));
}

TEST_F(CheckTest, EachKindOfDamageIsFoundAndNamed) {
  const std::vector<std::pair<std::function<void()>, std::string>> damages = {
      {[this] { check_.take_fault(1, Fault::kWireValue, "CRC 17 is not 99"); }, "1 rejected: CRC # is not #"},
      {[this] { scans(10, 130); }, "1 gaps in time"},
      {[this] { scan(900); }, "1 measured before the previous one"},
      {[this] { scan(6000, scan_integrity::kFrozen), scans(1, 101); }, "1 scans: frozen"},
      {[this] { scan(6000, scan_integrity::kIncomplete), scans(1, 101); }, "1 scans: incomplete"},
      {[this] { statistics_[1].lost = 7; }, "7 scans lost"},
      {[this] { counts_.problems = 2; }, "2 unreadable"},
      {[this] { check_.take_fault(0, Fault::kWireUnknown, "unknown sender"); }, "1 rejected: unknown sender"}};
  for (const auto& [damage, name] : damages) {
    check_ = Check();
    check_.add_source(1, "front");
    statistics_ = {};
    counts_ = {};
    scans(100);
    ASSERT_FALSE(is_damaged());
    damage();
    EXPECT_TRUE(is_damaged()) << name;
    EXPECT_THAT(report_, HasSubstr(name));
    EXPECT_THAT(report_, HasSubstr("DAMAGED"));
  }
}

TEST_F(CheckTest, CyclesCutAtTheEndsAndRareDoubtsAreNoDamage) {
  scan(950, scan_integrity::kIncomplete);
  scans(200);
  scan(11'000, scan_integrity::kIncomplete);
  EXPECT_FALSE(is_damaged()) << report_;
  check_ = Check();
  scans(200);
  scan(11'000, scan_integrity::kImplausible);
  scan(11'050, scan_integrity::kContradictsEgo);
  EXPECT_FALSE(is_damaged()) << report_;
  for (int i = 0; i < 5; ++i) scan(11'100 + 50 * i, scan_integrity::kImplausible);
  EXPECT_TRUE(is_damaged());
}

TEST_F(CheckTest, AClockThatIsNotSynchronisedIsNotedOnly) {
  scans(100);
  check_.take_fault(1, Fault::kTimeJump, "the sensor's clock jumped by 5 s");
  EXPECT_FALSE(is_damaged());
  EXPECT_THAT(report_, HasSubstr("1 noted: the sensor's clock jumped by # s"));
}

TEST_F(CheckTest, ReasonsAreGroupedAndBounded) {
  for (int i = 0; i < 1000; ++i) {
    check_.take_fault(1, Fault::kWireValue, "ARS548: count " + std::to_string(i) + ".5 is beyond 800");
    check_.take_fault(1, Fault::kWireValue,
                      std::string("reason ") + static_cast<char>('A' + i % 26) + static_cast<char>('a' + i / 26));
  }
  EXPECT_TRUE(is_damaged());
  EXPECT_THAT(report_, HasSubstr("1000 rejected: ARS548: count # is beyond #\n"));
  EXPECT_THAT(report_, HasSubstr("rejected: other reasons"));
  EXPECT_LT(std::count(report_.begin(), report_.end(), '\n'), 45);
}

TEST(Intervals, MedianAndOutliersWithinAFewPerCent) {
  Intervals intervals;
  EXPECT_EQ(intervals.median_s(), 0.0);
  for (int i = 0; i < 100; ++i) intervals.add(50'000'000 + i * 10'000);
  intervals.add(-5);
  intervals.add(0);
  intervals.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_NEAR(intervals.median_s(), 0.0505, 0.003);
  EXPECT_EQ(intervals.longer_than(0.125), 1u);
  EXPECT_EQ(intervals.count(), 103u);
}

}  // namespace
}  // namespace boresight::decode
