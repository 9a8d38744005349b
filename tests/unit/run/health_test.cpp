// Health's judgement on the recording's clock.
#include <gmock/gmock.h>

#include "services/boresight/run/health_watch.hpp"
#include "tests/unit/run/drive_in_memory.hpp"

namespace boresight::run {
namespace {

constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kCycle_ns = 50'000'000;

class RunHealthWatch : public ::testing::Test {
 protected:
  struct Line {
    std::int64_t time_ns;
    ExtendedQualifier front_left, front_right;
    DataQualifier front_left_data;
  };

  RunHealthWatch() { watch_.start(kBegin_ns); }

  void advance(std::int64_t now_ns) {
    watch_.advance(now_ns, sources_, [this](const HealthResult& verdicts, std::int64_t time_ns) {
      lines_.push_back({time_ns, verdicts.sensors[0].extended_qualifier, verdicts.sensors[1].extended_qualifier,
                        verdicts.sensors[0].data_qualifier});
    });
  }
  /// Scans of a radar every 50 ms from one time to another.
  void scans(std::uint32_t radar, std::int64_t from_ns, std::int64_t to_ns) {
    const auto scan = std::make_unique<RadarScan>();
    scan->header.source_id = radar;
    for (std::int64_t now_ns = from_ns; now_ns < to_ns; now_ns += kCycle_ns) {
      advance(now_ns);
      scan->header.source_sequence = ++sequence_;
      watch_.observe(*scan);
    }
  }

  HealthWatch watch_{testing::demo_vehicle(), health::Config{}};
  std::array<SourceStatistics, kMaxRadars + 1> sources_{};
  std::uint64_t sequence_ = 0;
  std::vector<Line> lines_;
};

TEST_F(RunHealthWatch, ReportsOnceASecondAndAtOnceWhenAVerdictChanges) {
  scans(1, kBegin_ns, kBegin_ns + 5'000'000'000);
  ASSERT_GE(lines_.size(), 6u);
  EXPECT_EQ(lines_[0].time_ns, kBegin_ns);
  EXPECT_EQ(lines_[0].front_left, ExtendedQualifier::kInitialising);
  EXPECT_EQ(lines_[0].front_left_data, DataQualifier::kNotAvailable);
  const auto delivering = std::find_if(lines_.begin(), lines_.end(), [](const Line& l) {
    return l.front_left_data == DataQualifier::kAvailableReduced;
  });
  ASSERT_NE(delivering, lines_.end());
  EXPECT_EQ(delivering->front_left, ExtendedQualifier::kInitialising) << "its mounting was not verified";
  EXPECT_LT(delivering->time_ns - kBegin_ns, 1'200'000'000) << "at once after a second of delivery";
  bool was_silent = false;
  for (const Line& line : lines_) {
    if (line.front_right != ExtendedQualifier::kNoData || was_silent) continue;
    was_silent = true;
    EXPECT_NEAR(1e-9 * static_cast<double>(line.time_ns - kBegin_ns), 0.25, 0.03) << "the deadline of a silent radar";
  }
  EXPECT_TRUE(was_silent);
  for (std::size_t i = 1; i < lines_.size(); ++i) {
    EXPECT_LE(lines_[i].time_ns - lines_[i - 1].time_ns, 1'000'000'000);
  }
}

TEST_F(RunHealthWatch, NoticesARadarThatFallsSilentBetweenTwoInputs) {
  scans(1, kBegin_ns, kBegin_ns + 2'000'000'000);
  lines_.clear();
  advance(kBegin_ns + 4'000'000'000);
  const auto silent = std::find_if(lines_.begin(), lines_.end(),
                                   [](const Line& l) { return l.front_left == ExtendedQualifier::kNoData; });
  ASSERT_NE(silent, lines_.end());
  EXPECT_NEAR(1e-9 * static_cast<double>(silent->time_ns - kBegin_ns), 1.95 + 0.25, 0.03);
}

TEST_F(RunHealthWatch, EndsALongPauseAfterTenSeconds) {
  scans(1, kBegin_ns, kBegin_ns + 1'000'000'000);
  lines_.clear();
  advance(kBegin_ns + 3'600'000'000'000);
  EXPECT_LT(lines_.size(), 15u);
  EXPECT_EQ(lines_.back().time_ns, kBegin_ns + 3'600'000'000'000);
}

TEST_F(RunHealthWatch, GoesOnWhenTheClockIsSetBack) {
  scans(1, kBegin_ns, kBegin_ns + 2'000'000'000);
  lines_.clear();
  const std::int64_t earlier_ns = kBegin_ns - 100'000'000'000;
  scans(1, earlier_ns, earlier_ns + 3'000'000'000);
  ASSERT_GE(lines_.size(), 3u);
  EXPECT_EQ(lines_.back().front_left_data, DataQualifier::kAvailableReduced);
  EXPECT_LT(lines_.back().time_ns, earlier_ns + 3'000'000'001);
}

TEST_F(RunHealthWatch, JudgesTheCountsOfTheGateway) {
  sources_[1].source_id = 1;
  for (std::int64_t s = 0; s < 4; ++s) {
    sources_[1].messages += 20;
    sources_[1].suspect += 10;
    scans(1, kBegin_ns + s * 1'000'000'000, kBegin_ns + (s + 1) * 1'000'000'000);
  }
  EXPECT_EQ(lines_.back().front_left, ExtendedQualifier::kInvalidData);
}

}  // namespace
}  // namespace boresight::run
