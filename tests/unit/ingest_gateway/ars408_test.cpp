#include "services/ingest_gateway/codecs/ars408.hpp"

#include <algorithm>
#include <functional>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ingest_gateway/ars408_frames.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"
#include "tests/unit/ingest_gateway/put_signal.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

using testing::HasSubstr;
using namespace ars408_frames;

class Ars408Test : public testing::Test {
 protected:
  void take(const CanFrame& frame) {
    decoder_.take(can_frame(frame.id, frame.bytes), {now_ns_, 0, TimeSource::kLinkArrival}, output_);
    now_ns_ += 200'000;
  }
  void take(const Frames& frames) {
    for (const CanFrame& frame : frames) take(frame);
  }
  void pass(std::int64_t duration_ns) {
    now_ns_ += duration_ns;
    decoder_.tick(now_ns_, output_);
  }
  /// Decodes one target and returns the flags of its detection.
  std::uint16_t flags_of(const Target& target) {
    take(cluster_cycle({target}, true));
    return output_.scan->detection_flags[0];
  }

  Ars408 decoder_{0};
  MemoryOutput output_;
  std::int64_t now_ns_ = 5'000 * kMillisecond;
};

TEST_F(Ars408Test, AClusterIsADetectionInPolarCoordinates) {
  const std::int64_t begin_ns = now_ns_;
  const Target left;
  Target right = left;
  right.y_m = -20.1;
  right.vy_mps = 0.0;
  take(cluster_cycle({left, right}, true, 65535));
  ASSERT_EQ(output_.scans, 1u) << output_.last_fault;
  EXPECT_EQ(output_.all_faults(), 0u);
  const RadarScan& scan = *output_.scan;
  EXPECT_EQ(scan.number_of_valid_detections, 2u);
  EXPECT_EQ(scan.cycle_counter, 65535u);
  EXPECT_EQ(output_.last_counter_bits, 16u);
  EXPECT_EQ(scan.dropped_detections, 0u);
  EXPECT_EQ(scan.integrity, 0u);
  EXPECT_EQ(scan.fields, scan_field::kRcs | scan_field::kStds | scan_field::kExistence);
  EXPECT_EQ(scan.range_rate_min_mps, 0.0F);
  EXPECT_EQ(scan.range_rate_max_mps, 0.0F);
  EXPECT_NEAR(scan.range_m[0], std::sqrt(30.0 * 30.0 + 4.1 * 4.1), 1e-5);
  EXPECT_NEAR(scan.azimuth_rad[0], std::atan(4.1 / 30.0), 1e-6);
  EXPECT_NEAR(scan.range_rate_mps[0], (30.0 * -10.0 + 4.1 * 2.0) / scan.range_m[0], 1e-5);
  EXPECT_NEAR(scan.azimuth_rad[1], -std::atan(20.1 / 30.0), 1e-6);
  EXPECT_NEAR(scan.range_rate_mps[1], 30.0 * -10.0 / scan.range_m[1], 1e-5);
  EXPECT_EQ(scan.elevation_rad[1], 0.0F);
  EXPECT_EQ(scan.rcs_dbsm[1], 7.5F);
  EXPECT_EQ(scan.snr_db[1], 0.0F);
  EXPECT_EQ(scan.detection_flags[1], 0u);
  EXPECT_NEAR(scan.existence_probability[1], 0.875, 1e-6) << "false alarm below 25 %";
  EXPECT_EQ(output_.last_reception.received_ns, begin_ns);
  EXPECT_FALSE(output_.last_sensor);
}

