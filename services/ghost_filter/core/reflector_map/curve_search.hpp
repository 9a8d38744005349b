// Lines and arcs among points: RANSAC with seeded draws, so that equal input gives equal output.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/ghost_filter/core/reflector_map/config.hpp"
#include "services/ghost_filter/core/reflector_map/curve.hpp"
#include "services/ghost_filter/core/reflector_map/inliers.hpp"

namespace boresight::ghosts {

struct FoundCurve {
  Curve curve;  ///< origin in the middle of its points
  Eigen::Matrix3d covariance;
  double begin_m, end_m;  ///< arc lengths
  double residual_m;      ///< rms
};

class CurveSearch {
 public:
  /// What one search looks at; more points are to be divided by place before, so that the cost grows linearly.
  static constexpr std::size_t kMaxPoints = 192;
  explicit CurveSearch(const MapConfig& config);

  /// The curve on which most points lie, if it fulfils the settings. Its points are moved to the end of `points`, and
  /// their number is in `taken`.
  [[nodiscard]] std::optional<FoundCurve> find(std::span<Eigen::Vector2d> points, std::size_t& taken);

 private:
  [[nodiscard]] std::optional<Curve> draw(std::span<const Eigen::Vector2d> points, bool arc);
  [[nodiscard]] std::size_t random(std::size_t below);
  MapConfig config_;
  std::uint64_t state_ = 0x9E3779B97F4A7C15ULL;
  Inliers<kMaxPoints> inliers_;
  std::vector<double> arcs_m_;
};

}  // namespace boresight::ghosts
