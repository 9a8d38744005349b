// Shared by the tests of the tracker's components: random objects and detections, and an independent single-object
// reference with Eigen.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/ggiw/prediction.hpp"

namespace boresight::tracking::support {

using Random = std::mt19937_64;
using Detections = std::vector<Measurement<double>>;

inline double uniform(Random& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}
inline double normal(Random& random) {
  return std::normal_distribution<double>()(random);
}

template <typename Real>
Eigen::Vector2d eigen(const Vector2<Real>& a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y)};
}
template <typename Real>
Eigen::Matrix2d eigen(const Symmetric2<Real>& s) {
  Eigen::Matrix2d m;
  m << static_cast<double>(s.xx), static_cast<double>(s.xy), static_cast<double>(s.xy), static_cast<double>(s.yy);
  return m;
}
template <typename Real>
Eigen::Matrix2d eigen(const Matrix2<Real>& s) {
  Eigen::Matrix2d m;
  m << static_cast<double>(s.xx), static_cast<double>(s.xy), static_cast<double>(s.yx), static_cast<double>(s.yy);
  return m;
}
inline Vector2<double> vector_of(const Eigen::Vector2d& a) {
  return {a.x(), a.y()};
}
inline Symmetric2<double> symmetric_of(const Eigen::Matrix2d& m) {
  return {m(0, 0), 0.5 * (m(0, 1) + m(1, 0)), m(1, 1)};
}
inline Matrix2<double> matrix_of(const Eigen::Matrix2d& m) {
  return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)};
}
/// Relative to the size of the expected value.
template <typename A, typename B>
double relative_error(const A& value, const B& expected) {
  return (value - expected).norm() / std::max(1e-12, expected.norm());
}

/// A A^T of a random A, with eigenvalues of the size of `scale`.
template <int Size>
Eigen::Matrix<double, Size, Size> random_positive(Random& random, double scale) {
  Eigen::Matrix<double, Size, Size> a;
  for (int i = 0; i < a.size(); ++i) a.data()[i] = normal(random);
  return scale / Size * (a * a.transpose()) + 0.05 * scale * Eigen::Matrix<double, Size, Size>::Identity();
}
inline Eigen::Matrix2d symmetric_root(const Eigen::Matrix2d& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(m).operatorSqrt();
}
inline Eigen::Matrix2d rotation(double angle_rad) {
  Eigen::Matrix2d r;
  r << std::cos(angle_rad), -std::sin(angle_rad), std::sin(angle_rad), std::cos(angle_rad);
  return r;
}

/// One object as dense matrices: the reference of the tests.
struct Reference {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();  ///< x, y, v_x, v_y
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double rate_shape = 1.0, rate_inverse_scale = 1.0, dof = 8.0;
  Eigen::Matrix2d scale = Eigen::Matrix2d::Identity();

  [[nodiscard]] Eigen::Matrix2d extent() const { return scale / (dof - 6.0); }
};

template <typename Real>
Reference reference_of(const Component<Real>& c) {
  Reference r;
  r.mean << eigen(c.position_m), eigen(c.velocity_mps);
  r.covariance.topLeftCorner<2, 2>() = eigen(c.position_covariance);
  r.covariance.topRightCorner<2, 2>() = eigen(c.position_velocity_covariance);
  r.covariance.bottomLeftCorner<2, 2>() = eigen(c.position_velocity_covariance).transpose();
  r.covariance.bottomRightCorner<2, 2>() = eigen(c.velocity_covariance);
  r.rate_shape = static_cast<double>(c.rate_shape);
  r.rate_inverse_scale = static_cast<double>(c.rate_inverse_scale);
  r.dof = static_cast<double>(c.extent_dof);
  r.scale = eigen(c.extent_scale);
  return r;
}
inline Component<double> component_of(const Reference& r) {
  Component<double> c;
  c.position_m = vector_of(r.mean.head<2>());
  c.velocity_mps = vector_of(r.mean.tail<2>());
  c.position_covariance = symmetric_of(r.covariance.topLeftCorner<2, 2>());
  c.position_velocity_covariance = matrix_of(r.covariance.topRightCorner<2, 2>());
  c.velocity_covariance = symmetric_of(r.covariance.bottomRightCorner<2, 2>());
  c.rate_shape = r.rate_shape;
  c.rate_inverse_scale = r.rate_inverse_scale;
  c.extent_dof = r.dof;
  c.extent_scale = symmetric_of(r.scale);
  return c;
}
/// Errors of all parts relative to their size; of the mean relative to its deviations.
inline void expect_equal(const Reference& value, const Reference& expected, double tolerance) {
  const Eigen::Vector4d std = expected.covariance.diagonal().cwiseSqrt();
  EXPECT_LT((value.mean - expected.mean).cwiseQuotient(std).norm(), tolerance) << value.mean.transpose();
  EXPECT_LT(
      (std.cwiseInverse().asDiagonal() * (value.covariance - expected.covariance) * std.cwiseInverse().asDiagonal())
          .norm(),
      tolerance);
  EXPECT_NEAR(value.rate_shape, expected.rate_shape, tolerance * expected.rate_shape);
  EXPECT_NEAR(value.rate_inverse_scale, expected.rate_inverse_scale, tolerance * expected.rate_inverse_scale);
  EXPECT_NEAR(value.dof, expected.dof, tolerance * expected.dof);
  EXPECT_LT(relative_error(value.scale, expected.scale), tolerance);
}

