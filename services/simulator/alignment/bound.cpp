#include "services/simulator/alignment/bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "services/common/geometry/frames.hpp"

namespace boresight::simulator {

namespace {

// Columns of a detection's gradient: k_v, bias, slip, turn (3), error of speed, of yaw rate, body pitch.
using Gradient = Eigen::Matrix<double, 9, 1>;

double squared(double x) {
  return x * x;
}

double information_of(double std) {
  return std > 0.0 ? 1.0 / squared(std) : 1.0;
}

}  // namespace

CramerRaoBound::CramerRaoBound(const AlignmentSpec& spec, const AlignmentDrive& drive, const BoundPriors& priors)
    : spec_(spec),
      drive_(drive),
      parameters_(kShared + 3 * static_cast<Eigen::Index>(spec.radars.size())),
      known_(static_cast<std::size_t>(parameters_)),
      min_speed_mps_(priors.min_speed_mps),
      information_(Eigen::MatrixXd::Zero(parameters_ + 3, parameters_ + 3)) {
  if (spec.model != MountingModel::kExact) throw std::invalid_argument("the bound is for exact rotations only");
  std::vector<double> stds(known_.size(), priors.rotation_std_rad);
  stds[0] = priors.speed_scale_std;
  stds[1] = priors.yaw_rate_bias_std_radps;
  stds[2] = priors.slip_coefficient_std_radps2pm;
  for (std::size_t i = 0; i < stds.size(); ++i) {
    known_[i] = stds[i] <= 0.0;
    information_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) = information_of(stds[i]);
  }
  information_(parameters_, parameters_) = information_of(spec.speed_std_mps);
  information_(parameters_ + 1, parameters_ + 1) = information_of(spec.yaw_rate_std_radps);
  information_(parameters_ + 2, parameters_ + 2) = information_of(spec.body_pitch_std_rad);
}

void CramerRaoBound::eliminate(Eigen::MatrixXd& information, Eigen::Index variable) const {
  const double pivot = information(variable, variable);
  const Eigen::VectorXd column = information.col(variable);
  information.noalias() -= column * column.transpose() / pivot;
  information.col(variable).setZero();
  information.row(variable).setZero();
}

void CramerRaoBound::renew_ego_errors() {
  const std::array<double, 2> stds{spec_.speed_std_mps, spec_.yaw_rate_std_radps};
  for (Eigen::Index i = 0; i < 2; ++i) {
    eliminate(information_, parameters_ + i);
    information_(parameters_ + i, parameters_ + i) = information_of(stds[static_cast<std::size_t>(i)]);
  }
}

void CramerRaoBound::advance_pitch(double time_s) {
  const double elapsed_s = time_s - pitch_time_s_;
  pitch_time_s_ = time_s;
  if (spec_.body_pitch_std_rad <= 0.0 || elapsed_s <= 0.0) return;
  // p' = a·p + w: p is eliminated from the information that it shares with p' and all else.
  const double a = std::exp(-elapsed_s / spec_.body_pitch_correlation_s);
  const double q = squared(spec_.body_pitch_std_rad) * (1.0 - a * a);
  const Eigen::Index p = parameters_ + 2;
  information_(p, p) += a * a / q;
  const double pivot = information_(p, p);
  const Eigen::VectorXd others = information_.col(p) * (a / q / pivot);
  eliminate(information_, p);
  information_.col(p) = others;
  information_.row(p) = others.transpose();
  information_(p, p) = 1.0 / q - squared(a / q) / pivot;
}

