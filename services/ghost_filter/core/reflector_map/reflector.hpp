// A reflector (rail, wall, row of cars) as it is tracked over time: where it runs, how surely it exists, and where
// along it there is something.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflector_map/curve.hpp"
#include "services/ghost_filter/core/reflector_map/curve_fit.hpp"

namespace boresight::ghosts {

/// Where along a reflector something was seen, as log-odds for each stretch of `bin_m`: a gap stays open.
class Occupancy {
 public:
  static constexpr std::int32_t kBins = 128;
  static constexpr std::int32_t kMostBlur = 4;  ///< bins to either side over which a probability is averaged
  void reset(double begin_m, double end_m, double bin_m);
  /// Makes room for a place; false if the reflector would become longer than there are bins.
  bool extend(double arc_m);
  void hit(double arc_m);
  /// Of the bins between those that were hit since the last call, those that were not become less likely.
  void settle();
  /// Takes over what another one that runs along the same line knows of a place; see extend().
  void join(double arc_m, const Occupancy& other, double other_arc_m);
  /// Forgets the bins before and after.
  void keep(double begin_m, double end_m);
  /// Probability that the reflector is there, averaged over ± `std_m` about a place.
  [[nodiscard]] double probability(double arc_m, double std_m) const;
  [[nodiscard]] double begin_m() const { return first_ * bin_m_; }
  [[nodiscard]] double end_m() const { return (last_ + 1) * bin_m_; }
  [[nodiscard]] std::int32_t first() const { return first_; }
  [[nodiscard]] std::int32_t last() const { return last_; }
  [[nodiscard]] bool is_open(std::int32_t bin) const { return log_odds_[index(bin)] < 0.0F; }
  [[nodiscard]] double bin_m() const { return bin_m_; }

 private:
  [[nodiscard]] std::int32_t bin_of(double arc_m) const;
  [[nodiscard]] static std::size_t index(std::int32_t bin) { return static_cast<std::uint32_t>(bin) % kBins; }
  void set(std::int32_t bin, float log_odds);
  double bin_m_ = 1.0;
  std::int32_t first_ = 0, last_ = -1;
  std::array<float, kBins> log_odds_{};
  std::array<float, kBins> probability_{};  // the same, as it is asked for far more often than it changes
  std::array<bool, kBins> hit_{};
};

struct Reflector {
  Curve curve;  ///< in the odometry frame
  Eigen::Matrix3d covariance;
  double arc_shift_m;  ///< arc length of the curve's origin in the occupancy's count
  Occupancy occupancy;
  double log_odds;    ///< that it exists
  double residual_m;  ///< scatter of its detections across it
  std::uint32_t detections;
  std::uint32_t id;  ///< stays the same
  std::int64_t born_ns;
  std::int64_t refined_ns;
  Evidence evidence{};  ///< since then
  [[nodiscard]] double begin_m() const { return occupancy.begin_m() - arc_shift_m; }
  [[nodiscard]] double end_m() const { return occupancy.end_m() - arc_shift_m; }
  [[nodiscard]] double length_m() const { return occupancy.end_m() - occupancy.begin_m(); }
  [[nodiscard]] double existence() const { return 1.0 / (1.0 + std::exp(-log_odds)); }
  /// Of the distance from the curve of a place at that arc length.
  [[nodiscard]] double variance_at(double arc_m) const {
    const Eigen::Vector3d row(1.0, arc_m, 0.5 * arc_m * arc_m);
    return std::max(0.0, row.dot(covariance * row));
  }
};

}  // namespace boresight::ghosts
