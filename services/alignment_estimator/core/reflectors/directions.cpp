#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/alignment_estimator/core/reflectors/check.hpp"
#include "services/common/estimation/median.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::reflectors {

namespace {

using Row23 = Eigen::Matrix<double, 2, 3>;

constexpr double kTukeyOfDirections = 5.0;  // of the Mahalanobis distance of two angles

/// Predicted direction of a position under a rotation, and its derivatives.
struct Prediction {
  Eigen::Vector2d angles;  ///< azimuth, elevation
  Row23 by_turn;           ///< ∂angles/∂δ of R ← Exp(δ)·R
  Row23 by_place;          ///< ∂angles/∂(surveyed position), 1/m
};

Prediction predict(const Position& position, const Eigen::Vector3d& place, const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d way = position.surveyed_m - place;
  const double range = way.norm();
  const Eigen::Vector3d direction = way / range, seen = rotation.transpose() * direction;
  const double level = std::max(seen.x() * seen.x() + seen.y() * seen.y(), 1e-12);
  Row23 angles_by_direction;
  angles_by_direction << -seen.y() / level, seen.x() / level, 0.0, 0.0, 0.0, 1.0 / std::sqrt(level);
  const Row23 into_sensor = angles_by_direction * rotation.transpose();
  return {{std::atan2(seen.y(), seen.x()), std::asin(std::clamp(seen.z(), -1.0, 1.0))},
          into_sensor * geometry::cross_matrix(direction),
          into_sensor * (Eigen::Matrix3d::Identity() - direction * direction.transpose()) / range};
}

class Fit {
 public:
  Fit(std::span<const Position> positions, const RadarConfig& radar, const Config& config)
      : positions_(positions), radar_(radar), config_(config), place_(place_of(radar)) {
    const MountingPose& pose = radar.mounting_pose;
    nominal_ = geometry::sensor_to_vehicle(pose, 0.0, 0.0, 0.0);
    const Eigen::Matrix3d upright = geometry::sensor_to_vehicle(pose.yaw_rad, pose.pitch_rad, 0.0);
    const Eigen::Vector3d stds(config.prior_roll_std_rad, config.prior_pitch_std_rad, config.prior_yaw_std_rad);
    prior_ = upright * stds.cwiseAbs2().asDiagonal() * upright.transpose();
    // Positions with a wrong range belong to another reflector and are rejected.
    for (const Position& position : positions) {
      const double expected_m = (position.surveyed_m - place_).norm();
      right_range_.push_back(std::abs(position.range_m - expected_m) <= config.range_gate_m);
    }
    distance_.assign(positions.size(), 0.0);
    weight_.assign(positions.size(), 1.0);
  }

  Result run() {
    Result result;
    start();
    // Wide gates first, because the start from medians is not exact.
    for (const double widen : {8.0, 4.0, 2.0, 1.0}) {
      for (int round = 0; round < 8; ++round) {
        weigh(widen);
        if (step() < 1e-12) break;
      }
    }
    weigh(1.0);
    report(result);
    return result;
  }

 private:
  [[nodiscard]] Eigen::Vector2d residual(const Position& position, const Prediction& prediction) const {
    const double azimuth = geometry::wrap_angle(position.azimuth_rad - prediction.angles[0]);
    return {azimuth, config_.has_elevation ? position.elevation_rad - prediction.angles[1] : 0.0};
  }

  /// Inverse covariance of the residual: noise of the radar and errors of the survey.
  [[nodiscard]] Eigen::Matrix2d information(const Position& position, const Prediction& prediction) const {
    const double factor = median_factor(position.scans);
    const Eigen::Vector2d noise(radar_.noise.azimuth_std_rad * factor, radar_.noise.elevation_std_rad * factor);
    const Eigen::Vector3d survey(config_.survey_std_m, config_.survey_std_m, config_.height_std_m);
    Eigen::Matrix2d covariance =
        prediction.by_place * survey.cwiseAbs2().asDiagonal() * prediction.by_place.transpose();
    covariance += Eigen::Matrix2d(noise.cwiseAbs2().asDiagonal());
    if (config_.has_elevation) return covariance.inverse();
    Eigen::Matrix2d only_azimuth = Eigen::Matrix2d::Zero();
    only_azimuth(0, 0) = 1.0 / covariance(0, 0);
    return only_azimuth;
  }

  /// Rotation that brings the medians of the residuals to 0, separately in azimuth and elevation.
  void start() {
    rotation_ = nominal_;
    std::vector<double> azimuths, elevations;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (!right_range_[i]) continue;
      const Eigen::Vector2d r = residual(positions_[i], predict(positions_[i], place_, rotation_));
      azimuths.push_back(r[0]);
      elevations.push_back(r[1]);
    }
    if (azimuths.empty()) return;
    // A sensor turned to its right sees reflectors too far left.
    rotation_ =
        nominal_ * geometry::sensor_to_vehicle(-estimation::median(azimuths), -estimation::median(elevations), 0.0);
  }

