// Reflectors (rails, walls) tracked over time: where they run, how surely they exist, where along them they are open.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/classified_scan.hpp"
#include "services/common/geometry/dbscan.hpp"
#include "services/ghost_filter/core/reflector_map/config.hpp"
#include "services/ghost_filter/core/reflector_map/curve.hpp"
#include "services/ghost_filter/core/reflector_map/curve_search.hpp"
#include "services/ghost_filter/core/reflector_map/odometry.hpp"
#include "services/ghost_filter/core/reflector_map/stationary_grid.hpp"

namespace boresight::ghosts {

/// Where along a reflector something was seen, as log-odds for each stretch of `bin_m`: a gap stays open.
class Occupancy {
 public:
  static constexpr std::int32_t kBins = 128;
  void reset(double begin_m, double end_m, double bin_m);
  /// Makes room for a place; false if the reflector would become longer than there are bins.
  bool extend(double arc_m);
  void hit(double arc_m);
  /// Of the bins between those that were hit since the last call, those that were not become less likely.
  void settle();
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
  double bin_m_ = 1.0;
  std::int32_t first_ = 0, last_ = -1;
  std::array<float, kBins> log_odds_{};
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
  [[nodiscard]] double begin_m() const { return occupancy.begin_m() - arc_shift_m; }
  [[nodiscard]] double end_m() const { return occupancy.end_m() - arc_shift_m; }
  [[nodiscard]] double existence() const { return 1.0 / (1.0 + std::exp(-log_odds)); }
};

class ReflectorMap {
 public:
  explicit ReflectorMap(const MapConfig& config);

  void clear();
  /// A stationary detection in the odometry frame.
  void add(const Eigen::Vector2d& position_m, double variance_m2, std::int64_t time_ns) {
    grid_.add(position_m, variance_m2, time_ns);
  }
  /// Fits the known reflectors to what is new and searches for further ones, if that is due. The stds are of the ego
  /// motion by which the odometry went on.
  void update(const Odometry& odometry, double speed_std_mps, double yaw_rate_std_radps);

  [[nodiscard]] std::span<const Reflector> reflectors() const { return reflectors_; }
  [[nodiscard]] const StationaryGrid& grid() const { return grid_; }

 private:
  void predict(double elapsed_s, double speed_std_mps, double yaw_rate_std_radps, const Eigen::Vector2d& vehicle_m);
  void claim(std::uint32_t index);
  void refine(std::uint32_t index);
  void search();
  void search_part(std::span<Eigen::Vector2d> points, int depth);
  void take(const FoundCurve& found, std::span<const Eigen::Vector2d> points);
  [[nodiscard]] bool repeats(const Reflector& a, const Reflector& b) const;
  void drop_dead(const Eigen::Vector2d& vehicle_m);
  MapConfig config_;
  StationaryGrid grid_;
  CurveSearch curves_;
  geometry::Dbscan dbscan_;
  std::vector<Reflector> reflectors_;
  std::vector<std::uint32_t> claimed_;
  std::vector<Eigen::Vector2d> free_, sorted_;
  std::vector<std::uint32_t> cluster_begin_;
  std::int64_t updated_ns_ = 0;
};

}  // namespace boresight::ghosts
