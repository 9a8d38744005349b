#include "services/alignment_estimator/core/batch/estimate_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::batch {

namespace {

constexpr std::array<AlignmentValue AlignmentNuisance::*, 7> kNuisances{
    &AlignmentNuisance::range_rate_scale, &AlignmentNuisance::time_offset_s,
    &AlignmentNuisance::position_x_m,     &AlignmentNuisance::position_y_m,
    &AlignmentNuisance::yaw_rate_gain,    &AlignmentNuisance::pitch_per_acceleration_radps2pm,
    &AlignmentNuisance::load_pitch_rad};

/// Calls `use(value, std)` for all but the main values.
template <typename Estimate, typename Use>
void for_each_nuisance(Estimate& e, Use&& use) {
  for (const auto member : kNuisances) use((e.nuisance.*member).value, (e.nuisance.*member).std);
  for (std::size_t k = 0; k < kAzimuthCurveKnots; ++k) {
    use(e.nuisance.azimuth_curve_rad[k], e.nuisance.azimuth_curve_std_rad[k]);
  }
  use(e.yaw_rate_bias_radps, e.yaw_rate_bias_std_radps);
  use(e.slip_coefficient_radps2pm, e.slip_coefficient_std_radps2pm);
  use(e.drift.pitch_radps, e.drift.pitch_std_radps);
  use(e.drift.yaw_radps, e.drift.yaw_std_radps);
}

}  // namespace

Values values_of(const RadarEstimate& estimate, const Eigen::Matrix3d& about) {
  Values values;
  values(0) = estimate.speed_scale;
  values.segment<3>(1) = geometry::so3_log(estimate.sensor_to_vehicle * about.transpose());
  int i = kMainValues;
  for_each_nuisance(estimate, [&](double value, double) { values(i++) = value; });
  return values;
}

Values stds_of(const RadarEstimate& estimate) {
  Values stds;
  stds.head<kMainValues>() = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  int i = kMainValues;
  for_each_nuisance(estimate, [&](double, double std) { stds(i++) = std; });
  return stds;
}

void widen(RadarEstimate& estimate, const Values& stds) {
  const Values now = stds_of(estimate);
  const Values factors = (now.array() > 0.0).select((stds.array() / now.array().max(1e-30)).max(1.0), 1.0);
  const Eigen::Vector4d main = factors.head<kMainValues>();
  estimate.covariance = main.asDiagonal() * estimate.covariance * main.asDiagonal();
  int i = kMainValues;
  for_each_nuisance(estimate, [&](auto&, auto& std) {
    using Std = std::remove_reference_t<decltype(std)>;
    std = static_cast<Std>(static_cast<double>(std) * factors(i++));
  });
}

double moved_stds(const RadarEstimate& a, const RadarEstimate& b) {
  const Values move = values_of(a, b.sensor_to_vehicle) - values_of(b, b.sensor_to_vehicle);
  const Values stds = stds_of(b);
  double most = 0.0;
  for (int i = 0; i < kMainValues; ++i) {
    if (stds(i) > 0.0) most = std::max(most, std::abs(move(i)) / stds(i));
  }
  return most;
}

}  // namespace boresight::alignment::batch