/// The textbook's matrices of white acceleration, and the forgetting of Granström and Orguner 2012.
inline void predict_reference(Reference& r, const MotionParameters& motion, double t) {
  Eigen::Matrix4d f = Eigen::Matrix4d::Identity(), q = Eigen::Matrix4d::Zero();
  f.topRightCorner<2, 2>() = t * Eigen::Matrix2d::Identity();
  q.topLeftCorner<2, 2>().diagonal().setConstant(t * t * t / 3.0);
  q.topRightCorner<2, 2>().diagonal().setConstant(t * t / 2.0);
  q.bottomLeftCorner<2, 2>().diagonal().setConstant(t * t / 2.0);
  q.bottomRightCorner<2, 2>().diagonal().setConstant(t);
  r.mean = f * r.mean;
  r.covariance = (f * r.covariance * f.transpose()).eval();
  if (t <= 0.0) return;
  r.covariance += motion.acceleration_density * q;
  const double mean_rate = r.rate_shape / r.rate_inverse_scale;
  r.rate_shape = std::max(motion.rate_min_shape, r.rate_shape * std::exp(-t / motion.rate_memory_s));
  r.rate_inverse_scale = r.rate_shape / mean_rate;
  const Eigen::Matrix2d extent = r.extent();
  r.dof = std::max(motion.extent_min_dof, 6.0 + (r.dof - 6.0) * std::exp(-t / motion.extent_memory_s));
  r.scale = (r.dof - 6.0) * extent;
}

inline double log_gamma2(double a) {
  return 0.5 * std::log(std::numbers::pi) + std::lgamma(a) + std::lgamma(a - 0.5);
}
/// log ∫ Gamma(γ; α, β) exp(−γ e) (γ e)^n dγ: n measurements of a Poisson number, as a set.
inline double log_count_reference(const Reference& r, double exposure, double n) {
  return std::lgamma(r.rate_shape + n) - std::lgamma(r.rate_shape) + r.rate_shape * std::log(r.rate_inverse_scale) -
         (r.rate_shape + n) * std::log(r.rate_inverse_scale + exposure) + n * std::log(exposure);
}
inline double log_gaussian(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const Eigen::MatrixXd l = llt.matrixL();
  return -0.5 * static_cast<double>(error.size()) * std::log(2.0 * std::numbers::pi) -
         l.diagonal().array().log().sum() - 0.5 * error.dot(llt.solve(error));
}

struct Sums {
  double n = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  Eigen::MatrixX2d sights;
  Eigen::VectorXd rates;
};
inline Sums sums_of(std::span<const Measurement<double>> z) {
  Sums s;
  s.n = static_cast<double>(z.size());
  s.sights.resize(static_cast<Eigen::Index>(z.size()), 2);
  s.rates.resize(static_cast<Eigen::Index>(z.size()));
  for (std::size_t i = 0; i < z.size(); ++i) {
    s.mean += eigen(z[i].position_m) / s.n;
    s.sights.row(static_cast<Eigen::Index>(i)) = eigen(z[i].sight).transpose();
    s.rates(static_cast<Eigen::Index>(i)) = z[i].range_rate_mps;
  }
  for (const auto& m : z) s.scatter += (eigen(m.position_m) - s.mean) * (eigen(m.position_m) - s.mean).transpose();
  return s;
}

