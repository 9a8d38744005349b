// The object list that came with the real scan of an ARS548. Each field is compared with the decoding by the
// open-source driver nebula.
#include "services/ingest_gateway/codecs/ars548_objects.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "services/common/recording/reader.hpp"
#include "tests/golden/support/decoded.hpp"
#include "tests/golden/support/yaml.hpp"

namespace boresight::golden {
namespace {

const std::filesystem::path kArs548Objects = shared_data() / "nebula_ars548_srr520";
const std::filesystem::path kObjectsRecording = kArs548Objects / "ars548_real_2msgs_ipfrag.pcap";
const std::filesystem::path kExpectedObjects = kArs548Objects / "ars548/1708578204_199326753_object.yaml";

class Ars548Objects : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING(kObjectsRecording);
    const auto reader =
        recording::open_recording(kObjectsRecording, [](const std::string& what) { ADD_FAILURE() << what; });
    for (recording::Frame frame; reader->next(frame);) {
      std::string_view problem;
      if (ingest::ars548::check_objects(frame.payload, problem) != ingest::DecodeResult::kComplete) continue;
      ingest::ars548::decode_objects(frame.payload, *list_);
      ++lists_;
    }
    ASSERT_EQ(lists_, 1);
  }
  std::unique_ptr<ingest::ars548::ObjectList> list_ = std::make_unique<ingest::ars548::ObjectList>();
  int lists_ = 0;
};

TEST_F(Ars548Objects, AreDecodedAsByNebulaFieldByField) {
  Record head;
  const auto expected = read_yaml_list(kExpectedObjects, head);
  ASSERT_EQ(expected.size(), 50u);
  ASSERT_EQ(list_->number_of_objects, 50u);
  // The stamp is that of the detections of the same cycle; the file has the time of reception.
  EXPECT_EQ(list_->time.time_ns, 1'708'578'203'955'760'000);
  EXPECT_EQ(list_->time.synchronised, head.at("stamp_sync_status") == 1.0);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Record& row = expected[i];
    const ingest::ars548::Object& o = list_->objects[i];
    // The file has six significant digits.
    const auto expect = [&](double ours, const std::string& key, double factor = 1.0) {
      const double theirs = factor * row.at(key);
      EXPECT_NEAR(ours, theirs, 1e-5 * std::abs(theirs) + 1e-9) << i << ' ' << key;
    };
    const auto expect_vector = [&](const ingest::ars548::PlanarVector& v, const std::string& key) {
      expect(v.x, key + ".x");
      expect(v.y, key + ".y");
      expect(v.x_std, key + "_std.x");
      expect(v.y_std, key + "_std.y");
      expect(v.covariance_xy, key + "_covariance_xy");
      EXPECT_TRUE(v.valid) << i << ' ' << key;
    };
    EXPECT_TRUE(o.valid) << i;
    expect(o.id, "object_id");
    expect(o.age, "age");
    expect(o.measurement_status, "status_measurement");
    expect(o.movement_status, "status_movement");
    expect(o.position_reference, "position_reference");
    expect(o.x_m, "position.x");
    expect(o.y_m, "position.y");
    expect(o.z_m, "position.z");
    expect(o.x_std_m, "position_std.x");
    expect(o.y_std_m, "position_std.y");
    expect(o.z_std_m, "position_std.z");
    expect(o.covariance_xy_m2, "position_covariance_xy");
    expect(o.orientation_rad, "orientation");
    expect(o.orientation_std_rad, "orientation_std");
    expect(o.existence_probability, "raw_existence_probability", 0.01);
    constexpr std::array<const char*, ingest::ars548::kNumberOfObjectClasses> kClasses = {
        "car", "truck", "motorcycle", "bicycle", "pedestrian", "animal", "hazard", "unknown"};
    for (std::size_t c = 0; c < kClasses.size(); ++c) {
      expect(o.class_probability[c], std::string("raw_classification_") + kClasses[c], 0.01);
    }
    expect_vector(o.absolute_velocity_mps, "absolute_velocity");
    expect_vector(o.absolute_acceleration_mps2, "absolute_acceleration");
    // That version of nebula overwrites the relative velocity with the relative acceleration, whose own field is zero.
    expect_vector(o.relative_acceleration_mps2, "relative_velocity");
    expect(o.orientation_rate_radps, "orientation_rate_mean");
    expect(o.orientation_rate_std_radps, "orientation_rate_std");
    expect(o.length_m, "shape_length_edge_mean");
    expect(o.width_m, "shape_width_edge_mean");
  }
}

TEST_F(Ars548Objects, RelativeVelocityIsTheAbsoluteOneLessTheVehicles) {
  // No reference decoding exists, see above. The detections of the same cycle give 6.18 m/s.
  std::vector<double> ego_mps;
  for (std::size_t i = 0; i < list_->number_of_objects; ++i) {
    const ingest::ars548::Object& o = list_->objects[i];
    ASSERT_TRUE(o.relative_velocity_mps.valid);
    ego_mps.push_back(o.absolute_velocity_mps.x - o.relative_velocity_mps.x);
  }
  std::nth_element(ego_mps.begin(), ego_mps.begin() + 25, ego_mps.end());
  EXPECT_NEAR(ego_mps[25], 6.18, 0.6);
}

}  // namespace
}  // namespace boresight::golden
