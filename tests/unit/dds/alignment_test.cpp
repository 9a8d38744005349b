// An alignment estimate leaves the ECU whole.
#include "services/health/dds/alignment.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "generated/alignment_estimatePubSubTypes.h"
#include "tests/unit/dds/samples.hpp"

namespace boresight::dds {
namespace {

using EstimateType = diagnostics::AlignmentEstimatePubSubType;

VehicleConfig car() {
  VehicleConfig vehicle;
  vehicle.name = "test car";
  RadarConfig radar;
  radar.id = 2;
  radar.name = "front_right";
  vehicle.radars.push_back(radar);
  return vehicle;
}

AlignmentEstimate estimate() {
  auto e = samples::distinct<AlignmentEstimate>();
  e.header.source_id = 2;
  e.state = AlignmentState::kConverging;
  e.reason = AlignmentReason::kNotObservable;
  e.finding = AlignmentFinding::kOtherRadar;
  return e;
}

diagnostics::AlignmentEstimate estimate_sample(const AlignmentEstimate& e) {
  diagnostics::AlignmentEstimate sample;
  fill(sample, e, car(), 123);
  return sample;
}

samples::Bytes estimate_bytes(const AlignmentEstimate& e) {
  return samples::sent<EstimateType>(estimate_sample(e));
}

void expect_same(const diagnostics::EstimatedValue& got, const AlignmentValue& value) {
  EXPECT_EQ(got.value(), value.value);
  EXPECT_EQ(got.std(), value.std);
}

void expect_same(const diagnostics::VehicleChange& got, const AlignmentVehicleChange& change) {
  EXPECT_EQ(got.time_ns(), change.time_ns);
  EXPECT_EQ(got.size(), change.size);
  EXPECT_EQ(got.count(), change.count);
}

TEST(AlignmentByDds, HasStateAnglesAndCovariancesInTheirPlaces) {
  const AlignmentEstimate e = estimate();
  const auto got = samples::received<EstimateType>(estimate_sample(e));
  EXPECT_EQ(got.radar_id(), 2U);
  EXPECT_EQ(got.radar_name(), "front_right");
  EXPECT_EQ(got.vehicle_name(), "test car");
  EXPECT_EQ(got.time_ns(), 123);
  EXPECT_EQ(got.measurement_time_ns(), e.header.measurement_time_ns);
  EXPECT_EQ(got.layout_version(), e.header.version);
  EXPECT_EQ(got.sequence_number(), e.header.sequence);
  EXPECT_EQ(got.radar_sequence_number(), e.header.source_sequence);
  EXPECT_EQ(got.state(), diagnostics::ALIGNMENT_CONVERGING);
  EXPECT_EQ(got.reason(), diagnostics::REASON_NOT_OBSERVABLE);
  EXPECT_EQ(got.finding(), diagnostics::FINDING_OTHER_RADAR);
  EXPECT_EQ(got.finding_value(), e.finding_value);
  EXPECT_EQ(got.finding_radar(), e.finding_radar);
  EXPECT_EQ(got.observable(), e.observable);
  EXPECT_EQ(got.speed_scale(), e.speed_scale);
  EXPECT_EQ(got.alignment_yaw_rad(), e.alignment_yaw_rad);
  EXPECT_EQ(got.alignment_pitch_rad(), e.alignment_pitch_rad);
  EXPECT_EQ(got.alignment_roll_rad(), e.alignment_roll_rad);
  EXPECT_EQ(got.vehicle_yaw_rad(), e.vehicle_yaw_rad);
  EXPECT_EQ(got.vehicle_pitch_rad(), e.vehicle_pitch_rad);
  EXPECT_EQ(got.vehicle_roll_rad(), e.vehicle_roll_rad);
  EXPECT_EQ(got.yaw_rate_bias_radps(), e.yaw_rate_bias_radps);
  EXPECT_EQ(got.yaw_rate_bias_std_radps(), e.yaw_rate_bias_std_radps);
  EXPECT_EQ(got.slip_coefficient_radps2pm(), e.slip_coefficient_radps2pm);
  EXPECT_EQ(got.slip_coefficient_std_radps2pm(), e.slip_coefficient_std_radps2pm);
  EXPECT_EQ(got.angle_noise_scale(), e.angle_noise_scale);
  EXPECT_EQ(got.covariance(), e.covariance);
  EXPECT_EQ(got.vehicle_covariance(), e.vehicle_covariance);
}

TEST(AlignmentByDds, HasChangesNuisanceParametersAndKeyFiguresInTheirPlaces) {
  const AlignmentEstimate e = estimate();
  const auto got = samples::received<EstimateType>(estimate_sample(e));
  EXPECT_EQ(got.step_change().time_ns(), e.step_change.time_ns);
  EXPECT_EQ(got.step_change().rotation_vehicle_rad(), e.step_change.rotation_vehicle_rad);
  EXPECT_EQ(got.step_change().count(), e.step_change.count);
  expect_same(got.load_change(), e.load_change);
  expect_same(got.speed_change(), e.speed_change);
  EXPECT_EQ(got.drift().since_ns(), e.drift.since_ns);
  EXPECT_EQ(got.drift().yaw_radps(), e.drift.yaw_radps);
  EXPECT_EQ(got.drift().yaw_std_radps(), e.drift.yaw_std_radps);
  EXPECT_EQ(got.drift().pitch_radps(), e.drift.pitch_radps);
  EXPECT_EQ(got.drift().pitch_std_radps(), e.drift.pitch_std_radps);
  const diagnostics::NuisanceParameters& n = got.nuisance();
  expect_same(n.range_rate_scale(), e.nuisance.range_rate_scale);
  expect_same(n.time_offset_s(), e.nuisance.time_offset_s);
  expect_same(n.position_x_m(), e.nuisance.position_x_m);
  expect_same(n.position_y_m(), e.nuisance.position_y_m);
  expect_same(n.yaw_rate_gain(), e.nuisance.yaw_rate_gain);
  expect_same(n.pitch_per_acceleration_radps2pm(), e.nuisance.pitch_per_acceleration_radps2pm);
  expect_same(n.load_pitch_rad(), e.nuisance.load_pitch_rad);
  EXPECT_EQ(n.yaw_scatter_rad(), e.nuisance.yaw_scatter_rad);
  EXPECT_EQ(n.pitch_scatter_rad(), e.nuisance.pitch_scatter_rad);
  EXPECT_EQ(n.azimuth_curve_rad(), e.nuisance.azimuth_curve_rad);
  EXPECT_EQ(n.azimuth_curve_std_rad(), e.nuisance.azimuth_curve_std_rad);
  EXPECT_EQ(n.azimuth_curve_first_rad(), e.nuisance.azimuth_curve_first_rad);
  EXPECT_EQ(n.azimuth_curve_step_rad(), e.nuisance.azimuth_curve_step_rad);
  EXPECT_EQ(n.observable(), e.nuisance.observable);
  EXPECT_EQ(n.range_rate_noise_scale(), e.nuisance.range_rate_noise_scale);
  const diagnostics::AlignmentKpis& k = got.kpis();
  EXPECT_EQ(k.residual_rmse_mps(), e.kpis.residual_rmse_mps);
  EXPECT_EQ(k.uncorrected_residual_rmse_mps(), e.kpis.uncorrected_residual_rmse_mps);
  EXPECT_EQ(k.residual_skewness(), e.kpis.residual_skewness);
  EXPECT_EQ(k.residual_kurtosis(), e.kpis.residual_kurtosis);
  EXPECT_EQ(k.inlier_ratio(), e.kpis.inlier_ratio);
  EXPECT_EQ(k.seconds_of_drive(), e.kpis.seconds_of_drive);
  EXPECT_EQ(k.seconds_to_95_percent(), e.kpis.seconds_to_95_percent);
  EXPECT_EQ(k.scans_to_95_percent(), e.kpis.scans_to_95_percent);
  EXPECT_EQ(k.drift_per_minute(), e.kpis.drift_per_minute);
  EXPECT_EQ(k.nees(), e.kpis.nees);
  EXPECT_EQ(k.scans_used(), e.kpis.scans_used);
  EXPECT_EQ(k.detections_used(), e.kpis.detections_used);
}

TEST(AlignmentByDds, DependsOnEveryByteOfTheMessage) {
  const AlignmentEstimate e = estimate();
  std::vector<std::size_t> unused;
  samples::append(unused, offsetof(AlignmentEstimate, reserved), 1);
  samples::append(unused, offsetof(AlignmentEstimate, kpis) + offsetof(AlignmentKpis, reserved), 4);
  // An estimate is the sum of many scans: the stages of one of them say nothing.
  const std::size_t begin = sizeof(MessageHeader);
  const std::size_t covariance = offsetof(AlignmentEstimate, covariance);
  // Up to the alignment of the covariances there may be a gap.
  const std::size_t gap = offsetof(AlignmentEstimate, angle_noise_scale) + sizeof(float);
  for (std::size_t i = gap; i < covariance; ++i) unused.insert(unused.end() - 4, i);
  const std::size_t end = offsetof(AlignmentEstimate, kpis) + sizeof(AlignmentKpis);
  EXPECT_EQ(samples::without_effect(e, begin, end, estimate_bytes), unused);
  const std::size_t end_of_numbers = offsetof(MessageHeader, time_source);
  EXPECT_TRUE(samples::without_effect(e, 0, end_of_numbers, estimate_bytes).empty());
}

TEST(AlignmentByDds, KeepsWhatIsNoNumber) {
  AlignmentEstimate e = estimate();
  e.kpis.nees = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(samples::received<EstimateType>(estimate_sample(e)).kpis().nees()));
}

TEST(AlignmentByDds, ReplacesAnImpossibleValueOfAnEnumeration) {
  AlignmentEstimate e = estimate();
  e.state = static_cast<AlignmentState>(9);
  e.finding = static_cast<AlignmentFinding>(99);
  EXPECT_EQ(estimate_sample(e).state(), diagnostics::ALIGNMENT_NO_DATA);
  EXPECT_EQ(estimate_sample(e).finding(), diagnostics::FINDING_NONE);
}

}  // namespace
}  // namespace boresight::dds