TEST_F(Ars408Test, StdsFollowFromCodesAndRoundingByPropagation) {
  Target target;
  target.y_m = 15.3;
  take(cluster_cycle({target}, true));
  // Standard deviations of codes 10, 12, 8, 14; values are rounded to 0.2 m or 0.25 m/s.
  const double step = 1.0 / std::sqrt(12.0);
  const std::array<double, 4> stds{std::hypot(0.063, 0.2 * step), std::hypot(0.105, 0.2 * step),
                                   std::hypot(0.038, 0.25 * step), std::hypot(0.174, 0.25 * step)};
  const std::array<double, 4> state{target.x_m, target.y_m, target.vx_mps, target.vy_mps};
  using State = std::array<double, 4>;
  const auto std_of = [&](const std::function<double(const State&)>& quantity) {
    double variance = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      State more = state, less = state;
      more[i] += 1e-5;
      less[i] -= 1e-5;
      const double slope = (quantity(more) - quantity(less)) / 2e-5;
      variance += slope * slope * stds[i] * stds[i];
    }
    return std::sqrt(variance);
  };
  const RadarScan& scan = *output_.scan;
  EXPECT_NEAR(scan.range_std_m[0], std_of([](const State& p) { return std::hypot(p[0], p[1]); }), 1e-6);
  EXPECT_NEAR(scan.azimuth_std_rad[0], std_of([](const State& p) { return std::atan2(p[1], p[0]); }), 1e-7);
  EXPECT_NEAR(scan.range_rate_std_mps[0],
              std_of([](const State& p) { return (p[0] * p[2] + p[1] * p[3]) / std::hypot(p[0], p[1]); }), 1e-6);
  EXPECT_EQ(scan.elevation_std_rad[0], 0.0F);
}

TEST_F(Ars408Test, AStdThatIsNotStatedIsZero) {
  Target no_position, no_velocity;
  no_position.rms_y = 31;
  no_velocity.rms_vx = 31;
  take(cluster_cycle({no_position, no_velocity}, true));
  const RadarScan& scan = *output_.scan;
  EXPECT_EQ(scan.range_std_m[0], 0.0F);
  EXPECT_EQ(scan.azimuth_std_rad[0], 0.0F);
  EXPECT_EQ(scan.range_rate_std_mps[0], 0.0F);
  EXPECT_GT(scan.range_std_m[1], 0.0F);
  EXPECT_GT(scan.azimuth_std_rad[1], 0.0F);
  EXPECT_EQ(scan.range_rate_std_mps[1], 0.0F);
}

TEST_F(Ars408Test, TheAzimuthOfATargetAtTheSensorIsUnknown) {
  Target target;
  target.x_m = 0.0;
  target.y_m = 0.1;
  target.rms_x = target.rms_y = 30;
  take(cluster_cycle({target}, true));
  EXPECT_NEAR(output_.scan->range_m[0], 0.1, 1e-6);
  EXPECT_NEAR(output_.scan->azimuth_std_rad[0], M_PI / std::sqrt(3.0), 1e-6) << "uniform over the circle";
}

