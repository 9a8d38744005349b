// One real scan of an ARS548. Each field is compared with the decoding by the open-source driver nebula. The sensor's
// motion is estimated from the stationary detections.
#include "interfaces/wire/ars548.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/recording/reader.hpp"
#include "services/common/someip/big_endian.hpp"
#include "services/ingest_gateway/codecs/ars548.hpp"
#include "tests/golden/support/decoded.hpp"
#include "tests/golden/support/yaml.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;

const fs::path kArs548 = shared_data() / "nebula_ars548_srr520";
const fs::path kArs548Recording = kArs548 / "ars548_real_2msgs_ipfrag.pcap";
const fs::path kExpectedDetections = kArs548 / "ars548/1708578204_202447652_detection.yaml";

/// The file has six significant digits.
bool close(double ours, double theirs) {
  return std::abs(ours - theirs) <= 1e-5 * std::abs(theirs) + 1e-9;
}

class Ars548 : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING(kArs548Recording);
    decoding_ = decode(vehicle("ars548_single"), kArs548Recording);
    for (const Decoded& message : decoding_.messages) {
      if (message.scan) scan_ = message.scan.get();
    }
    ASSERT_NE(scan_, nullptr);
  }
  Decoding decoding_;
  const RadarScan* scan_ = nullptr;
};

TEST_F(Ars548, IsDecodedAsByNebulaFieldByField) {
  // The packets were captured again years after the sensor's stamps, which are marked as synchronised.
  EXPECT_THAT(decoding_.faults, testing::ElementsAre(testing::HasSubstr("synchronised")));
  Record head;
  const auto expected = read_yaml_list(kExpectedDetections, head);
  ASSERT_EQ(expected.size(), 308u);
  ASSERT_EQ(scan_->number_of_valid_detections, 308u);
  EXPECT_EQ(scan_->dropped_detections, 0u);
  EXPECT_TRUE(scan_->has(scan_field::kElevation | scan_field::kRcs | scan_field::kStds | scan_field::kAmbiguity));
  EXPECT_TRUE(close(scan_->range_rate_min_mps, head.at("ambiguity_free_velocity_min")));
  EXPECT_TRUE(close(scan_->range_rate_max_mps, head.at("ambiguity_free_velocity_max")));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& row = expected[i];
    EXPECT_TRUE(close(scan_->azimuth_rad[i], row.at("azimuth_angle"))) << i;
    EXPECT_TRUE(close(scan_->azimuth_std_rad[i], row.at("azimuth_angle_std"))) << i;
    EXPECT_TRUE(close(scan_->elevation_rad[i], row.at("elevation_angle"))) << i;
    EXPECT_TRUE(close(scan_->elevation_std_rad[i], row.at("elevation_angle_std"))) << i;
    EXPECT_TRUE(close(scan_->range_m[i], row.at("range"))) << i;
    EXPECT_TRUE(close(scan_->range_std_m[i], row.at("range_std"))) << i;
    EXPECT_TRUE(close(scan_->range_rate_mps[i], row.at("range_rate"))) << i;
    EXPECT_TRUE(close(scan_->range_rate_std_mps[i], row.at("range_rate_std"))) << i;
    EXPECT_TRUE(close(scan_->rcs_dbsm[i], row.at("rcs"))) << i;
    EXPECT_TRUE(close(scan_->existence_probability[i], 0.01 * row.at("raw_positive_predictive_value"))) << i;
    const double invalid = row.at("invalid_distance") + row.at("invalid_azimuth") + row.at("invalid_elevation") +
                           row.at("invalid_range_rate");
    EXPECT_EQ((scan_->detection_flags[i] & detection_flag::kInvalid) != 0, invalid > 0.0) << i;
    const bool outside = row.at("range_rate") < head.at("ambiguity_free_velocity_min") ||
                         row.at("range_rate") > head.at("ambiguity_free_velocity_max");
    EXPECT_EQ((scan_->detection_flags[i] & detection_flag::kAmbiguous) != 0, outside) << i;
  }
}

