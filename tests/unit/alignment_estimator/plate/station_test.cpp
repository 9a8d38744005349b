// The dialogue with the station: every command in every state, time-outs, wrong plans, and the scans that count.
#include "services/alignment_estimator/core/plate/station.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/alignment/plate.hpp"

namespace boresight::alignment::plate {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kCycle = kSecond / 20;

RunPlan plan_of(std::size_t tilts = 11, std::size_t scans = 30) {
  RunPlan plan;
  plan.number_of_tilts = tilts;
  plan.scans_per_tilt = scans;
  const double middle = 0.5 * (static_cast<double>(tilts) - 1.0);
  for (std::size_t i = 0; i < std::min(tilts, kMaxTilts); ++i) {
    plan.tilts_rad[i] = (static_cast<double>(i) - middle) * kRadiansPerDegree;
  }
  return plan;
}

/// A station with its clock and a radar that sees the plate.
class Plate : public testing::Test {
 protected:
  void scan(double amplitude_db = 20.0, double azimuth_rad = 0.0) {
    time_ += kCycle;
    simulator::fill_plate_scan(amplitude_db, azimuth_rad, time_, *scan_);
    station_.add_scan(*scan_, time_);
  }
  Refusal start(const RunPlan& plan = plan_of()) { return station_.start(plan, time_); }
  Refusal measure() { return station_.measure(station_.progress(time_).tilt_rad, time_); }
  /// Brings a new station into a state.
  void bring_to(State state) {
    station_ = PlateStation(config_);
    if (state == State::kIdle) return;
    ASSERT_EQ(start(plan_of(5, 10)), Refusal::kNone);
    if (state == State::kPositioning) return;
    if (state == State::kFailed) {
      ASSERT_EQ(station_.abort(time_), Refusal::kNone);
      return;
    }
    while (true) {
      ASSERT_EQ(measure(), Refusal::kNone);
      if (state == State::kMeasuring) return;
      collect(0.3);
      ASSERT_EQ(station_.state(), State::kTiltDone);
      if (state == State::kTiltDone) return;
      ASSERT_EQ(station_.next(time_), Refusal::kNone);
      if (station_.state() == State::kFinished) return;
      ASSERT_EQ(station_.state(), State::kPositioning) << explain(station_.result().failure);
    }
  }
  /// Scans of a radar that looks up by `pitch_deg` until the tilt is done.
  void collect(double pitch_deg) {
    const double tilt = station_.progress(time_).tilt_rad;
    for (int i = 0; i < 200 && station_.state() == State::kMeasuring; ++i) {
      const double off = (tilt + pitch_deg * kRadiansPerDegree) / kRadiansPerDegree;
      scan(20.0 - 0.2 * off * off, -0.01);
    }
  }