TEST_F(Ars408Test, QualityTellsWhetherAClusterIsBelieved) {
  for (unsigned state = 0; state < 32; ++state) {
    Target target;
    target.state = state;
    const bool invalid = state == 1 || state == 2 || state == 3 || state == 5 || state == 6 || state == 7 ||
                         state == 13 || state == 14 || state > 17;
    EXPECT_EQ(flags_of(target), invalid ? detection_flag::kInvalid : 0) << "invalid state " << state;
  }
  for (unsigned state = 0; state < 8; ++state) {
    Target target;
    target.ambiguity = state;
    const bool resolved = state == 2 || state == 3 || state == 4;
    EXPECT_EQ(flags_of(target), resolved ? 0 : detection_flag::kAmbiguous) << "ambiguity state " << state;
  }
  const std::array<double, 8> existence{1.0, 0.875, 0.625, 0.375, 0.175, 0.055, 0.0055, 0.0005};
  for (unsigned code = 0; code < 8; ++code) {
    Target target;
    target.probability = code;
    flags_of(target);
    EXPECT_NEAR(output_.scan->existence_probability[0], existence[code], 1e-6) << "false alarm code " << code;
  }
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Ars408Test, ObjectsAreDetectionsTooUnlessTheyAreOnlyPredicted) {
  for (unsigned state = 0; state < 8; ++state) {
    Target target;
    target.y_m = -204.6;  // beyond the range of a cluster
    target.probability = 5;
    target.state = state;
    take(object_status(1, 300 + state));
    take(general(layout::kObjectGeneralId, 200, target));
    take(quality(layout::kObjectQualityId, 200, target));
    take({layout::kObjectExtendedId, Bytes(8)});
    ASSERT_EQ(output_.scans, state + 1) << output_.last_fault;
    EXPECT_EQ(output_.scan->cycle_counter, 300 + state);
    EXPECT_NEAR(output_.scan->range_m[0], std::hypot(30.0, 204.6), 1e-4);
    EXPECT_NEAR(output_.scan->existence_probability[0], 0.945, 1e-6);
    const bool measured = state == 1 || state == 2 || state == 5;
    EXPECT_EQ(output_.scan->detection_flags[0], measured ? 0 : detection_flag::kInvalid) << state;
  }
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Ars408Test, ACycleWithoutClustersIsAnEmptyScan) {
  take(cluster_status(0, 0));
  EXPECT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.scan->number_of_valid_detections, 0u);
  EXPECT_EQ(output_.scan->integrity, 0u);
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Ars408Test, NearAndFarClustersAreOneList) {
  take(cluster_status(2, 1));
  for (unsigned i = 0; i < 3; ++i) {
    EXPECT_EQ(output_.scans, 0u);
    take(general(layout::kClusterGeneralId, i, {}));
    take(quality(layout::kClusterQualityId, i, {}));
  }
  EXPECT_EQ(output_.scans, 1u) << "quality frames after each general frame, or all at the end";
  EXPECT_EQ(output_.scan->number_of_valid_detections, 3u);
}

TEST_F(Ars408Test, WhetherQualityIsSentIsLearnt) {
  const std::vector<Target> targets(4);
  // The first cycle waits for possible quality frames, the second does not.
  take(cluster_cycle(targets, false));
  EXPECT_EQ(output_.scans, 0u);
  pass(31 * kMillisecond);
  EXPECT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.scan->fields, scan_field::kRcs);
  EXPECT_EQ(output_.scan->existence_probability[3], 1.0F);
  EXPECT_EQ(output_.scan->range_std_m[3], 0.0F);
  take(cluster_cycle(targets, false));
  EXPECT_EQ(output_.scans, 2u);
  // Switched on: the first cycle with quality is already published, the next one waits.
  take(cluster_cycle(targets, true));
  EXPECT_EQ(output_.scans, 3u);
  EXPECT_FALSE(output_.scan->has(scan_field::kStds));
  take(cluster_cycle(targets, true));
  EXPECT_EQ(output_.scans, 4u);
  EXPECT_TRUE(output_.scan->has(scan_field::kStds));
  EXPECT_EQ(output_.all_faults(), 0u) << output_.last_fault;
  // Switched off: reported as a loss once.
  take(cluster_cycle(targets, false));
  pass(31 * kMillisecond);
  EXPECT_EQ(output_.last_fault,
            "ARS408 cluster cycle 17 is incomplete: 0 of 4 general and 4 of 4 quality frames are missing");
  take(cluster_cycle(targets, false));
  pass(31 * kMillisecond);
  take(cluster_cycle(targets, false));
  EXPECT_EQ(output_.scans, 7u);
  EXPECT_EQ(output_.all_faults(), 1u);
}

TEST_F(Ars408Test, ALostQualityFrameIsNotTakenForQualitySwitchedOff) {
  const std::vector<Target> one(1);
  take(cluster_cycle(one, true));
  take(cluster_cycle(one, false));
  take(cluster_cycle(one, true));
  EXPECT_EQ(output_.scans, 3u);
  EXPECT_EQ(output_.count(Fault::kWireLength), 1u);
  EXPECT_TRUE(output_.scan->has(scan_field::kStds));
}

