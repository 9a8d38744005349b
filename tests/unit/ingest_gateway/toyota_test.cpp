#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "services/ingest_gateway/codecs/toyota_ego.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"
#include "services/simulator/wire/toyota_encoder.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

namespace toyota_layout = wire::toyota;
using FrameBytes = std::array<std::uint8_t, 8>;

struct CanFrame {
  std::uint32_t id;
  FrameBytes bytes;
};

/// Puts a raw value into a Motorola signal, bit by bit: the inverse of the decoder, implemented differently.
void put(FrameBytes& bytes, unsigned start_bit, unsigned length, std::int64_t raw) {
  unsigned byte = start_bit / 8, bit = start_bit % 8;
  for (unsigned i = 0; i < length; ++i) {
    const bool one = (static_cast<std::uint64_t>(raw) >> (length - 1 - i) & 1u) != 0;
    bytes[byte] = static_cast<std::uint8_t>(one ? bytes[byte] | 1u << bit : bytes[byte] & ~(1u << bit));
    if (bit == 0) {
      ++byte;
      bit = 7;
    } else {
      --bit;
    }
  }
}

void seal(std::uint32_t id, FrameBytes& bytes) {
  unsigned sum = (id & 0xFF) + (id >> 8) + 8;
  for (std::size_t i = 0; i < 7; ++i) sum += bytes[i];
  bytes[7] = static_cast<std::uint8_t>(sum);
}

CanFrame track_a(std::uint32_t slot, unsigned counter, bool valid, double x = 0.0, double y_left = 0.0,
                 double rate = 0.0) {
  CanFrame f{toyota_layout::kTrackA + slot, {}};
  put(f.bytes, 7, 8, counter);
  put(f.bytes, 15, 15, std::lround(x / 0.01));
  put(f.bytes, 31, 11, std::lround(-y_left / 0.04));
  put(f.bytes, 47, 12, std::lround(rate / 0.025));
  put(f.bytes, 48, 1, valid ? 1 : 0);
  seal(f.id, f.bytes);
  return f;
}

CanFrame track_b(std::uint32_t slot, unsigned counter, unsigned score) {
  CanFrame f{toyota_layout::kTrackB + slot, {}};
  put(f.bytes, 7, 8, counter);
  put(f.bytes, 23, 8, score);
  seal(f.id, f.bytes);
  return f;
}

/// All 32 frames; slot 3 is an approaching track 40 m ahead and 2 m to the left.
std::vector<CanFrame> cycle(unsigned counter) {
  std::vector<CanFrame> frames;
  for (std::uint32_t slot = 0; slot < 16; ++slot) {
    frames.push_back(slot == 3 ? track_a(slot, counter, true, 40.0, 2.0, -5.5) : track_a(slot, counter, false, 300.0));
    frames.push_back(track_b(slot, counter, slot == 3 ? 80 : 0));
  }
  return frames;
}

class ToyotaRadarTest : public testing::Test {
 protected:
  void take(const CanFrame& frame, std::int64_t stamp_ns) {
    radar_.take(can_frame(frame.id, frame.bytes), {stamp_ns, 0, TimeSource::kLinkArrival}, out_);
  }
  ToyotaRadar radar_;
  MemoryOutput out_;
};

TEST_F(ToyotaRadarTest, DecodesATrackAndItsSigns) {
  std::int64_t t = 0;
  for (const CanFrame& f : cycle(7)) take(f, t += kMillisecond / 4);
  ASSERT_EQ(out_.scans, 1u);
  EXPECT_EQ(out_.last_reception.received_ns, kMillisecond / 4) << "the first frame's";
  EXPECT_EQ(out_.all_faults(), 0u);
  const RadarScan& scan = *out_.scan;
  EXPECT_EQ(scan.integrity, 0u);
  ASSERT_EQ(scan.number_of_valid_detections, 1u);
  EXPECT_NEAR(scan.range_m[0], std::hypot(40.0, 2.0), 1e-4);
  EXPECT_NEAR(scan.azimuth_rad[0], std::atan2(2.0, 40.0), 1e-6);
  EXPECT_NEAR(scan.range_rate_mps[0], -5.5, 1e-6);
  EXPECT_NEAR(scan.existence_probability[0], 0.8, 1e-6);
  EXPECT_EQ(scan.cycle_counter, 7u);
  EXPECT_EQ(out_.last_counter_bits, 8u);
  EXPECT_EQ(scan.fields, scan_field::kExistence);
}