  StationConfig config_;
  PlateStation station_{config_};
  std::int64_t time_ = 100 * kSecond;
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
};

TEST_F(Plate, a_run_from_start_to_result) {
  EXPECT_EQ(station_.progress(time_).instruction, Instruction::kStart);
  ASSERT_EQ(start(), Refusal::kNone);
  for (std::size_t i = 0; i < 11; ++i) {
    Progress progress = station_.progress(time_);
    EXPECT_EQ(progress.state, State::kPositioning);
    EXPECT_EQ(progress.instruction, Instruction::kMovePlate);
    EXPECT_EQ(progress.tilt_index, i);
    EXPECT_EQ(progress.number_of_tilts, 11u);
    EXPECT_NEAR(progress.tilt_rad, (static_cast<double>(i) - 5.0) * kRadiansPerDegree, 1e-12);
    ASSERT_EQ(measure(), Refusal::kNone);
    EXPECT_EQ(station_.progress(time_).instruction, Instruction::kWait);
    collect(1.3);
    progress = station_.progress(time_);
    EXPECT_EQ(progress.state, State::kTiltDone);
    EXPECT_EQ(progress.instruction, Instruction::kSendNext);
    EXPECT_EQ(progress.scans_collected, 30u);
    ASSERT_EQ(station_.next(time_), Refusal::kNone);
  }
  EXPECT_EQ(station_.state(), State::kFinished);
  EXPECT_EQ(station_.progress(time_).instruction, Instruction::kTakeResult);
  EXPECT_NEAR(station_.result().pitch_rad, 1.3 * kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(station_.result().yaw_rad, 0.01, 1e-6);
  EXPECT_NEAR(station_.result().maximum_db, 20.0, 1e-4);
}

/// Every command in every state: whether it is executed, and the state after it.
TEST_F(Plate, every_command_in_every_state) {
  using Command = std::function<Refusal()>;
  const std::vector<std::pair<std::string, Command>> commands{
      {"start", [&] { return start(plan_of(5, 10)); }},
      {"measure", [&] { return measure(); }},
      {"next", [&] { return station_.next(time_); }},
      {"repeat_tilt", [&] { return station_.repeat_tilt(time_); }},
      {"repeat_run", [&] { return station_.repeat_run(time_); }},
      {"abort", [&] { return station_.abort(time_); }},
  };
  constexpr State kIdle = State::kIdle, kPositioning = State::kPositioning, kMeasuring = State::kMeasuring,
                  kTiltDone = State::kTiltDone, kFinished = State::kFinished, kFailed = State::kFailed;
  const std::vector<std::pair<State, std::vector<State>>> after{
      // start, measure, next, repeat_tilt, repeat_run, abort; an unchanged state means refused, unless stated
      {kIdle, {kPositioning, kIdle, kIdle, kIdle, kIdle, kIdle}},
      {kPositioning, {kPositioning, kMeasuring, kPositioning, kPositioning, kPositioning, kFailed}},
      {kMeasuring, {kMeasuring, kMeasuring, kMeasuring, kPositioning, kPositioning, kFailed}},
      {kTiltDone, {kTiltDone, kTiltDone, kPositioning, kPositioning, kPositioning, kFailed}},
      {kFinished, {kPositioning, kFinished, kFinished, kFinished, kPositioning, kFinished}},
      {kFailed, {kPositioning, kFailed, kFailed, kFailed, kPositioning, kFailed}},
  };
  config_.settle_s = 0.0;
  for (const auto& [from, states] : after) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      SCOPED_TRACE(std::string(name_of(from)) + " " + commands[i].first);
      bring_to(from);
      ASSERT_EQ(station_.state(), from);
      const Progress before = station_.progress(time_);
      const Refusal refusal = commands[i].second();
      EXPECT_EQ(station_.state(), states[i]);
      const bool obeyed = from != states[i] || (from == kPositioning && commands[i].first == "repeat_run");
      if (obeyed) {
        EXPECT_EQ(refusal, Refusal::kNone);
      } else {
        EXPECT_EQ(refusal, from == kIdle && commands[i].first == "repeat_run" ? Refusal::kNoRun : Refusal::kWrongState);
        EXPECT_EQ(station_.progress(time_).tilt_index, before.tilt_index);
        EXPECT_EQ(station_.progress(time_).scans_collected, before.scans_collected);
        EXPECT_EQ(station_.progress(time_).failure, before.failure);
      }
    }
  }
}

TEST_F(Plate, refuses_impossible_plans_and_stays_idle) {
  EXPECT_EQ(start(plan_of(4)), Refusal::kTooFewTilts);
  EXPECT_EQ(start(plan_of(0)), Refusal::kTooFewTilts);
  EXPECT_EQ(start(plan_of(12)), Refusal::kTooManyTilts);
  EXPECT_EQ(start(plan_of(11, 9)), Refusal::kScansOutOfRange);
  EXPECT_EQ(start(plan_of(11, 51)), Refusal::kScansOutOfRange);
  RunPlan plan = plan_of();
  plan.tilts_rad[10] = 21.0 * kRadiansPerDegree;
  EXPECT_EQ(start(plan), Refusal::kTiltOutOfRange);
  plan.tilts_rad[10] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(start(plan), Refusal::kTiltOutOfRange);
  plan = plan_of();
  std::swap(plan.tilts_rad[2], plan.tilts_rad[3]);
  EXPECT_EQ(start(plan), Refusal::kTiltsNotMonotonic);
  plan = plan_of();
  plan.tilts_rad[6] = plan.tilts_rad[5];
  EXPECT_EQ(start(plan), Refusal::kTiltsNotMonotonic);
  EXPECT_EQ(station_.state(), State::kIdle);
  EXPECT_EQ(station_.repeat_run(time_), Refusal::kNoRun);
  plan = plan_of();
  std::reverse(plan.tilts_rad.begin(), plan.tilts_rad.end());
  EXPECT_EQ(start(plan), Refusal::kNone) << "decreasing tilts are permitted too";
}

