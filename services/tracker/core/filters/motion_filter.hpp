// The motion of one object, by a filter that is chosen by name when the program runs. All kinds take the same
// measurements: a place with its covariance, a range rate, a velocity. A value type without heap memory.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <Eigen/Core>

#include "services/tracker/core/filters/axis_motion.hpp"
#include "services/tracker/core/filters/fast_srukf.hpp"
#include "services/tracker/core/filters/kalman.hpp"
#include "services/tracker/core/filters/srukf.hpp"
#include "services/tracker/core/filters/ukf.hpp"

namespace boresight::tracking::filters {

enum class FilterKind : std::uint8_t {
  kKalman,                   ///< "kalman": measurements as they are, Cartesian and linear
  kExtendedKalman,           ///< "ekf": measurements as range and azimuth, linearised
  kUnscented,                ///< "ukf": the same by sigma points
  kSquareRootUnscented,      ///< "srukf": the same by square roots of covariances
  kFastSquareRootUnscented,  ///< "fast_srukf": the same with a linear prediction
};

/// Nothing if the name is not one of filter_kind_names().
[[nodiscard]] std::optional<FilterKind> filter_kind(std::string_view name);
[[nodiscard]] std::string_view name_of(FilterKind kind);
/// In the order of the kinds.
[[nodiscard]] std::span<const std::string_view> filter_kind_names();

/// State [x, v_x, a_x, y, v_y, a_y] over ground in m, m/s and m/s², in axes that do not turn.
struct MotionState {
  Eigen::Matrix<double, 6, 1> mean = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
};

/// Range rate over ground, with the direction from the sensor to where it was measured.
struct RangeRate {
  Eigen::Vector2d line_of_sight = Eigen::Vector2d::UnitX();  ///< unit vector, in the axes of the state
  double mean_mps = 0.0;
  double variance_m2ps2 = 1.0;
};

/// Every change returns false, and leaves the state as it was, if a value is not finite or a covariance is not positive
/// definite.
class MotionFilter {
 public:
  /// A covariance that is not positive definite makes the filter invalid: it refuses everything but set_state().
  MotionFilter(FilterKind kind, const MotionState& state, const SigmaPointParameters& parameters = {});

  [[nodiscard]] FilterKind kind() const { return static_cast<FilterKind>(filter_.index()); }
  [[nodiscard]] bool is_valid() const { return is_valid_; }

  /// A negative time is a step back along the motion, without noise.
  [[nodiscard]] bool predict(double elapsed_s, const ProcessNoise& noise);

  /// The origin of the axes moves by this vector, so that places change by its negative.
  [[nodiscard]] bool shift(const Eigen::Vector2d& origin_displacement_m);

  /// The place of the object, for example the centre of a cluster, with the covariance of its noise. Kinds other than
  /// kKalman convert both to range and azimuth about the sensor, and take the line of sight from the state.
  [[nodiscard]] bool update(const Eigen::Vector2d& position_m, const Eigen::Matrix2d& covariance_m2,
                            const std::optional<RangeRate>& range_rate, const Eigen::Vector2d& sensor_m);

  /// A velocity over ground, for example from the heading and the range rates of a cluster. Linear for all kinds.
  [[nodiscard]] bool update_velocity(const Eigen::Vector2d& velocity_mps, const Eigen::Matrix2d& covariance_m2ps2);

  [[nodiscard]] MotionState state() const;
  [[nodiscard]] bool set_state(const MotionState& state);

 private:
  using Filter = std::variant<Kalman<double, 6>, ExtendedKalman<double, 6>, Unscented<double, 6>,
                              SquareRootUnscented<double, 6>, FastSquareRootUnscented<double, FastForm::kPureRoot>>;

  [[nodiscard]] static Filter make(FilterKind kind, const MotionState& state, const SigmaPointParameters& parameters);
  template <int M>
  [[nodiscard]] bool update_cartesian(const LinearMeasurement<double, 6, M>& measurement,
                                      const Vector<double, M>& value, const Noise<double, M>& noise);
  /// Keeps the changed filter if `change` succeeds with it.
  template <typename Change>
  [[nodiscard]] bool apply(Change&& change);

  SigmaPointParameters parameters_;
  Filter filter_;
  bool is_valid_;
};

}  // namespace boresight::tracking::filters
