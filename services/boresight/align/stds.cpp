#include "services/boresight/align/stds.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

std::array<double, kParameters> turn_stds(const alignment::RadarEstimate& estimate) {
  // Places of (k_v, yaw, pitch, roll) in the covariance of (k_v, d_x, d_y, d_z).
  constexpr std::array<Eigen::Index, kParameters> kPlace = {0, 3, 2, 1};
  std::array<double, kParameters> stds{};
  for (std::size_t i = 0; i < kParameters; ++i) {
    stds.at(i) = std::sqrt(std::max(0.0, estimate.covariance(kPlace.at(i), kPlace.at(i))));
  }
  return stds;
}

std::array<double, kParameters> component_stds(const RadarConfig& config, const alignment::RadarEstimate& estimate) {
  const Eigen::Vector4d values = alignment::vehicle_form(config, estimate);
  const Eigen::Matrix3d cross = geometry::cross_matrix({values(3), -values(2), values(1)});
  Eigen::Matrix4d change = Eigen::Matrix4d::Identity();
  change.bottomRightCorner<3, 3>() += -0.5 * cross + cross * cross / 12.0;
  alignment::RadarEstimate moved = estimate;
  moved.covariance = change * estimate.covariance * change.transpose();
  return turn_stds(moved);
}

}  // namespace boresight::align