TEST_F(Plate, a_plate_at_another_tilt_than_requested_is_not_measured) {
  ASSERT_EQ(start(), Refusal::kNone);
  EXPECT_EQ(station_.measure(-4.0 * kRadiansPerDegree, time_), Refusal::kWrongTilt);
  EXPECT_EQ(station_.measure(std::numeric_limits<double>::quiet_NaN(), time_), Refusal::kTiltOutOfRange);
  EXPECT_EQ(station_.state(), State::kPositioning);
  EXPECT_EQ(station_.measure(-4.8 * kRadiansPerDegree, time_), Refusal::kNone);
  EXPECT_NEAR(station_.progress(time_).tilt_rad, -4.8 * kRadiansPerDegree, 1e-12)
      << "the tilt measured by the station counts";
}

TEST_F(Plate, tilts_that_pass_one_another_within_the_tolerance_are_refused) {
  RunPlan plan = plan_of(5, 10);
  for (std::size_t i = 0; i < 5; ++i) plan.tilts_rad[i] = 0.1 * static_cast<double>(i) * kRadiansPerDegree;
  ASSERT_EQ(start(plan), Refusal::kNone);
  ASSERT_EQ(station_.measure(0.2 * kRadiansPerDegree, time_), Refusal::kNone);
  while (station_.state() == State::kMeasuring) scan();
  ASSERT_EQ(station_.next(time_), Refusal::kNone);
  EXPECT_EQ(station_.measure(0.1 * kRadiansPerDegree, time_), Refusal::kTiltsNotMonotonic);
  EXPECT_EQ(station_.measure(0.25 * kRadiansPerDegree, time_), Refusal::kNone);
}

TEST_F(Plate, every_waiting_state_times_out_with_its_reason) {
  const auto wait = [&](double seconds) {
    time_ += static_cast<std::int64_t>(seconds * 1e9);
    station_.tick(time_);
  };
  bring_to(State::kPositioning);
  wait(59.9);
  EXPECT_EQ(station_.state(), State::kPositioning);
  EXPECT_NEAR(station_.progress(time_).seconds_left, 0.1, 1e-6);
  wait(0.2);
  EXPECT_EQ(station_.state(), State::kFailed);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kPositioningTimeout);
  EXPECT_EQ(station_.progress(time_).instruction, Instruction::kRepeatRun);

  bring_to(State::kTiltDone);
  wait(60.1);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kDecisionTimeout);

  bring_to(State::kMeasuring);
  wait(3.1);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kNoPlateSeen);

  // A plate that is seen at intervals prevents the silence time-out, but not the time-out of the tilt.
  bring_to(State::kMeasuring);
  for (int i = 0; i < 20 && station_.state() == State::kMeasuring; ++i) {
    wait(2.9);
    if (i % 2 == 0) scan();
  }
  EXPECT_EQ(station_.progress(time_).failure, Failure::kNoPlateSeen);
  config_.silence_timeout_s = 1e9;
  bring_to(State::kMeasuring);
  wait(30.1);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kMeasuringTimeout);

  for (const State state : {State::kIdle, State::kFinished, State::kFailed}) {
    bring_to(state);
    wait(1e6);
    EXPECT_EQ(station_.state(), state) << "this state has no time-out";
    EXPECT_EQ(station_.progress(time_).seconds_left, 0.0);
  }
}

TEST_F(Plate, a_late_command_is_refused_because_the_run_failed) {
  bring_to(State::kTiltDone);
  time_ += 61 * kSecond;
  EXPECT_EQ(station_.next(time_), Refusal::kWrongState);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kDecisionTimeout);
  EXPECT_EQ(station_.repeat_run(time_), Refusal::kNone);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kNone);
}

