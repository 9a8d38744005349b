// Ten million updates in double and in single precision: covariances and extent stay positive definite.
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "services/tracker/core/ggiw/prediction.hpp"

namespace boresight::tracking {
namespace {

/// A fast generator (Knuth's multiplier) with a rough normal distribution: the sum of four uniforms.
class FastRandom {
 public:
  explicit FastRandom(std::uint64_t seed) : state_(seed * 2654435769U + 1U) {}
  double uniform() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 40U) * (1.0 / 16777216.0);
  }
  double between(double from, double to) { return from + (to - from) * uniform(); }
  /// Evenly in the logarithm.
  double size(double from, double to) { return from * std::exp(uniform() * std::log(to / from)); }
  double normal() {
    constexpr double kScale = 1.7320508075688772;
    return kScale * (uniform() + uniform() + uniform() + uniform() - 2.0);
  }

 private:
  std::uint64_t state_;
};

/// The geometry of one track.
struct TrackKind {
  double noise_m, range_rate_std_mps;  ///< the latter 0: no range rates
  double prior_m, prior_mps, extent_m;
  double step_s, acceleration_density, speed_mps;
  bool one_line_of_sight;
  double held;
};
template <typename Real>
TrackKind random_kind(FastRandom& random) {
  // Single precision holds the same kinds within limits: see the tests.
  constexpr bool kIsDouble = sizeof(Real) == sizeof(double);
  TrackKind k{};
  k.noise_m = random.size(kIsDouble ? 1e-4 : 0.02, 2.0);
  k.range_rate_std_mps = random.uniform() < 0.3 ? 0.0 : random.size(kIsDouble ? 1e-3 : 0.03, 1.0);
  k.prior_m = random.size(0.1, kIsDouble ? 1e4 : 50.0);
  k.prior_mps = random.size(0.1, kIsDouble ? 1e3 : 30.0);
  k.extent_m = random.size(kIsDouble ? 1e-3 : 0.1, 10.0);
  k.step_s = random.size(0.005, 1.0);
  k.acceleration_density = random.size(0.01, 20.0);
  k.speed_mps = random.between(0.0, 60.0);
  k.one_line_of_sight = random.uniform() < 0.3;
  k.held = random.uniform() < 0.5 ? 1.0 : random.between(1.0, 5.0);
  return k;
}

template <typename Real>
bool is_positive_definite(const Symmetric2<Real>& s) {
  return std::isfinite(s.xx) && std::isfinite(s.yy) && s.xx > 0 && s.yy > 0 && determinant(s) > 0;
}
/// With the Schur complement of the position block, in double: the test is of the component, not of itself.
template <typename Real>
const char* fault_of(const Component<Real>& c) {
  if (!is_positive_definite(c.position_covariance)) return "covariance of the position";
  if (!is_positive_definite(c.velocity_covariance)) return "covariance of the velocity";
  if (!is_positive_definite(c.extent_scale) || !(c.extent_dof > 6)) return "extent";
  if (!(c.rate_shape > 0) || !(c.rate_inverse_scale > 0) || !std::isfinite(c.rate_shape)) return "rate";
  const auto& p = c.position_covariance;
  const auto& v = c.velocity_covariance;
  const auto& m = c.position_velocity_covariance;
  const Symmetric2<double> place{static_cast<double>(p.xx), static_cast<double>(p.xy), static_cast<double>(p.yy)};
  const Matrix2<double> both{static_cast<double>(m.xx), static_cast<double>(m.yx), static_cast<double>(m.xy),
                             static_cast<double>(m.yy)};  // transposed
  const Symmetric2<double> velocity{static_cast<double>(v.xx), static_cast<double>(v.xy), static_cast<double>(v.yy)};
  const Symmetric2<double> rest = velocity - congruent(both, inverse(place));
  if (!is_positive_definite(rest)) return "joint covariance";
  if (!std::isfinite(c.position_m.x) || !std::isfinite(c.velocity_mps.y)) return "mean";
  return nullptr;
}

template <typename Real>
Symmetric2<Real> round_matrix(double variance) {
  return {static_cast<Real>(variance), 0, static_cast<Real>(variance)};
}

struct SoakResult {
  std::uint64_t updates = 0, faults = 0;
  std::string first;
};

