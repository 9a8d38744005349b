// Density of the range rate of one detection of an object: rigid body and micro-Doppler. Range rates over ground.
//
// A point of a rigid body at p moves with v + ω × (p − c): velocity v at the centre c, turn rate ω. Seen from s along
// u = (p − s)/|p − s|, with p = s + ρu the range ρ cancels:
//
//     (6)   ṙ = u·v + ω (r_x u_y − r_y u_x),   r = s − c.
//
// So the range rate depends on the line of sight alone, and neither range noise nor the place on the body enters.
//
// Parts that move against the body (rotating parts of vehicles, limbs) add a deviation δ. With the share g(φ) of them
// at aspect φ, and the speed |v|:
//
//     (7)   δ ~ (1 − g) N(0, σ_b²) + g (1 − ℓ) N(0, σ_b² + σ_s²) + g ℓ N(μ ṙ, σ_b² + σ_s² + (σ_r ṙ)²),
//           σ_s² = `small_std_mps`² · |v|² / (|v|² + `full_speed_mps`²).
//
// The third term is what scales with the body: a point of a rotating tyre moves along the road with 0 … 2 v, so its
// deviation is −1 … 1 times the range rate. The measured ratio of deviations over 1 m/s has the quantiles (5, 25, 50,
// 75, 95 %) −0.88, −0.47, −0.11, 0.18, 0.52; a normal distribution with μ = −0.15, σ_r = 0.43 has −0.86, −0.44, −0.15,
// 0.14, 0.56. The second term holds the many deviations of 0.5 … 1 m/s. Nothing rotates on an object at rest.
//
// g is rear_share, front_share and side_share at the three aspects, blended by sin⁴φ: a matter of the side.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "services/common/extended_object/object_classes.hpp"

namespace boresight::extended_object {

/// u: unit vector from the sensor to a point; zero if they coincide, which makes all range rates zero.
[[nodiscard]] Eigen::Vector2d line_of_sight(const Eigen::Vector2d& sensor_m, const Eigen::Vector2d& point_m);

/// Equation (6). All vectors in one frame.
[[nodiscard]] double rigid_range_rate_mps(const Eigen::Vector2d& sight, const Eigen::Vector2d& sensor_m,
                                          const Eigen::Vector2d& centre_m, const Eigen::Vector2d& velocity_mps,
                                          double turn_rate_radps);

struct RangeRateComponent {
  double weight = 0.0, mean_mps = 0.0, variance_m2ps2 = 0.0;
};
/// Body; small deviations; deviations in proportion. Weights sum to 1.
inline constexpr std::size_t kRangeRateComponents = 3;
using RangeRateMixture = std::array<RangeRateComponent, kRangeRateComponents>;

/// The mixture (7) of ṙ + δ without measurement noise. `sight_box`: line of sight in box axes. `body_mps`: (6).
[[nodiscard]] RangeRateMixture range_rate_mixture(const MicroDoppler& model, const Eigen::Vector2d& sight_box,
                                                  double body_mps, double speed_mps);

/// Density in s/m. `variance_m2ps2`: of the measurement, with that of the predicted range rate where it is uncertain.
[[nodiscard]] double range_rate_density(const RangeRateMixture& mixture, double range_rate_mps, double variance_m2ps2);

/// Probability that a detection shows the body and not a moving part: its weight in a Kalman update of the velocity.
[[nodiscard]] double body_probability(const RangeRateMixture& mixture, double range_rate_mps, double variance_m2ps2);

/// Mean and variance of the whole mixture, without measurement noise: for an update that must not look at the value.
struct RangeRateMoments {
  double mean_mps = 0.0, variance_m2ps2 = 0.0;
};
[[nodiscard]] RangeRateMoments range_rate_moments(const RangeRateMixture& mixture);

}  // namespace boresight::extended_object