TEST_F(Plate, a_clock_that_goes_back_does_not_stretch_a_time_out) {
  bring_to(State::kPositioning);
  time_ -= 50 * kSecond;
  station_.tick(time_);
  time_ += 61 * kSecond;
  station_.tick(time_);
  EXPECT_EQ(station_.state(), State::kFailed);
}

TEST_F(Plate, an_abort_is_reported_and_deletes_the_result) {
  config_.settle_s = 0.0;
  bring_to(State::kMeasuring);
  EXPECT_EQ(station_.abort(time_), Refusal::kNone);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kAborted);
  EXPECT_FALSE(station_.result().ok());
}

TEST_F(Plate, a_repeated_tilt_deletes_its_scans) {
  ASSERT_EQ(start(), Refusal::kNone);
  ASSERT_EQ(measure(), Refusal::kNone);
  for (int i = 0; i < 15; ++i) scan(3.0);
  EXPECT_GT(station_.progress(time_).scans_collected, 5u);
  ASSERT_EQ(station_.repeat_tilt(time_), Refusal::kNone);
  EXPECT_EQ(station_.progress(time_).scans_collected, 0u);
  EXPECT_NEAR(station_.progress(time_).tilt_rad, -5.0 * kRadiansPerDegree, 1e-12);
  for (int i = 0; i < 11; ++i) {
    ASSERT_EQ(measure(), Refusal::kNone);
    collect(-0.7);
    ASSERT_EQ(station_.next(time_), Refusal::kNone);
  }
  EXPECT_NEAR(station_.result().pitch_rad, -0.7 * kRadiansPerDegree, 1e-6);
}

TEST_F(Plate, only_new_scans_after_the_plate_settled_count) {
  ASSERT_EQ(start(), Refusal::kNone);
  scan();
  ASSERT_EQ(measure(), Refusal::kNone);
  for (int i = 0; i < 3; ++i) scan();  // 0.05, 0.10, 0.15 s
  EXPECT_EQ(station_.progress(time_).scans_collected, 0u);
  scan();
  EXPECT_EQ(station_.progress(time_).scans_collected, 1u);
  station_.add_scan(*scan_, time_ += kCycle);  // the same measurement again
  EXPECT_EQ(station_.progress(time_).scans_collected, 1u);
  for (const std::uint16_t bit : {scan_integrity::kRepeated, scan_integrity::kFrozen, scan_integrity::kStale}) {
    time_ += kCycle;
    simulator::fill_plate_scan(20.0, 0.0, time_, *scan_);
    scan_->integrity = bit;
    station_.add_scan(*scan_, time_);
  }
  EXPECT_EQ(station_.progress(time_).scans_collected, 1u);
  EXPECT_EQ(station_.progress(time_).scans_without_plate, 0u);
  scan(20.0, 0.3);  // 17° from straight ahead
  EXPECT_EQ(station_.progress(time_).scans_collected, 1u);
  EXPECT_EQ(station_.progress(time_).scans_without_plate, 1u);
}

TEST_F(Plate, a_run_without_a_maximum_failed_and_can_be_repeated) {
  ASSERT_EQ(start(plan_of(11, 10)), Refusal::kNone);
  for (int i = 0; i < 11; ++i) {
    ASSERT_EQ(measure(), Refusal::kNone);
    const double tilt = station_.progress(time_).tilt_rad / kRadiansPerDegree;
    while (station_.state() == State::kMeasuring) scan(10.0 + 0.2 * tilt * tilt);
    ASSERT_EQ(station_.next(time_), Refusal::kNone);
  }
  EXPECT_EQ(station_.state(), State::kFailed);
  EXPECT_EQ(station_.progress(time_).failure, Failure::kNoMaximum);
  EXPECT_EQ(station_.result().number_of_tilts, 11u) << "the measurements can be read";
  ASSERT_EQ(station_.repeat_run(time_), Refusal::kNone);
  EXPECT_EQ(station_.progress(time_).number_of_tilts, 11u);
  EXPECT_EQ(station_.result().number_of_tilts, 0u);
}