/// log of P_D p(Z) over clutter, from the formulas of Granström, Fatemi and Svensson 2020, table I. The same three
/// approximations are made: E[X] for X in S = P + R/n, X^½ S^−½ for the innovation's part of the extent, and the range
/// rates see the velocity that is left after a position update with that S.
inline double log_likelihood_reference(const Reference& r, const View<double>& view,
                                       std::span<const Measurement<double>> z) {
  const Sums s = sums_of(z);
  const double n = s.n;
  const Eigen::Matrix2d x = r.extent(), noise = view.spread * x + eigen(view.noise_m2);
  const Eigen::Matrix2d innovation_covariance = r.covariance.topLeftCorner<2, 2>() + noise / n;
  const Eigen::Matrix2d b = symmetric_root(x) * symmetric_root(noise).inverse();
  const Eigen::Vector2d e = s.mean - r.mean.head<2>();
  const Eigen::Vector2d root_e = symmetric_root(x) * (symmetric_root(innovation_covariance).inverse() * e);
  const Eigen::Matrix2d posterior = r.scale + b * s.scatter * b.transpose() + root_e * root_e.transpose();
  double log_p = std::log(view.detection_probability) + log_count_reference(r, view.exposure, n);
  log_p += -n * std::log(std::numbers::pi) - std::log(n);
  log_p += 0.5 * (r.dof - 3.0) * std::log(r.scale.determinant()) -
           0.5 * (r.dof + n - 3.0) * std::log(posterior.determinant());
  log_p += log_gamma2(0.5 * (r.dof + n - 3.0)) - log_gamma2(0.5 * (r.dof - 3.0));
  // |X|^½ |S|^−½ where detections scatter with X; where they scatter with R, each is scaled by |X|^½ |R|^−½ before.
  log_p += 0.5 * n * std::log(x.determinant() / noise.determinant()) +
           0.5 * std::log(noise.determinant() / innovation_covariance.determinant());
  if (view.range_rate_variance > 0.0) {
    const Eigen::Matrix2d gain = r.covariance.bottomLeftCorner<2, 2>() * innovation_covariance.inverse();
    const Eigen::Vector2d velocity = r.mean.tail<2>() + gain * e;
    const Eigen::Matrix2d c = r.covariance.bottomRightCorner<2, 2>() - gain * innovation_covariance * gain.transpose();
    const Eigen::Index size = s.rates.size();
    log_p +=
        log_gaussian(s.rates - s.sights * velocity,
                     s.sights * (c + eigen(view.turn_mps) * eigen(view.turn_mps).transpose()) * s.sights.transpose() +
                         view.range_rate_variance * Eigen::MatrixXd::Identity(size, size));
  }
  for (const auto& m : z) log_p -= m.log_clutter;
  return log_p;
}

/// Kalman update with all positions and range rates stacked into one vector, Joseph form; extent and rate as in
/// Granström, Fatemi and Svensson 2020, with E[X] for X and X^½ S^−½ there, too.
inline Reference updated_reference(const Reference& prior, const View<double>& view,
                                   std::span<const Measurement<double>> z) {
  const Sums s = sums_of(z);
  const auto n = static_cast<Eigen::Index>(z.size());
  const bool has_rates = view.range_rate_variance > 0.0;
  const Eigen::Index size = has_rates ? 3 * n : 2 * n;
  const Eigen::Matrix2d x = prior.extent();
  const Eigen::Matrix2d held = view.held * view.spread * x + eigen(view.noise_m2);
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size, 4), noise = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd error(size);
  for (Eigen::Index i = 0; i < n; ++i) {
    h.block<2, 2>(2 * i, 0).setIdentity();
    noise.block<2, 2>(2 * i, 2 * i) = held;
    error.segment<2>(2 * i) = eigen(z[static_cast<std::size_t>(i)].position_m) - prior.mean.head<2>();
    if (!has_rates) continue;
    h.block<1, 2>(2 * n + i, 2) = s.sights.row(i);
    noise(2 * n + i, 2 * n + i) = view.range_rate_variance;
    error(2 * n + i) = s.rates(i) - s.sights.row(i) * prior.mean.tail<2>();
  }
  // The turn rate is one number for all range rates.
  if (has_rates) {
    const Eigen::VectorXd turn = s.sights * eigen(view.turn_mps);
    noise.bottomRightCorner(n, n) += turn * turn.transpose();
  }
  Reference out = prior;
  const Eigen::MatrixXd innovation_covariance = h * prior.covariance * h.transpose() + noise;
  const Eigen::MatrixXd gain = innovation_covariance.ldlt().solve(h * prior.covariance).transpose();
  const Eigen::Matrix4d keep = Eigen::Matrix4d::Identity() - gain * h;
  out.mean += gain * error;
  out.covariance = keep * prior.covariance * keep.transpose() + gain * noise * gain.transpose();

  const Eigen::Matrix2d single = view.spread * x + eigen(view.noise_m2);
  const Eigen::Matrix2d b = symmetric_root(x) * symmetric_root(single).inverse();
  const Eigen::Matrix2d of_mean = prior.covariance.topLeftCorner<2, 2>() + held / s.n;
  const Eigen::Vector2d root_e =
      symmetric_root(x) * (symmetric_root(of_mean).inverse() * (s.mean - prior.mean.head<2>()));
  out.scale += b * s.scatter * b.transpose() + root_e * root_e.transpose();
  out.dof += s.n;
  out.rate_shape += s.n;
  out.rate_inverse_scale += view.exposure;
  return out;
}

