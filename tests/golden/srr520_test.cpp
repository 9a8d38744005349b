// One real cycle of an SRR520 on CAN FD. Each field is compared with the decoding by the open-source driver nebula. The
// speed is estimated from the stationary detections.
#include "services/ingest_gateway/codecs/srr520.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/common/recording/reader.hpp"
#include "tests/golden/support/decoded.hpp"
#include "tests/golden/support/yaml.hpp"
#include "tests/unit/ingest_gateway/memory_output.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;
namespace srr520_layout = wire::srr520;

const fs::path kSrr520 = shared_data() / "nebula_ars548_srr520";
const fs::path kSrr520Recording = kSrr520 / "srr520_real_canfd.log";

struct StoredFrame {
  std::uint32_t id;
  std::vector<std::uint8_t> bytes;
};

struct StoredScan {
  RadarScan scan;
  ingest::SensorStamp sensor;
};

/// Output that keeps every scan.
class Output : public ingest::MemoryOutput {
 public:
  void publish_scan(const ingest::FrameStamp& reception, const std::optional<ingest::SensorStamp>& sensor,
                    unsigned bits) override {
    MemoryOutput::publish_scan(reception, sensor, bits);
    stored.push_back({*scan, sensor.value()});
  }
  std::vector<StoredScan> stored;
};

/// The files have six significant digits.
bool close_to_reference(double ours, double theirs) {
  return std::abs(ours - theirs) <= 1e-5 * std::abs(theirs) + 2e-6;
}

class Srr520 : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING(kSrr520Recording);
    const auto reader =
        recording::open_recording(kSrr520Recording, [](const std::string& problem) { ADD_FAILURE() << problem; });
    for (recording::Frame frame; reader->next(frame);) {
      frames_.push_back({frame.can_id, {frame.payload.begin(), frame.payload.end()}});
    }
    ASSERT_EQ(frames_.size(), 97u);
  }
  void decode() {
    ingest::Srr520 decoder;
    for (const StoredFrame& stored : frames_) {
      recording::Frame frame = ingest::can_frame(stored.id, stored.bytes);
      frame.kind = recording::FrameKind::kCanFd;
      decoder.take(frame, {1'000'000'000, 0, TimeSource::kLinkArrival}, output_);
    }
  }
  void expect_like(const StoredScan& stored, const char* file) {
    Record head;
    const auto expected = read_yaml_list(kSrr520 / "srr520" / file, head);
    const RadarScan& scan = stored.scan;
    ASSERT_EQ(scan.number_of_valid_detections, expected.size());
    EXPECT_EQ(stored.sensor.time_ns, static_cast<std::int64_t>(head.at("sec")) * 1'000'000'000 +
                                         static_cast<std::int64_t>(head.at("nanosec")));
    EXPECT_EQ(stored.sensor.synchronised, head.at("global_time_stamp_sync_status") == 1.0);
    EXPECT_EQ(scan.cycle_counter, head.at("cycle_counter"));
    EXPECT_TRUE(close_to_reference(2.0 * scan.range_rate_max_mps, head.at("v_ambiguous")));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Record& row = expected[i];
      EXPECT_TRUE(close_to_reference(scan.range_m[i], row.at("range"))) << i;
      EXPECT_TRUE(close_to_reference(scan.azimuth_rad[i], row.at("azimuth_angle"))) << i;
      EXPECT_TRUE(close_to_reference(scan.range_rate_mps[i], row.at("range_rate"))) << i;
      EXPECT_TRUE(close_to_reference(scan.rcs_dbsm[i], row.at("rcs"))) << i;
      EXPECT_TRUE(close_to_reference(scan.snr_db[i], row.at("snr"))) << i;
      EXPECT_EQ(scan.detection_flags[i], 0u) << i;
    }
  }
  /// Header fields and hypotheses, which the scan omits, read from the frames of the list.
  void expect_rest_like(std::uint32_t header_id, const char* file) {
    Record head;
    const auto expected = read_yaml_list(kSrr520 / "srr520" / file, head);
    std::size_t at = 0;
    while (frames_[at].id != header_id) ++at;
    const auto& header = frames_[at].bytes;
    const auto number = [&](std::size_t offset, std::size_t size) {
      double value = 0.0;
      for (std::size_t i = 0; i < size; ++i) value = value * 256.0 + header[offset + i];
      return value;
    };
    EXPECT_EQ(number(srr520_layout::header::kSensorClock_us, 4), head.at("internal_time_stamp_usec"));
    EXPECT_EQ(number(srr520_layout::header::kSignalStatus, 1), head.at("signal_status"));
    EXPECT_EQ(number(srr520_layout::header::kSequenceCounter, 1), head.at("sequence_counter"));
    EXPECT_TRUE(close_to_reference(0.1 * number(srr520_layout::header::kMaxRange, 2), head.at("max_range")));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto& record = frames_[at + 1 + i / 10].bytes;
      const auto detection = ingest::decode_srr520_detection(
          std::span(record).subspan(i % 10 * srr520_layout::kDetectionBytes).first<srr520_layout::kDetectionBytes>());
      for (unsigned k = 0; k < 5; ++k) {
        EXPECT_EQ(100.0 * (detection.hypotheses >> k & 1u), expected[i].at("pdh0" + std::to_string(k))) << i;
      }
    }
  }

  std::vector<StoredFrame> frames_;
  Output output_;
};