  void weigh(double widen) {
    std::vector<double> squares;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Prediction prediction = predict(positions_[i], place_, rotation_);
      const Eigen::Vector2d r = residual(positions_[i], prediction);
      distance_[i] = r.dot(information(positions_[i], prediction) * r);
      if (right_range_[i]) squares.push_back(distance_[i]);
    }
    // Median of χ² with two and with one degree of freedom.
    const double expected = config_.has_elevation ? 1.386 : 0.455;
    scale_ = squares.empty() ? 1.0 : std::max(1.0, std::sqrt(estimation::median(squares) / expected));
    const double gate = kTukeyOfDirections * scale_ * widen;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double share = distance_[i] / (gate * gate);
      weight_[i] = right_range_[i] && share < 1.0 ? (1.0 - share) * (1.0 - share) : 0.0;
    }
  }

  /// One step of Gauss–Newton; returns its length in rad.
  double step() {
    Eigen::Matrix3d normal;
    Eigen::Vector3d right;
    accumulate(normal, right);
    const Eigen::Vector3d turn = normal.ldlt().solve(right);
    if (!turn.allFinite()) return 0.0;
    rotation_ = geometry::so3_exp(turn) * rotation_;
    return turn.norm();
  }

  void accumulate(Eigen::Matrix3d& normal, Eigen::Vector3d& right) const {
    const Eigen::Matrix3d prior_information = prior_.inverse();
    normal = prior_information;
    right = -prior_information * geometry::so3_log(rotation_ * nominal_.transpose());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (weight_[i] == 0.0) continue;
      const Prediction prediction = predict(positions_[i], place_, rotation_);
      const Eigen::Matrix2d w = weight_[i] / (scale_ * scale_) * information(positions_[i], prediction);
      normal += prediction.by_turn.transpose() * w * prediction.by_turn;
      right += prediction.by_turn.transpose() * w * residual(positions_[i], prediction);
    }
  }

  void report(Result& result) {
    Eigen::Matrix3d by_mounting = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Prediction prediction = predict(positions_[i], place_, rotation_);
      const Eigen::Vector2d r = residual(positions_[i], prediction);
      result.residual_azimuth_rad.push_back(r[0]);
      result.residual_elevation_rad.push_back(r[1]);
      const bool used = weight_[i] > 0.0;
      result.used.push_back(used);
      result.positions_used += used ? 1 : 0;
      if (!used) continue;
      // For the covariance an accepted position counts in full: Tukey's weights of good data lose only five percent.
      weight_[i] = 1.0;
      by_mounting += prediction.by_turn.transpose() * information(positions_[i], prediction) * prediction.by_place /
                     (scale_ * scale_);
    }
    Eigen::Matrix3d normal;
    Eigen::Vector3d right;
    accumulate(normal, right);
    const Eigen::Matrix3d covariance = normal.inverse();
    // An error of the radar's position moves all directions together.
    const Eigen::Matrix3d common = config_.mounting_std_m * covariance * by_mounting;
    result.noise_scale = scale_;
    result.rotation.radar_id = radar_.id;
    result.rotation.rotation_vehicle_rad = geometry::so3_log(rotation_ * nominal_.transpose());
    result.rotation.covariance = covariance + common * common.transpose();

    const Eigen::Vector3d angles = geometry::euler_angles(rotation_);
    const MountingPose& pose = radar_.mounting_pose;
    result.yaw_rad = geometry::wrap_angle(angles[0] - pose.yaw_rad);
    result.pitch_rad = angles[1] - pose.pitch_rad;
    result.roll_rad = geometry::wrap_angle(angles[2] - pose.roll_rad);
    const Eigen::Matrix3d gradient = geometry::euler_gradient(angles[0], angles[1]);
    const Eigen::Vector3d stds =
        (gradient * result.rotation.covariance * gradient.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
    const Eigen::Vector3d before = (gradient * prior_ * gradient.transpose()).diagonal().cwiseSqrt();
    result.yaw_std_rad = stds[0];
    result.pitch_std_rad = stds[1];
    result.roll_std_rad = stds[2];
    result.pitch_observable = stds[1] < 0.5 * before[1];
    result.roll_observable = stds[2] < 0.5 * before[2];
    if (2 * result.positions_used <= positions_.size()) result.problem = Problem::kTooFewAgree;
  }

  std::span<const Position> positions_;
  const RadarConfig& radar_;
  const Config& config_;
  Eigen::Vector3d place_;
  Eigen::Matrix3d nominal_, prior_, rotation_;
  std::vector<bool> right_range_;
  std::vector<double> distance_, weight_;
  double scale_ = 1.0;
};

}  // namespace

Result fit_directions(std::span<const Position> positions, const RadarConfig& radar, const Config& config) {
  Result result;
  std::tie(result.problem, result.problem_position) = check(positions, radar, config);
  return result.ok() ? Fit(positions, radar, config).run() : result;
}

}  // namespace boresight::alignment::reflectors