TEST_F(ToyotaRadarTest, TheOrderOfFramesWithinACycleIsFree) {
  std::mt19937 random(1);
  for (unsigned round = 0; round < 500; ++round) {
    auto frames = cycle(round & 0xFFu);
    std::shuffle(frames.begin(), frames.end(), random);
    const std::int64_t begin = round * 50 * kMillisecond;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      take(frames[i], begin + static_cast<std::int64_t>(i) * kMillisecond / 3);
      ASSERT_EQ(out_.scans, round + (i + 1 < frames.size() ? 0 : 1));
    }
    ASSERT_EQ(out_.scan->number_of_valid_detections, 1u);
  }
  EXPECT_EQ(out_.all_faults(), 0u);
}

TEST_F(ToyotaRadarTest, AMissingFrameEndsWithTheNextCycle) {
  auto frames = cycle(1);
  frames.erase(frames.begin() + 10);
  for (std::size_t i = 0; i < frames.size(); ++i) take(frames[i], static_cast<std::int64_t>(i));
  EXPECT_EQ(out_.scans, 0u);
  // The next cycle begins with another frame than the missing one …
  take(cycle(2)[0], 50 * kMillisecond);
  ASSERT_EQ(out_.scans, 1u);
  EXPECT_EQ(out_.scan->integrity, scan_integrity::kIncomplete);
  EXPECT_EQ(out_.scan->number_of_valid_detections, 1u);
  EXPECT_EQ(out_.count(Fault::kWireLength), 1u);
  // … or with the same frame, which after the pause does not complete the previous cycle.
  for (const CanFrame& f : frames) take(f, 100 * kMillisecond);
  ASSERT_EQ(out_.scans, 2u) << "the cycle of one frame";
  take(cycle(2)[10], 150 * kMillisecond);
  EXPECT_EQ(out_.scans, 3u);
  EXPECT_EQ(out_.count(Fault::kWireLength), 3u);
}

TEST_F(ToyotaRadarTest, AnIncompleteCycleDoesNotWaitForTheNext) {
  auto frames = cycle(1);
  frames.erase(frames.begin() + 10);
  for (const CanFrame& f : frames) take(f, 100 * kMillisecond);
  radar_.tick(115 * kMillisecond, out_);
  EXPECT_EQ(out_.scans, 0u) << "its frame may still arrive";
  radar_.tick(125 * kMillisecond, out_);
  ASSERT_EQ(out_.scans, 1u);
  EXPECT_EQ(out_.scan->integrity, scan_integrity::kIncomplete);
  EXPECT_EQ(out_.last_reception.received_ns, 100 * kMillisecond);
  radar_.tick(200 * kMillisecond, out_);
  EXPECT_EQ(out_.scans, 1u) << "once";
}

TEST_F(ToyotaRadarTest, ARepeatedFrameBeginsTheNextCycle) {
  const auto frames = cycle(1);
  for (std::size_t i = 0; i < 20; ++i) take(frames[i], static_cast<std::int64_t>(i));
  EXPECT_EQ(out_.scans, 0u);
  // Without a pause, as on a bus that is late.
  for (std::size_t i = 6; i < 26; ++i) take(frames[i], 21);
  EXPECT_EQ(out_.scans, 1u);
  for (std::size_t i = 0; i < 6; ++i) take(frames[i], 22);
  for (std::size_t i = 26; i < 32; ++i) take(frames[i], 22);
  EXPECT_EQ(out_.scans, 2u) << "the repeated frame was the first of the next cycle";
  EXPECT_EQ(out_.scan->integrity, 0u);
  EXPECT_EQ(out_.last_reception.received_ns, 21);
}

TEST_F(ToyotaRadarTest, InvalidFramesAreRejectedWithAReason) {
  CanFrame frame = track_a(0, 1, true, 20.0);
  const FrameStamp stamp{0, 0, TimeSource::kLinkArrival};
  radar_.take(can_frame(0x123, frame.bytes), stamp, out_);
  EXPECT_EQ(out_.all_faults(), 0u);
  radar_.take(can_frame(frame.id, std::span(frame.bytes).first(7)), stamp, out_);
  EXPECT_EQ(out_.count(Fault::kWireLength), 1u);
  EXPECT_NE(out_.last_fault.find("8 bytes"), std::string::npos);
  frame.bytes[2] = static_cast<std::uint8_t>(frame.bytes[2] ^ 1);
  take(frame, 0);
  EXPECT_EQ(out_.count(Fault::kWireValue), 1u);
  EXPECT_NE(out_.last_fault.find("checksum"), std::string::npos);
}