TEST(FindPlate, takes_the_strongest_stationary_detection_in_the_window) {
  const auto scan = std::make_unique<RadarScan>();
  *scan = {};
  scan->fields = scan_field::kRcs | scan_field::kSnr;
  struct Row {
    float range, azimuth, rate, rcs, snr;
    std::uint16_t flags;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Row> rows{
      {4.0F, 0.01F, 0.0F, 12.0F, 30.0F, 0},                        // the plate
      {4.2F, -0.02F, 0.0F, 8.0F, 35.0F, 0},                        // weaker by RCS, stronger by SNR
      {0.5F, 0.0F, 0.0F, 40.0F, 60.0F, 0},                         // too near
      {20.0F, 0.0F, 0.0F, 40.0F, 60.0F, 0},                        // too far
      {4.0F, 0.2F, 0.0F, 40.0F, 60.0F, 0},                         // outside the azimuth window
      {4.0F, 0.0F, 1.0F, 40.0F, 60.0F, 0},                         // a moving pedestrian
      {4.0F, 0.0F, 0.0F, 40.0F, 60.0F, detection_flag::kInvalid},  // invalid
      {kNan, 0.0F, 0.0F, 40.0F, 60.0F, 0},
      {4.0F, kNan, 0.0F, 40.0F, 60.0F, 0},
      {4.0F, 0.0F, kNan, 40.0F, 60.0F, 0},
      {4.0F, 0.0F, 0.0F, kNan, kNan, 0},
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    scan->range_m[i] = rows[i].range;
    scan->azimuth_rad[i] = rows[i].azimuth;
    scan->range_rate_mps[i] = rows[i].rate;
    scan->rcs_dbsm[i] = rows[i].rcs;
    scan->snr_db[i] = rows[i].snr;
    scan->detection_flags[i] = rows[i].flags;
  }
  scan->number_of_valid_detections = static_cast<std::uint32_t>(rows.size());
  PlateWindow window;
  PlateEcho echo = find_plate(*scan, window);
  ASSERT_TRUE(echo.seen);
  EXPECT_FLOAT_EQ(static_cast<float>(echo.amplitude_db), 12.0F);
  EXPECT_FLOAT_EQ(static_cast<float>(echo.azimuth_rad), 0.01F);
  window.amplitude = Amplitude::kSnr;
  EXPECT_FLOAT_EQ(static_cast<float>(find_plate(*scan, window).amplitude_db), 35.0F);
  scan->fields = scan_field::kSnr;
  window.amplitude = Amplitude::kAny;
  EXPECT_FLOAT_EQ(static_cast<float>(find_plate(*scan, window).amplitude_db), 35.0F) << "SNR without RCS";
  window.amplitude = Amplitude::kRcs;
  EXPECT_FALSE(find_plate(*scan, window).seen);
  scan->fields = 0;
  window.amplitude = Amplitude::kAny;
  EXPECT_FALSE(find_plate(*scan, window).seen);
  scan->fields = scan_field::kRcs;
  scan->number_of_valid_detections = 0;
  EXPECT_FALSE(find_plate(*scan, window).seen);
}

TEST_F(Plate, a_whole_run_allocates_nothing) {
  const runtime::CountAllocations count;
  const std::uint64_t before = runtime::counted_allocations();
  Refusal refused = start(plan_of(11, 10));
  for (int i = 0; i < 11 && refused == Refusal::kNone; ++i) {
    refused = measure();
    collect(0.5);
    if (refused == Refusal::kNone) refused = station_.next(time_);
  }
  const std::uint64_t after = runtime::counted_allocations();
  EXPECT_EQ(refused, Refusal::kNone);
  EXPECT_EQ(station_.state(), State::kFinished);
  EXPECT_EQ(after, before);
}

TEST(PlateNames, are_all_different) {
  EXPECT_EQ(name_of(State::kFailed), "FAILED");
  EXPECT_EQ(name_of(Instruction::kRepeatRun), "REPEAT_RUN");
  EXPECT_EQ(name_of(Refusal::kNoRun), "NO_RUN");
  std::vector<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(Refusal::kNoRun); ++i) names.push_back(name_of(static_cast<Refusal>(i)));
  for (int i = 0; i <= static_cast<int>(State::kFailed); ++i) names.push_back(name_of(static_cast<State>(i)));
  for (int i = 0; i <= static_cast<int>(Instruction::kRepeatRun); ++i) {
    names.push_back(name_of(static_cast<Instruction>(i)));
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace boresight::alignment::plate
