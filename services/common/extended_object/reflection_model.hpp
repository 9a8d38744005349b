// Where on an object a radar's reflections lie, and the density of a detection given the object and its class.
//
// Box axes: origin at the centre of the box, x along the heading, y to the left. The sensor is at s = (s_x, s_y) in
// these axes, outside or inside. l and w are half of length and width. Left-right and front-rear are mirror symmetric,
// so "near end" is the end at sign(s_x)·l and "near side" the side at sign(s_y)·w.
//
// 1. Which part reflects. A share q (`interior_share`) of the reflections comes from within the box: from the
// underbody, the axles and the interior behind the windows. The rest comes from the visible faces. Each visible face
// has a share in proportion to its projected length
//
//     (2)   a_end = 2w · h_x / √(h_x² + s_y²),   a_side = 2l · h_y / √(h_y² + s_x²),
//           h_x = ⌊|s_x| − l⌋,   h_y = ⌊|s_y| − w⌋,   ⌊d⌋ = max(0, d) rounded within ± `corner_radius_m`,
//
// h being the sensor's distance before the plane of the face. Weights: W_end = v(1 − q) a_end / (a_end + a_side),
// W_side alike, W_in = 1 − W_end − W_side; v rises from 0 to 1 as the sensor passes a face from within. A face has no
// weight where sign(s_x) or sign(s_y) changes, so nothing jumps.
//
// 2. Where along the part. Parts behind others reflect less: the density falls by exp(−distance / b) with the distance
// behind the near end, along the line of sight; b = `decay_m`. Along x that is the density exp(λ_x x) on [−l, l], with
//
//     (3)   λ_x = c_x / b,   c_x = (r(−l) − r(l)) / 2l = 2 s_x / (r(−l) + r(l)),   r(x) = |s − (x, 0)|,
//
// the mean slope of the range along the box. From afar c_x is the cosine of the aspect angle. Beside a long vehicle it
// is 0 where the sensor is abeam of the middle, however near. Along y the same with w and s_y. Equation (1) of
// truncated_exponential.hpp has the moments, and the limits 0 and ∞ of λ are harmless.
//
// 3. How deep. A reflection on a face lies below it by d ± σ_d (`face_depth_m`, `face_depth_std_m`), no deeper than a
// quarter of the box.
//
// So the parts are: near end (depth × exponential across), near side (exponential along × depth), interior (exponential
// along × exponential across). Each is replaced by Gaussians of its mean and covariance. What extends along x is first
// cut into thirds, so that a side 12 m long is not one Gaussian; a third has the share exp(λ_x x_k) / Σ at its middle
// x_k. Cutting changes no moment, by the law of total variance. Seven Gaussians result, with diagonal covariances:
//
//     (4)   p(z | object) = Σ_k W_k · N(z; μ_k, Σ_k + R)   with the measurement covariance R.
//
// All W, μ, Σ are closed forms, once continuously differentiable in s and so in aspect and range.
//
// Several scans. The reflections of one scan are independent draws of (4), mean m, covariance S. The place of each is
// held from scan to scan with correlation ρ (`scan_correlation`). The mean of n reflections therefore has the variance
// S/n in one scan, but over many scans its mean falls as that of white noise with κ S/n,
//
//     (5)   κ = 1 + 2ρ + 2ρ² + … = (1 + ρ) / (1 − ρ).
//
// A filter without a state for the offset therefore takes κ S/n in each scan. A filter with such a state gives it the
// variance S/n and the correlation ρ instead. What an uncertain length does to m, by ∂m/∂L, lasts, and so does the
// object's own depth, with the deviation `lasting_std_m` towards the sensor.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "services/common/extended_object/object_classes.hpp"
#include "services/common/extended_object/oriented_box.hpp"

namespace boresight::extended_object {

/// One Gaussian, in box axes; its covariance is diagonal.
struct ReflectionComponent {
  double weight = 0.0;
  Eigen::Vector2d mean_m{0.0, 0.0};
  Eigen::Vector2d variance_m2{0.0, 0.0};
};

/// Near end; near side in three parts from rear to front; interior in three parts from rear to front. Weights sum to 1.
inline constexpr std::size_t kLengthParts = 3;  ///< of what extends along the length
inline constexpr std::size_t kReflectionComponents = 1 + 2 * kLengthParts;
using ReflectionMixture = std::array<ReflectionComponent, kReflectionComponents>;

/// The mixture (4) without measurement noise. `sensor_box_m`: the sensor in box axes, OrientedBox::to_box().
[[nodiscard]] ReflectionMixture reflection_mixture(const ReflectionPlaces& places, double length_m, double width_m,
                                                   const Eigen::Vector2d& sensor_box_m);

/// Density (4) of one detection's position, in 1/m². Point and measurement covariance in box axes.
[[nodiscard]] double position_density(const ReflectionMixture& mixture, const Eigen::Vector2d& point_box_m,
                                      const Eigen::Matrix2d& covariance_box_m2);

/// Field of view of a radar in the plane, in box axes: what lies outside does not reflect for this radar.
struct ViewSector {
  Eigen::Vector2d facing{1.0, 0.0};  ///< unit vector along its middle
  double half_angle_rad = 4.0;       ///< from π on: all around
  double edge_rad = 0.0;             ///< softness of its edges, one standard deviation
};

/// The mixture (4) with each Gaussian weighted by its share within the sector; weights sum to `share`.
struct SeenMixture {
  ReflectionMixture mixture;
  double share = 1.0;  ///< of the reflections that are in view
};
[[nodiscard]] SeenMixture seen_in(const ReflectionMixture& mixture, const Eigen::Vector2d& sensor_box_m,
                                  const ViewSector& sector);

/// Mean offset m of the reflections in view from the centre of the box, and their scatter; box axes.
struct ReflectionMoments {
  double share_in_view = 1.0;
  Eigen::Vector2d mean_m{0.0, 0.0};
  Eigen::Vector2d mean_by_length{0.0, 0.0};              ///< ∂m/∂L
  Eigen::Matrix2d scatter_m2 = Eigen::Matrix2d::Zero();  ///< S: of one reflection about m
};

[[nodiscard]] ReflectionMoments reflection_moments(const ReflectionPlaces& places, double length_m, double width_m,
                                                   const Eigen::Vector2d& sensor_box_m, const ViewSector& sector = {});

/// κ of (5).
[[nodiscard]] double held_noise_factor(double scan_correlation);

/// An object and a detection in one frame, vehicle or world. Velocities and range rates are over ground: the motion of
/// the sensor is compensated.
struct ObservedObject {
  OrientedBox box;
  Eigen::Vector2d velocity_mps{0.0, 0.0};  ///< of the centre
  double turn_rate_radps = 0.0;
};
struct ObservedDetection {
  Eigen::Vector2d position_m{0.0, 0.0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  double range_rate_mps = 0.0;
  double range_rate_variance_m2ps2 = 0.0;
};

/// p(detection | object, class) in 1/(m²·m/s): (4) times the density of the range rate at that line of sight
/// (range_rate_model.hpp), whose variance grows by that of the azimuth.
[[nodiscard]] double detection_density(const ObjectClassModel& model, const ObservedObject& object,
                                       const Eigen::Vector2d& sensor_m, const ObservedDetection& detection);

}  // namespace boresight::extended_object