TEST_F(Ars408Test, AnIncompleteCycleIsPublishedAsSuchAndSaysWhatIsMissing) {
  std::vector<Target> targets(5);
  targets[3].x_m = 77.0;
  take(cluster_cycle(targets, true));
  Frames frames = cluster_cycle(targets, true, 18);
  frames.erase(frames.begin() + 3);  // the third cluster
  frames.erase(frames.end() - 2);    // the quality of the fourth
  take(frames);
  EXPECT_EQ(output_.scans, 1u);
  pass(29 * kMillisecond);
  EXPECT_EQ(output_.scans, 1u);
  pass(2 * kMillisecond);
  ASSERT_EQ(output_.scans, 2u);
  EXPECT_EQ(output_.count(Fault::kWireLength), 1u);
  EXPECT_EQ(output_.last_fault,
            "ARS408 cluster cycle 18 is incomplete: 1 of 5 general and 1 of 5 quality frames are missing");
  EXPECT_EQ(output_.scan->integrity, scan_integrity::kIncomplete);
  EXPECT_EQ(output_.scan->number_of_valid_detections, 4u);
  EXPECT_NEAR(output_.scan->range_m[2], std::hypot(77.0, 4.1), 1e-4) << "in order of arrival";
  EXPECT_EQ(output_.scan->range_std_m[2], 0.0F) << "its quality is missing";
  EXPECT_GT(output_.scan->range_std_m[3], 0.0F);
  // The next status frame ends a cycle as well.
  frames = cluster_cycle(targets, true, 19);
  frames.pop_back();
  take(frames);
  take(cluster_cycle(targets, true, 20));
  EXPECT_EQ(output_.scans, 4u);
  EXPECT_EQ(output_.count(Fault::kWireLength), 2u);
  EXPECT_EQ(output_.scan->cycle_counter, 20u);
  EXPECT_EQ(output_.scan->integrity, 0u);
}

TEST_F(Ars408Test, ALateFrameDoesNotJoinACycleThatHasEnded) {
  Frames frames = cluster_cycle(std::vector<Target>(3), true);
  take(Frames(frames.begin(), frames.end() - 1));
  now_ns_ += 31 * kMillisecond;  // nobody called tick() meanwhile
  take(frames.back());
  EXPECT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.scan->integrity, scan_integrity::kIncomplete);
  EXPECT_EQ(output_.count(Fault::kWireLength), 1u);
  EXPECT_EQ(output_.count(Fault::kWireValue), 1u) << "the late frame";
}

TEST_F(Ars408Test, TheOrderWithinACycleDoesNotMatter) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    Frames frames = cluster_cycle(std::vector<Target>(20), true);
    std::shuffle(frames.begin() + 1, frames.end(), random);
    take(frames);
  }
  EXPECT_EQ(output_.scans, 50u);
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Ars408Test, RepeatedAndSurplusFramesAreReportedAndDoNoHarm) {
  Target other;
  other.x_m = 99.0;
  take(cluster_status(2, 0));
  take(general(layout::kClusterGeneralId, 7, {}));
  take(general(layout::kClusterGeneralId, 7, other));
  EXPECT_EQ(output_.last_fault, "ARS408 cluster 7 occurs twice in a cycle; the first one is used");
  take(general(layout::kClusterGeneralId, 8, {}));
  take(general(layout::kClusterGeneralId, 9, other));
  EXPECT_EQ(output_.last_fault, "ARS408 cluster 9 exceeds the 2 that the status frame announced");
  take(quality(layout::kClusterQualityId, 8, {}));
  take(quality(layout::kClusterQualityId, 8, {}));
  take(quality(layout::kClusterQualityId, 7, {}));
  ASSERT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.count(Fault::kWireValue), 3u);
  EXPECT_EQ(output_.scan->number_of_valid_detections, 2u);
  EXPECT_NEAR(output_.scan->range_m[0], std::hypot(30.0, 4.1), 1e-5);
  // Frames outside of a cycle: one fault for all of them.
  for (unsigned i = 0; i < 5; ++i) take(general(layout::kClusterGeneralId, i, {}));
  EXPECT_EQ(output_.count(Fault::kWireValue), 4u);
  EXPECT_EQ(output_.last_fault, "ARS408 cluster 0 outside of a cycle: status frame 600 is missing or announced fewer");
  take(cluster_cycle({Target{}}, true));
  EXPECT_EQ(output_.scans, 2u);
  EXPECT_EQ(output_.scan->number_of_valid_detections, 1u);
}