/// Any payload of any length with the radar's ids is counted, without further effect.
TEST_F(ToyotaRadarTest, SurvivesMutations) {
  std::mt19937 random(5);
  for (int i = 0; i < 200'000; ++i) {
    CanFrame frame = cycle(static_cast<unsigned>(i))[random() % 32];
    for (unsigned flips = random() % 4; flips > 0; --flips)
      frame.bytes[random() % 8] ^= static_cast<std::uint8_t>(random());
    if (random() % 2 == 0) seal(frame.id, frame.bytes);
    radar_.take(can_frame(frame.id, std::span(frame.bytes).first(random() % 9)),
                {static_cast<std::int64_t>(random() % 1'000'000'000), 0, TimeSource::kLinkArrival}, out_);
    ASSERT_LE(out_.scan->number_of_valid_detections, 16u);
  }
  EXPECT_GT(out_.count(Fault::kWireLength), 100u);
  EXPECT_GT(out_.count(Fault::kWireValue), 100u);
  EXPECT_GT(out_.scans, 100u);
}

TEST(ToyotaEgo, AgreesWithTheIndependentEncoder) {
  const simulator::EgoSignals truth{.speed_mps = 13.37, .yaw_rate_radps = 0.21, .steering_angle_rad = -0.7};
  ToyotaEgo ego;
  MemoryOutput output;
  EgoReading all;
  for (const auto& frame : simulator::wire::encode_ego(truth)) {
    ego.take(can_frame(frame.id, frame.bytes), {5 * kMillisecond, 0, TimeSource::kLinkArrival}, output);
    EXPECT_EQ(output.last_reception.received_ns, 5 * kMillisecond);
    const EgoReading& one = output.last_ego;
    EXPECT_EQ(one.speed_mps.has_value() + one.yaw_rate_radps.has_value() + one.steering_angle_rad.has_value(), 1);
    EXPECT_FALSE(one.reverse.has_value());
    EXPECT_FALSE(one.speed_is_signed) << "the wheel speeds have no direction";
    if (one.speed_mps) all.speed_mps = one.speed_mps;
    if (one.yaw_rate_radps) all.yaw_rate_radps = one.yaw_rate_radps;
    if (one.steering_angle_rad) all.steering_angle_rad = one.steering_angle_rad;
  }
  EXPECT_EQ(output.ego_readings, 3u);
  EXPECT_EQ(output.all_faults(), 0u);
  EXPECT_NEAR(all.speed_mps.value(), truth.speed_mps, 0.5 * 0.01 / 3.6 + 1e-6);
  EXPECT_NEAR(all.yaw_rate_radps.value(), truth.yaw_rate_radps, 0.5 * 0.244 * M_PI / 180.0 + 1e-6);
  EXPECT_NEAR(all.steering_angle_rad.value(), truth.steering_angle_rad, 0.06 * M_PI / 180.0);
}

TEST(ToyotaEgo, InvalidFramesAreRejectedWithAReason) {
  ToyotaEgo ego;
  MemoryOutput output;
  auto frames = simulator::wire::encode_ego({.speed_mps = 10.0, .yaw_rate_radps = 0.1, .steering_angle_rad = 0.0});
  ego.take(can_frame(0x0B4, frames[0].bytes), {}, output);
  EXPECT_EQ(output.all_faults(), 0u) << "frames with other ids are no faults";
  for (const auto& frame : frames) {
    ego.take(can_frame(frame.id, std::span(frame.bytes).first(6)), {}, output);
    ego.take(can_frame(frame.id, {}), {}, output);
  }
  EXPECT_EQ(output.count(Fault::kWireLength), 6u);
  EXPECT_NE(output.last_fault.find("8 bytes"), std::string::npos);
  frames[0].bytes[1] = static_cast<std::uint8_t>(frames[0].bytes[1] ^ 4);
  ego.take(can_frame(frames[0].id, frames[0].bytes), {}, output);
  EXPECT_NE(output.last_fault.find("checksum"), std::string::npos);
  FrameBytes fast{};
  fast.fill(0xFF);
  ego.take(can_frame(toyota_layout::kWheelSpeedsId, fast), {}, output);
  EXPECT_NE(output.last_fault.find("252"), std::string::npos);
  EXPECT_EQ(output.count(Fault::kWireValue), 2u);
  EXPECT_EQ(output.ego_readings, 0u);
}

}  // namespace
}  // namespace boresight::ingest