TEST_F(Ars548, FieldsThatTheScanOmitsAreAtTheirDocumentedOffsets) {
  namespace layout = wire::ars548;
  using boresight::read_f32, boresight::read_u16;
  Record head;
  const auto expected = read_yaml_list(kExpectedDetections, head);
  const auto reader =
      recording::open_recording(kArs548Recording, [](const std::string& what) { ADD_FAILURE() << what; });
  recording::Frame frame;
  while (reader->next(frame) && frame.payload.size() != layout::kDetectionListBytes) {
  }
  ASSERT_EQ(frame.payload.size(), layout::kDetectionListBytes);
  const std::uint8_t* const list = frame.payload.data();
  const auto scan = std::make_unique<RadarScan>();
  const ingest::SensorStamp time = ingest::ars548::decode(frame.payload, *scan);
  // Bytes 38f7bd80 65d6d59b; the file has the time of reception, a quarter of a second later.
  EXPECT_EQ(time.time_ns, 1'708'578'203'955'760'000);
  EXPECT_EQ(list[layout::kSyncStatus], head.at("stamp_sync_status"));
  EXPECT_TRUE(time.synchronised);
  const auto origin = [list](std::size_t i) { return read_f32(list + layout::kOrigin + 4 * i); };
  EXPECT_TRUE(close(origin(0), head.at("x")) && close(origin(2), head.at("y")) && close(origin(4), head.at("z")));
  EXPECT_TRUE(close(origin(8), head.at("origin_pitch")) && close(origin(9), head.at("origin_pitch_std")));
  EXPECT_TRUE(close(origin(10), head.at("origin_yaw")) && close(origin(11), head.at("origin_yaw_std")));
  EXPECT_TRUE(close(read_f32(list + layout::kAzimuthCorrection_rad), head.at("alignment_azimuth_correction")));
  EXPECT_TRUE(close(read_f32(list + layout::kElevationCorrection_rad), head.at("alignment_elevation_correction")));
  EXPECT_EQ(list[layout::kAlignmentStatus], head.at("alignment_status"));
  constexpr std::pair<std::uint8_t, const char*> kInvalid[] = {
      {layout::invalid::kRange, "invalid_distance"},       {layout::invalid::kRangeStd, "invalid_distance_std"},
      {layout::invalid::kAzimuth, "invalid_azimuth"},      {layout::invalid::kAzimuthStd, "invalid_azimuth_std"},
      {layout::invalid::kElevation, "invalid_elevation"},  {layout::invalid::kElevationStd, "invalid_elevation_std"},
      {layout::invalid::kRangeRate, "invalid_range_rate"}, {layout::invalid::kRangeRateStd, "invalid_range_rate_std"}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    namespace r = layout::record;
    const Record& row = expected[i];
    const std::uint8_t* const record = list + layout::kDetections + i * layout::kDetectionBytes;
    EXPECT_EQ(read_u16(record + r::kMeasurementId), row.at("measurement_id")) << i;
    EXPECT_EQ(record[r::kClassification], row.at("classification")) << i;
    EXPECT_EQ(record[r::kMultiTargetProbability_percent], row.at("raw_multi_target_probability")) << i;
    EXPECT_EQ(read_u16(record + r::kObjectId), row.at("object_id")) << i;
    EXPECT_EQ(record[r::kAmbiguityFlag], row.at("raw_ambiguity_flag")) << i;
    for (const auto& [bit, name] : kInvalid) EXPECT_EQ((record[r::kInvalidFlags] & bit) != 0, row.at(name) == 1.0) << i;
  }
}

TEST_F(Ars548, StationaryDetectionsGiveMountingAndSpeed) {
  // ṙ = −u·v for stationary detections: v by iteratively trimmed least squares over all directions u.
  const std::size_t count = scan_->number_of_valid_detections;
  Eigen::Vector3d velocity(6.0, 0.0, 0.0);
  std::size_t inliers = 0;
  for (double gate = 2.0; gate > 0.29; gate *= 0.8) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    inliers = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (scan_->detection_flags[i] != 0) continue;
      const double a = scan_->azimuth_rad[i], e = scan_->elevation_rad[i];
      const Eigen::Vector3d u(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      const double residual = scan_->range_rate_mps[i] + u.dot(velocity);
      if (std::abs(residual) > gate) continue;
      normal += u * u.transpose();
      right -= scan_->range_rate_mps[i] * u;
      ++inliers;
    }
    velocity = normal.ldlt().solve(right);
  }
  const double yaw_deg = std::atan2(velocity.y(), velocity.x()) * kDegreesPerRadian;
  const double pitch_deg = std::atan2(velocity.z(), velocity.x()) * kDegreesPerRadian;
  std::printf("%zu of %zu inliers, speed %.3f m/s, yaw %+.2f deg, pitch %+.2f deg\n", inliers, count, velocity.norm(),
              yaw_deg, pitch_deg);
  EXPECT_NEAR(velocity.norm(), 6.18, 0.02);
  EXPECT_NEAR(yaw_deg, 0.64, 0.1);
  EXPECT_NEAR(pitch_deg, -1.8, 0.3);
}

}  // namespace
}  // namespace boresight::golden