TEST_F(Ars408Test, WhatCannotBeIsRejectedWithTheReason) {
  take(cluster_status(255, 2));
  EXPECT_EQ(output_.last_fault, "ARS408 cluster status: number of near and far clusters 257, allowed 0 … 256");
  take(general(layout::kClusterGeneralId, 0, {}));
  EXPECT_EQ(output_.count(Fault::kWireValue), 1u) << "its clusters are dropped with it";
  EXPECT_EQ(output_.scans, 0u);
  const std::array<std::pair<std::uint32_t, std::size_t>, 7> lengths{
      {{0x201, 8}, {0x600, 5}, {0x701, 8}, {0x702, 5}, {0x60A, 4}, {0x60B, 8}, {0x60C, 7}}};
  for (const auto& [id, length] : lengths) {
    for (std::size_t size = 0; size <= 8; ++size) {
      const std::size_t before = output_.count(Fault::kWireLength);
      if (size == length) continue;
      take({id, Bytes(size)});
      EXPECT_EQ(output_.count(Fault::kWireLength), before + 1) << std::hex << id << " of " << size << " bytes";
      EXPECT_THAT(output_.last_fault, HasSubstr("must be " + std::to_string(length)));
    }
  }
  take({0x701, Bytes(64)});
  EXPECT_THAT(output_.last_fault, HasSubstr("ARS408 cluster general frame of 64 bytes, must be 8"));
}

TEST_F(Ars408Test, SeveralSensorsShareABus) {
  Ars408 second(3);
  MemoryOutput output_of_second;
  Target far;
  far.x_m = 111.0;
  const Frames of_first = cluster_cycle(std::vector<Target>(6), true);
  Frames of_second = cluster_cycle(std::vector<Target>(6, far), true);
  for (CanFrame& frame : of_second) frame.id += 3 * layout::kIdStep;
  for (std::size_t i = 0; i < of_first.size(); ++i) {
    for (const CanFrame* const frame : {&of_first[i], &std::as_const(of_second)[i]}) {
      const recording::Frame view = can_frame(frame->id, frame->bytes);
      decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
      second.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_of_second);
    }
  }
  EXPECT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_of_second.scans, 1u);
  EXPECT_NEAR(output_.scan->range_m[5], std::hypot(30.0, 4.1), 1e-5);
  EXPECT_NEAR(output_of_second.scan->range_m[5], std::hypot(111.0, 4.1), 1e-4);
  EXPECT_EQ(output_.all_faults() + output_of_second.all_faults(), 0u);
}