template <typename Real>
SoakResult soak(std::uint64_t updates) {
  constexpr std::uint64_t kShortTrack = 200, kLongTrack = 100'000;
  SoakResult result;
  for (std::uint64_t seed = 1; result.updates < updates; ++seed) {
    FastRandom random(seed);
    const TrackKind kind = random_kind<Real>(random);
    Component<Real> c;
    c.position_covariance = round_matrix<Real>(kind.prior_m * kind.prior_m);
    c.velocity_covariance = round_matrix<Real>(kind.prior_mps * kind.prior_mps);
    c.rate_shape = 10;
    c.rate_inverse_scale = 2;
    c.extent_dof = 12;
    c.extent_scale = round_matrix<Real>(6.0 * kind.extent_m * kind.extent_m);
    c.velocity_mps = {static_cast<Real>(kind.speed_mps), 0};
    MotionParameters motion;
    motion.acceleration_density = kind.acceleration_density;
    View<Real> view;
    view.detection_probability = Real(0.9);
    view.noise_m2 = round_matrix<Real>(kind.noise_m * kind.noise_m);
    view.range_rate_variance = static_cast<Real>(kind.range_rate_std_mps * kind.range_rate_std_mps);
    view.held = static_cast<Real>(kind.held);
    // The object stays near the origin of the local axes, as if they moved with it; its sensor is 30 m away.
    double x = kind.prior_m * random.normal(), y = kind.prior_m * random.normal();
    const double azimuth = random.between(-3.0, 3.0);
    const std::uint64_t length = seed % 50 == 0 ? kLongTrack : kShortTrack;
    for (std::uint64_t scan = 0; scan < length && result.updates < updates; ++scan) {
      const double step_s = kind.step_s * random.between(0.5, 1.5);
      predict(c, motion, step_s);
      x += step_s * kind.speed_mps;
      constexpr double kReach_m = 100.0;
      if (x > kReach_m) {
        x -= 2.0 * kReach_m;
        c.position_m.x -= static_cast<Real>(2.0 * kReach_m);
      }
      Prediction<Real> p(c, view);
      if (random.uniform() < 0.1) {
        c = p.missed_component(c);
        continue;
      }
      Cell<Real> cell;
      const int n = 1 + static_cast<int>(random.uniform() * random.uniform() * 8.0);
      const double reach = kind.noise_m + 0.5 * kind.extent_m;
      for (int i = 0; i < n; ++i) {
        Measurement<Real> z;
        z.position_m = {static_cast<Real>(x + reach * random.normal()), static_cast<Real>(y + reach * random.normal())};
        const double angle = kind.one_line_of_sight ? azimuth : azimuth + 0.05 * random.normal();
        const double cosine = 1.0 - 0.5 * (angle - azimuth) * (angle - azimuth), sine = angle - azimuth;
        const double cos0 = std::cos(azimuth), sin0 = std::sin(azimuth);
        const double ux = cosine * cos0 - sine * sin0, uy = cosine * sin0 + sine * cos0;
        z.sight = {static_cast<Real>(ux), static_cast<Real>(uy)};
        z.range_rate_mps = static_cast<Real>(ux * kind.speed_mps + kind.range_rate_std_mps * random.normal());
        cell.add(z, Real(1));
      }
      const bool is_sampled = scan % 16 == 0;
      const Real log_p = is_sampled ? p.log_likelihood(cell) : Real(0);
      c = p.updated(c, cell);
      ++result.updates;
      const char* fault = std::isfinite(log_p) ? fault_of(c) : "likelihood";
      if (fault == nullptr) continue;
      if (result.faults++ == 0) {
        result.first = std::string(fault) + ", seed " + std::to_string(seed) + ", scan " + std::to_string(scan);
      }
      break;  // the next track
    }
  }
  return result;
}

#ifdef BORESIGHT_SANITIZED
constexpr std::uint64_t kUpdates = 500'000;
#else
constexpr std::uint64_t kUpdates = 10'000'000;
#endif

TEST(ComponentSoak, InDoubleStaysPositiveDefiniteForTenMillionUpdates) {
  const SoakResult result = soak<double>(kUpdates);
  EXPECT_EQ(result.updates, kUpdates);
  EXPECT_EQ(result.faults, 0U) << result.first;
}

TEST(ComponentSoak, InSinglePrecisionStaysPositiveDefiniteForTenMillionUpdates) {
  const SoakResult result = soak<float>(kUpdates);
  EXPECT_EQ(result.updates, kUpdates);
  EXPECT_EQ(result.faults, 0U) << result.first;
}

}  // namespace
}  // namespace boresight::tracking