void CramerRaoBound::add(const AlignmentEvent& event) {
  if (event.ego != nullptr) {
    renew_ego_errors();
    signalled_mps_ = static_cast<double>(event.ego->speed_mps);
  }
  if (event.scan == nullptr || std::abs(signalled_mps_) < min_speed_mps_) return;
  advance_pitch(event.time_s);
  const AlignmentRadar& radar = spec_.radars[event.radar];
  const std::array<double, 3>& position = radar.config.mounting_pose.position_m;
  const Eigen::Matrix3d rotation = drive_.sensor_to_vehicle(event.radar, event.time_s);
  const double speed = event.speed_mps, yaw_rate = event.yaw_rate_radps;
  const Eigen::Vector3d velocity(speed - yaw_rate * position[1], event.lateral_speed_mps + yaw_rate * position[0],
                                 event.vertical_speed_mps);
  const Eigen::Vector3d seen = rotation.transpose() * velocity;  // the sensor's motion in its own axes
  // Derivatives of the sensor's velocity by the vehicle's true speed and yaw rate.
  const double slip = spec_.total_slip_coefficient_radps2pm();
  const Eigen::Vector3d by_speed(1.0, -2.0 * slip * speed * yaw_rate, event.vertical_speed_mps / speed);
  const Eigen::Vector3d by_yaw_rate(-position[1], position[0] - slip * speed * speed, 0.0);
  const double rate_variance = squared(radar.config.noise.range_rate_std_mps);
  const double elevation_std = radar.noise_scale * radar.config.noise.elevation_std_rad;

  Eigen::Matrix<double, 9, 9> sum = Eigen::Matrix<double, 9, 9>::Zero();
  for (const AlignmentDetectionTruth& truth : *event.truth) {
    if (!truth.stationary) continue;
    const double sa = std::sin(truth.azimuth_rad), ca = std::cos(truth.azimuth_rad);
    const double se = std::sin(truth.elevation_rad), ce = std::cos(truth.elevation_rad);
    const Eigen::Vector3d sight = rotation * Eigen::Vector3d(ce * ca, ce * sa, se);
    const double by_azimuth = ce * (sa * seen.x() - ca * seen.y());
    const double by_elevation = se * (ca * seen.x() + sa * seen.y()) - ce * seen.z();
    const double azimuth_std =
        radar.noise_scale * radar.config.noise.azimuth_std_rad / std::max(ca, spec_.azimuth_std_edge);
    const double variance = rate_variance + squared(by_azimuth * azimuth_std) + squared(by_elevation * elevation_std);
    const Eigen::Vector3d by_turn = velocity.cross(sight);  // ṙ = −v·(Exp(d) U)
    const double of_speed = -sight.dot(by_speed), of_yaw_rate = -sight.dot(by_yaw_rate);
    Gradient g;
    g << of_speed * speed / spec_.speed_scale, -of_yaw_rate, sight.y() * speed * speed * yaw_rate,  //
        by_turn, of_speed * spec_.speed_scale, of_yaw_rate, -sight.z() * speed;
    sum.noalias() += g * (g / variance).transpose();
  }
  if (!radar.measures_elevation) {
    sum.middleRows<2>(3).setZero();
    sum.middleCols<2>(3).setZero();
  }
  const Eigen::Index first = kShared + 3 * static_cast<Eigen::Index>(event.radar);
  std::array<Eigen::Index, 9> place{
      0, 1, 2, first, first + 1, first + 2, parameters_, parameters_ + 1, parameters_ + 2};
  const std::array<bool, 9> fixed{known_[0],
                                  known_[1],
                                  known_[2],
                                  false,
                                  false,
                                  false,
                                  spec_.speed_std_mps <= 0.0,
                                  spec_.yaw_rate_std_radps <= 0.0,
                                  spec_.body_pitch_std_rad <= 0.0};
  for (std::size_t i = 0; i < place.size(); ++i) {
    for (std::size_t k = 0; k < place.size(); ++k) {
      if (fixed[i] || fixed[k]) continue;
      information_(place[i], place[k]) += sum(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
}

Eigen::MatrixXd CramerRaoBound::covariance() const {
  Eigen::MatrixXd information = information_;
  for (Eigen::Index i = 0; i < 3; ++i) eliminate(information, parameters_ + i);
  // Scaled to a unit diagonal, as the parameters' information differs by many orders of magnitude.
  const Eigen::MatrixXd block = information.topLeftCorner(parameters_, parameters_);
  const Eigen::VectorXd scale = block.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * block * scale.asDiagonal();
  Eigen::MatrixXd covariance = scale.asDiagonal() *
                               scaled.ldlt().solve(Eigen::MatrixXd::Identity(parameters_, parameters_)) *
                               scale.asDiagonal();
  for (Eigen::Index i = 0; i < parameters_; ++i) {
    if (!known_[static_cast<std::size_t>(i)]) continue;
    covariance.row(i).setZero();
    covariance.col(i).setZero();
  }
  return covariance;
}

Eigen::Vector3d CramerRaoBound::rotation_std_rad(std::size_t radar) const {
  return covariance().diagonal().segment<3>(kShared + 3 * static_cast<Eigen::Index>(radar)).cwiseSqrt();
}

double CramerRaoBound::speed_scale_std() const {
  return std::sqrt(covariance()(0, 0));
}

}  // namespace boresight::simulator
