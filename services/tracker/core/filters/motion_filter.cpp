#include "services/tracker/core/filters/motion_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/tracker/core/filters/constant_acceleration.hpp"
#include "services/tracker/core/filters/polar_measurement.hpp"

namespace boresight::tracking::filters {

namespace {

constexpr std::array<std::string_view, 5> kNames = {"kalman", "ekf", "ukf", "srukf", "fast_srukf"};

/// Place and range rate as values and noise of M components, position first.
template <int M>
struct Measured {
  Vector<double, M> value;
  Noise<double, M> noise;
};

template <int M>
std::optional<Measured<M>> measured(const Eigen::Vector2d& place, const Eigen::Matrix2d& covariance,
                                    const std::optional<RangeRate>& range_rate) {
  Vector<double, M> value;
  Matrix<double, M, M> all = Matrix<double, M, M>::Zero();
  value.template head<2>() = place;
  all.template topLeftCorner<2, 2>() = covariance;
  if constexpr (M == 3) {
    value(2) = range_rate->mean_mps;
    all(2, 2) = range_rate->variance_m2ps2;
  }
  const std::optional<Noise<double, M>> noise = noise_of<double, M>(all);
  if (!value.allFinite() || !noise) return std::nullopt;
  return Measured<M>{value, *noise};
}

/// (T31): the same place as range and azimuth about the sensor.
template <int M>
std::optional<Measured<M>> measured_polar(const Eigen::Vector2d& position_m, const Eigen::Matrix2d& covariance_m2,
                                          const std::optional<RangeRate>& range_rate, const Eigen::Vector2d& sensor_m) {
  const Eigen::Vector2d line = position_m - sensor_m;
  const double range_m = line.norm();
  if (!(range_m > 0.0)) return std::nullopt;
  const Eigen::Vector2d along = line / range_m;
  Eigen::Matrix2d jacobian;
  jacobian << along.x(), along.y(), -along.y() / range_m, along.x() / range_m;
  return measured<M>({range_m, std::atan2(line.y(), line.x())}, jacobian * covariance_m2 * jacobian.transpose(),
                     range_rate);
}

}  // namespace

std::optional<FilterKind> filter_kind(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<FilterKind>(found - kNames.begin());
}

std::string_view name_of(FilterKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

std::span<const std::string_view> filter_kind_names() {
  return kNames;
}

MotionFilter::Filter MotionFilter::make(FilterKind kind, const MotionState& state,
                                        const SigmaPointParameters& parameters) {
  const Gaussian<double, 6> gaussian{state.mean, state.covariance};
  switch (kind) {
    case FilterKind::kKalman:
      return Kalman<double, 6>(gaussian);
    case FilterKind::kExtendedKalman:
      return ExtendedKalman<double, 6>(gaussian);
    case FilterKind::kUnscented:
      return Unscented<double, 6>(gaussian, parameters);
    case FilterKind::kSquareRootUnscented:
      return SquareRootUnscented<double, 6>(gaussian, parameters);
    case FilterKind::kFastSquareRootUnscented:
      break;
  }
  return FastSquareRootUnscented<double, FastForm::kPureRoot>(gaussian, parameters);
}

MotionFilter::MotionFilter(FilterKind kind, const MotionState& state, const SigmaPointParameters& parameters)
    : parameters_(parameters),
      filter_(make(kind, state, parameters)),
      is_valid_(parameters.is_valid(6) && std::visit([](const auto& filter) { return filter.is_valid(); }, filter_)) {}

template <typename Change>
bool MotionFilter::apply(Change&& change) {
  if (!is_valid_) return false;
  Filter changed = filter_;
  if (!std::visit([&](auto& filter) { return change(filter); }, changed)) return false;
  filter_ = changed;
  return true;
}

bool MotionFilter::predict(double elapsed_s, const ProcessNoise& noise) {
  if (!std::isfinite(elapsed_s) || !noise.is_valid()) return false;
  const ConstantAcceleration<double, 2> motion(elapsed_s, noise);
  return apply([&](auto& filter) { return filter.predict(motion); });
}

bool MotionFilter::shift(const Eigen::Vector2d& origin_displacement_m) {
  if (!origin_displacement_m.allFinite()) return false;
  Vector<double, 6> change = Vector<double, 6>::Zero();
  change(0) = -origin_displacement_m.x();
  change(3) = -origin_displacement_m.y();
  return apply([&](auto& filter) {
    filter.shift(change);
    return true;
  });
}

template <int M>
bool MotionFilter::update_cartesian(const LinearMeasurement<double, 6, M>& measurement, const Vector<double, M>& value,
                                    const Noise<double, M>& noise) {
  return apply([&](auto& filter) { return filter.update(measurement, value, noise); });
}

bool MotionFilter::update(const Eigen::Vector2d& position_m, const Eigen::Matrix2d& covariance_m2,
                          const std::optional<RangeRate>& range_rate, const Eigen::Vector2d& sensor_m) {
  if (!sensor_m.allFinite() || (range_rate && !range_rate->line_of_sight.allFinite())) return false;
  const auto by_place = [&]<int M>(const LinearMeasurement<double, 6, M>& linear) {
    if (auto* kalman = std::get_if<Kalman<double, 6>>(&filter_); kalman != nullptr) {
      const auto input = measured<M>(position_m, covariance_m2, range_rate);
      return input && update_cartesian<M>(linear, input->value, input->noise);
    }
    const auto input = measured_polar<M>(position_m, covariance_m2, range_rate, sensor_m);
    if (!input) return false;
    const PolarMeasurement<double, M> polar{sensor_m};
    return apply([&](auto& filter) {
      if constexpr (std::is_same_v<std::decay_t<decltype(filter)>, Kalman<double, 6>>) {
        return false;
      } else {
        return filter.update(polar, input->value, input->noise);
      }
    });
  };
  if (!range_rate) return by_place(position_measurement<double>());
  return by_place(position_and_range_rate_measurement<double>(range_rate->line_of_sight));
}

bool MotionFilter::update_velocity(const Eigen::Vector2d& velocity_mps, const Eigen::Matrix2d& covariance_m2ps2) {
  const auto input = measured<2>(velocity_mps, covariance_m2ps2, std::nullopt);
  return input && update_cartesian<2>(velocity_measurement<double>(), input->value, input->noise);
}

MotionState MotionFilter::state() const {
  const Gaussian<double, 6> gaussian = std::visit([](const auto& filter) { return filter.gaussian(); }, filter_);
  return {gaussian.mean, gaussian.covariance};
}

bool MotionFilter::set_state(const MotionState& state) {
  const MotionFilter changed(kind(), state, parameters_);
  if (!changed.is_valid()) return false;
  *this = changed;
  return true;
}

}  // namespace boresight::tracking::filters
