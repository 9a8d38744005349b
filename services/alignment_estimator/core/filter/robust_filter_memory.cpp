// Memory from one drive to the next, and the start from a static calibration.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "services/alignment_estimator/core/filter/robust_filter.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

void RobustFilter::save(Memory& memory) const {
  memory = {};
  memory.number_of_radars = radars_.size();
  memory.speed_scale = state_.speed_scale;
  memory.yaw_rate_bias_radps = state_.yaw_rate_bias_radps;
  memory.slip_coefficient_radps2pm = state_.slip_radps2pm;
  constexpr std::array<std::pair<std::size_t, Eigen::Index>, 3> kShared{{{Memory::kSpeedScale, column::kSpeedScale},
                                                                         {Memory::kYawRateBias, column::kYawRateBias},
                                                                         {Memory::kSlip, column::kSlip}}};
  for (const auto& [to, from] : kShared) memory.variance(to, to) = state_.covariance(from, from);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Radar& radar = radars_[r];
    const Eigen::Vector3d turn = geometry::so3_log(state_.sensor_to_vehicle[r] * radar.nominal.transpose());
    Memory::Radar& known = memory.radars[r];
    known.id = radar.config.id;
    known.rotation_vehicle_rad = {turn.x(), turn.y(), turn.z()};
    known.angle_noise_scale = std::sqrt(radar.noise.angle_variance_factor());
    known.seconds_of_drive = radar.seconds_of_drive;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        known.rotation_variance(i, j) = state_.covariance(column::of_radar(r) + static_cast<Eigen::Index>(i),
                                                          column::of_radar(r) + static_cast<Eigen::Index>(j));
      }
    }
  }
}

void RobustFilter::restore(const Memory& memory) {
  if (memory.number_of_radars != radars_.size()) return;
  const auto variance = [&](std::size_t i) { return memory.variance(i, i); };
  const auto usable_variance = [](double v, double prior_std) { return v > 0.0 && v < square(prior_std); };
  state_.speed_scale = state_.linearised_speed_scale = memory.speed_scale;
  state_.yaw_rate_bias_radps = memory.yaw_rate_bias_radps;
  state_.slip_radps2pm = memory.slip_coefficient_radps2pm;
  // Correlations are not restored; the inflation of at least the variance bounds their effect.
  const auto remembered = [&](double v, double floor_std, double prior_std) {
    if (!usable_variance(v, prior_std)) return square(prior_std);
    return std::min(config_.memory_inflation * v + square(floor_std), square(prior_std));
  };
  state_.set_variance(column::kSpeedScale, remembered(variance(Memory::kSpeedScale), config_.memory_speed_scale_std,
                                                      config_.prior_speed_scale_std));
  state_.set_variance(column::kYawRateBias,
                      remembered(variance(Memory::kYawRateBias), 0.25 * config_.prior_yaw_rate_bias_std_radps,
                                 config_.prior_yaw_rate_bias_std_radps));
  state_.set_variance(column::kSlip,
                      remembered(variance(Memory::kSlip), 0.25 * config_.prior_slip_coefficient_std_radps2pm,
                                 config_.prior_slip_coefficient_std_radps2pm));
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    Radar& radar = radars_[r];
    const Memory::Radar& known = memory.radars[r];
    const Eigen::Vector3d turn(known.rotation_vehicle_rad[0], known.rotation_vehicle_rad[1],
                               known.rotation_vehicle_rad[2]);
    if (known.id != radar.config.id || !turn.allFinite() || turn.norm() > 1.0) continue;
    state_.sensor_to_vehicle[r] = geometry::so3_exp(turn) * radar.nominal;
    for (std::size_t i = 0; i < 3; ++i) {
      state_.set_variance(
          column::of_radar(r) + static_cast<Eigen::Index>(i),
          remembered(known.rotation_variance(i, i), config_.memory_rotation_std_rad, config_.prior_rotation_std_rad));
    }
    radar.noise.set_angle_scale(known.angle_noise_scale);
    radar.seconds_of_drive = known.seconds_of_drive;
    radar.remembered = true;
    radar.phase = Phase::kStarting;
    radar.start.clear();
  }
}

bool RobustFilter::seed(std::size_t index, const Eigen::Vector3d& rotation_vehicle_rad,
                        const Eigen::Matrix3d& covariance) {
  const bool usable = index < radars_.size() && rotation_vehicle_rad.allFinite() &&
                      rotation_vehicle_rad.norm() <= 1.0 && covariance.allFinite() &&
                      (covariance.diagonal().array() > 0.0).all();
  if (!usable) return false;
  Radar& radar = radars_[index];
  state_.sensor_to_vehicle[index] = geometry::so3_exp(rotation_vehicle_rad) * radar.nominal;
  const Eigen::Index first = column::of_radar(index);
  for (Eigen::Index i = 0; i < 3; ++i) state_.set_variance(first + i, covariance(i, i));
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) state_.set_covariance(first + i, first + j, covariance(i, j));
  }
  radar.seconds_of_drive = 0.0;
  radar.remembered = true;
  radar.phase = Phase::kStarting;
  radar.start.clear();
  return true;
}

}  // namespace boresight::alignment