TEST_F(Srr520, IsDecodedAsByNebulaFieldByField) {
  decode();
  EXPECT_EQ(output_.all_faults(), 0u) << output_.last_fault;
  ASSERT_EQ(output_.stored.size(), 2u);
  expect_like(output_.stored[0], "1708578209_45566935_near_detection.yaml");
  expect_like(output_.stored[1], "1708578209_76111685_hrr_detection.yaml");
  expect_rest_like(srr520_layout::kNearHeaderId, "1708578209_45566935_near_detection.yaml");
  expect_rest_like(srr520_layout::kHrrHeaderId, "1708578209_76111685_hrr_detection.yaml");
  EXPECT_EQ(output_.conditions, 0u) << "the CRC of the status frame is right too, and the frame reports no fault";
}

TEST_F(Srr520, HeaderGivesTheEgoMotion) {
  decode();
  Record head;
  read_yaml_list(kSrr520 / "srr520/1708578208_992410284_object.yaml", head);
  ASSERT_EQ(output_.ego_readings, 1u);
  EXPECT_TRUE(close_to_reference(output_.last_ego.speed_mps.value(), head.at("ego_vx")));
  EXPECT_TRUE(close_to_reference(output_.last_ego.yaw_rate_radps.value(), head.at("ego_yaw_rate")));
}

TEST_F(Srr520, EachListIsCheckedByItsOwnCrc) {
  std::vector<std::vector<std::uint8_t>> closings;
  for (const StoredFrame& frame : frames_) {
    if (frame.id == srr520_layout::kClosingId) closings.push_back(frame.bytes);
  }
  const std::vector<std::vector<std::uint8_t>> expected{{0, 0xBD, 0xCD, 0}, {2, 0x26, 0xDC, 0}, {1, 0x30, 0x59, 0}};
  ASSERT_EQ(closings, expected);
  for (StoredFrame& frame : frames_) {
    const bool record = frame.bytes.size() == srr520_layout::kRecordFrameBytes && frame.id != srr520_layout::kStatusId;
    if (record && frame.bytes[srr520_layout::kFrameNumber] == 4) frame.bytes[5] ^= 0x10;
  }
  decode();
  EXPECT_EQ(output_.scans, 0u);
  EXPECT_EQ(output_.ego_readings, 0u);
  EXPECT_EQ(output_.count(Fault::kWireValue), 3u);
}

TEST_F(Srr520, StationaryDetectionsGiveTheSpeed) {
  decode();
  ASSERT_EQ(output_.stored.size(), 2u);
  for (const StoredScan& stored : output_.stored) {
    // ṙ = −u·v for stationary detections: v by iteratively trimmed least squares over all directions u.
    const RadarScan& scan = stored.scan;
    Eigen::Vector2d velocity(6.0, 0.0);
    std::size_t inliers = 0;
    for (double gate = 4.0; gate > 0.29; gate *= 0.8) {
      Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
      Eigen::Vector2d right = Eigen::Vector2d::Zero();
      inliers = 0;
      for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
        const Eigen::Vector2d u(std::cos(scan.azimuth_rad[i]), std::sin(scan.azimuth_rad[i]));
        if (std::abs(scan.range_rate_mps[i] + u.dot(velocity)) > gate) continue;
        normal += u * u.transpose();
        right -= scan.range_rate_mps[i] * u;
        ++inliers;
      }
      velocity = normal.ldlt().solve(right);
    }
    std::printf("%zu of %u inliers, speed %.3f m/s, signalled %.3f m/s\n", inliers, scan.number_of_valid_detections,
                velocity.norm(), output_.last_ego.speed_mps.value());
    EXPECT_GT(inliers, scan.number_of_valid_detections * 3 / 4);
    EXPECT_NEAR(velocity.norm(), output_.last_ego.speed_mps.value(), 0.1);
  }
}

}  // namespace
}  // namespace boresight::golden