inline Reference random_object(Random& random) {
  Reference r;
  r.mean << uniform(random, 5.0, 60.0), uniform(random, -30.0, 30.0), uniform(random, -20.0, 20.0),
      uniform(random, -10.0, 10.0);
  r.covariance = random_positive<4>(random, uniform(random, 0.2, 4.0));
  r.rate_shape = uniform(random, 2.0, 40.0);
  r.rate_inverse_scale = r.rate_shape / uniform(random, 2.0, 12.0);
  r.dof = uniform(random, 8.0, 60.0);
  r.scale = (r.dof - 6.0) * random_positive<2>(random, uniform(random, 0.5, 6.0));
  return r;
}
inline View<double> random_view(Random& random, bool has_range_rates) {
  View<double> v;
  v.detection_probability = uniform(random, 0.3, 0.99);
  v.exposure = uniform(random, 0.4, 2.5);
  v.noise_m2 = symmetric_of(random_positive<2>(random, 0.2));
  v.range_rate_variance = has_range_rates ? uniform(random, 0.01, 0.3) : 0.0;
  v.spread = uniform(random, 0.2, 1.0);
  return v;
}
/// Seen from the origin; the range rate belongs to the line of sight to the detection itself, as in the model.
inline Measurement<double> detection_at(const Eigen::Vector2d& position_m, const Eigen::Vector2d& velocity_mps,
                                        double range_rate_error_mps, double log_clutter) {
  Measurement<double> z;
  z.position_m = vector_of(position_m);
  z.sight = vector_of(position_m.normalized());
  z.range_rate_mps = position_m.normalized().dot(velocity_mps) + range_rate_error_mps;
  z.log_clutter = log_clutter;
  return z;
}
/// n detections of an object of this place, velocity and extent.
inline Detections draw_detections(Random& random, const Eigen::Vector4d& state, const Eigen::Matrix2d& extent,
                                  const View<double>& view, std::size_t n, double log_clutter) {
  const Eigen::Matrix2d covariance = view.spread * extent + eigen(view.noise_m2);
  const Eigen::Matrix2d root = covariance.llt().matrixL();
  Detections z;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = normal(random), y = normal(random);
    z.push_back(detection_at(state.head<2>() + root * Eigen::Vector2d(x, y), state.tail<2>(),
                             std::sqrt(view.range_rate_variance) * normal(random), log_clutter));
  }
  return z;
}
inline Cell<double> cell_of(std::span<const Measurement<double>> z) {
  Cell<double> cell;
  for (std::size_t i = 0; i < z.size(); ++i) cell.add(z[i], std::uint64_t{1} << (i % 64U));
  return cell;
}

/// The whole scene turned about the sensor.
inline Reference rotated(const Reference& r, double angle_rad) {
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() = rotation(angle_rad);
  Reference out = r;
  out.mean = turn * r.mean;
  out.covariance = turn * r.covariance * turn.transpose();
  out.scale = rotation(angle_rad) * r.scale * rotation(angle_rad).transpose();
  return out;
}
inline View<double> rotated(const View<double>& view, double angle_rad) {
  View<double> out = view;
  out.noise_m2 = symmetric_of(rotation(angle_rad) * eigen(view.noise_m2) * rotation(angle_rad).transpose());
  return out;
}
inline Detections rotated(Detections z, double angle_rad) {
  for (auto& m : z) {
    m.position_m = vector_of(rotation(angle_rad) * eigen(m.position_m));
    m.sight = vector_of(rotation(angle_rad) * eigen(m.sight));
  }
  return z;
}

}  // namespace boresight::tracking::support