TEST_F(Ars408Test, WhatConcernsOthersIsIgnoredSilently) {
  take(general(layout::kClusterGeneralId, 0, {}));  // joined the bus in the middle of a cycle
  take(quality(layout::kClusterQualityId, 0, {}));
  const CanFrame status = cluster_status(0, 0);
  recording::Frame view = can_frame(status.id, status.bytes);
  view.can_extended = true;
  decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
  view.can_extended = false;
  view.can_remote = true;
  decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
  take({0x610, Bytes(5)});
  take({0x200, Bytes(8)});
  take({0x123, Bytes(1)});
  EXPECT_EQ(output_.scans, 0u);
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Ars408Test, TheStateFrameTellsTheSensorsCondition) {
  const auto conditions = [this](const wire::CanSignal& signal, std::uint64_t value) {
    CanFrame state{layout::kStateId, Bytes(8)};
    put_raw(state.bytes, signal, value);
    output_.conditions.reset();
    take(state);
    return output_.conditions.value_or(0xFFFF'FFFF);
  };
  EXPECT_EQ(conditions(layout::state::kMaxDistance_m, 125), 0u);
  EXPECT_EQ(conditions(layout::state::kPersistentError, 1), source_condition::kDefective);
  EXPECT_EQ(conditions(layout::state::kTemporaryError, 1), source_condition::kDefective);
  EXPECT_EQ(conditions(layout::state::kTemperatureError, 1), source_condition::kTemperature);
  EXPECT_EQ(conditions(layout::state::kVoltageError, 1), source_condition::kSupply);
  EXPECT_EQ(conditions(layout::state::kMotion, 2), source_condition::kWithoutEgoMotion);
}

TEST_F(Ars408Test, WithoutMemoryTheScanIsLostAndTheNextIsNot) {
  output_.refuse_memory = true;
  take(cluster_cycle(std::vector<Target>(3), true));
  EXPECT_EQ(output_.scans, 0u);
  output_.refuse_memory = false;
  take(cluster_cycle(std::vector<Target>(3), true));
  EXPECT_EQ(output_.scans, 1u);
}

TEST_F(Ars408Test, RandomFramesNeitherCrashNorLeadToNonsense) {
  std::mt19937 random(408);
  const std::array<std::pair<std::uint32_t, std::size_t>, 8> kinds{
      {{0x600, 5}, {0x701, 8}, {0x702, 5}, {0x60A, 4}, {0x60B, 8}, {0x60C, 7}, {0x60D, 8}, {0x201, 8}}};
  std::size_t checked = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto& [id, size] = kinds[random() % kinds.size()];
    CanFrame frame{id, Bytes(random() % 8 == 0 ? random() % 9 : size)};
    for (std::uint8_t& byte : frame.bytes) byte = static_cast<std::uint8_t>(random());
    if (frame.bytes.size() > 1 && (id == 0x600 || id == 0x60A)) frame.bytes[0] = frame.bytes[1] = random() % 4;
    take(frame);
    if (random() % 100 == 0) pass(31 * kMillisecond);
    if (output_.scans == checked) continue;
    checked = output_.scans;
    const RadarScan& scan = *output_.scan;
    ASSERT_LE(scan.number_of_valid_detections, 256u);
    for (std::uint32_t k = 0; k < scan.number_of_valid_detections; ++k) {
      ASSERT_TRUE(scan.range_m[k] >= 0.0F && scan.range_m[k] < 1200.0F && std::abs(scan.range_rate_mps[k]) <= 145.0F);
      ASSERT_TRUE(scan.existence_probability[k] >= 0.0F && scan.existence_probability[k] <= 1.0F);
      ASSERT_TRUE(std::isfinite(scan.azimuth_std_rad[k]) && std::isfinite(scan.range_rate_std_mps[k]));
    }
  }
  EXPECT_GT(checked, 1000u);
  // Earlier frames do not disturb good cycles: at the latest the second one is complete and without a fault.
  take(cluster_cycle(std::vector<Target>(9), true));
  const std::size_t faults = output_.all_faults();
  take(cluster_cycle(std::vector<Target>(9), true));
  EXPECT_EQ(output_.all_faults(), faults) << output_.last_fault;
  EXPECT_EQ(output_.scan->number_of_valid_detections, 9u);
  EXPECT_EQ(output_.scan->integrity, 0u);
}

}  // namespace
}  // namespace boresight::ingest
