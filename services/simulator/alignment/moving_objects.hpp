// Moving objects of the alignment drive: the outliers that stay together from scan to scan.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "services/simulator/alignment/reflection_draws.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

/// First-order Gauss–Markov process of mean 0, sampled once a scan.
class Wander {
 public:
  Wander(double std, double correlation_s, double period_s, Stream& stream)
      : decay_(std::exp(-period_s / correlation_s)),
        kick_(std * std::sqrt(1.0 - decay_ * decay_)),
        value_(std * stream.gaussian()) {}
  void step(Stream& stream) { value_ = decay_ * value_ + kick_ * stream.gaussian(); }
  [[nodiscard]] double value() const { return value_; }

 private:
  double decay_, kick_, value_;
};

/// A moving object in a radar's field of view. Its reflections share direction, range and velocity, from scan to scan.
struct MovingObject {
  enum class Kind : std::uint8_t { kWithTraffic, kAgainstTraffic, kWalker };
  Kind kind;
  Wander along_mps, across_mps, azimuth_rad, log_range;
  /// To the next scan.
  void step(Stream& stream) {
    along_mps.step(stream);
    across_mps.step(stream);
    azimuth_rad.step(stream);
    log_range.step(stream);
  }
  [[nodiscard]] Eigen::Vector3d velocity_mps(double ego_speed_mps) const {
    switch (kind) {
      case Kind::kWithTraffic:
        return {ego_speed_mps + along_mps.value(), 0.0, 0.0};
      case Kind::kAgainstTraffic:
        return {-0.9 * ego_speed_mps + along_mps.value(), 0.0, 0.0};
      case Kind::kWalker:
        break;
    }
    return {along_mps.value(), across_mps.value(), 0.0};
  }
};

/// Share of moving objects among the outliers; the others are ghosts.
inline constexpr double kMovingShare = 0.85;

/// The moving objects in a radar's view, sampled every `period_s`: as many of each kind.
[[nodiscard]] std::vector<MovingObject> make_moving_objects(const View& view, double period_s, Stream& stream);

/// Index of the object of an outlier, 0 ≤ `sort` < kMovingShare. 40 % of the outliers move with the traffic, 25 %
/// against it, 20 % walk.
[[nodiscard]] std::size_t object_of(double sort);

}  // namespace boresight::simulator
