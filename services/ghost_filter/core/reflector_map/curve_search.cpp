#include "services/ghost_filter/core/reflector_map/curve_search.hpp"

#include <algorithm>

#include "services/ghost_filter/core/reflector_map/curve_fit.hpp"

namespace boresight::ghosts {

namespace {

constexpr int kDraws = 32;
constexpr int kRounds = 4;  // of fitting and choosing the points anew
constexpr double kShortArc_m = 15.0, kShortArcTurn_rad = 0.12;
constexpr double kScatter_m = 0.15;  // of a rail's reflections about the rail, when nothing better is known

/// Straight unless the points say otherwise.
Eigen::Matrix3d weak_information() {
  return Eigen::Vector3d(1e-4, 1e-4, 1.0 / (0.02 * 0.02)).asDiagonal();
}

}  // namespace

CurveSearch::CurveSearch(const MapConfig& config) : config_(config) {
  arcs_m_.reserve(kMaxPoints);
}

std::size_t CurveSearch::random(std::size_t below) {
  state_ ^= state_ << 13;
  state_ ^= state_ >> 7;
  state_ ^= state_ << 17;
  return static_cast<std::size_t>(state_ % below);
}

std::optional<Curve> CurveSearch::draw(std::span<const Eigen::Vector2d> points, bool arc) {
  const Eigen::Vector2d a = points[random(points.size())], b = points[random(points.size())];
  const Eigen::Vector2d chord = b - a;
  const double length = chord.norm();
  if (length < 2.0) return std::nullopt;
  if (!arc) return Curve{0.5 * (a + b), chord / length, 0.0};
  const Eigen::Vector2d c = points[random(points.size())];
  // The circle through three points: curvature is 4·area / product of the sides.
  const Eigen::Vector2d ac = c - a, bc = c - b;
  const double product = length * ac.norm() * bc.norm();
  const double cross = chord.x() * ac.y() - chord.y() * ac.x();
  if (product < 8.0) return std::nullopt;
  // A third point on the left of a→b means that the arc from a to b bulges to the left, which is bending to the right
  // if it lies between them and to the left if it lies beyond; the signs of the projections tell.
  const double between = ac.dot(bc) < 0.0 ? -1.0 : 1.0;
  const double curvature = 2.0 * between * cross / product;
  if (std::abs(curvature) > config_.max_curvature_per_m || std::abs(curvature) * length > 1.8) return std::nullopt;
  const double turn = -std::asin(0.5 * curvature * length);  // of the tangent at a against the chord
  const Eigen::Vector2d along = chord / length;
  const Eigen::Vector2d left(-along.y(), along.x());
  return Curve{a, std::cos(turn) * along + std::sin(turn) * left, curvature};
}

std::optional<FoundCurve> CurveSearch::find(std::span<Eigen::Vector2d> points, std::size_t& taken) {
  taken = 0;
  if (points.size() > kMaxPoints) points = points.first(kMaxPoints);
  if (points.size() < config_.min_cells) return std::nullopt;
  const auto on = [&](const Curve& curve, const Eigen::Vector2d& p) {
    return curve.is_within(curve.local(p), config_.tolerance_m);
  };
  inliers_.set(points);
  std::optional<Curve> best;
  std::size_t most = config_.min_cells - 1;
  for (int k = 0; k < kDraws; ++k) {
    const std::optional<Curve> candidate = draw(points, k % 2 == 1);
    if (!candidate) continue;
    const std::size_t inliers = inliers_.count(*candidate, config_.tolerance_m);
    if (inliers <= most) continue;
    most = inliers;
    best = candidate;
  }
  if (!best) return std::nullopt;

  FoundCurve found{*best, Eigen::Matrix3d::Zero(), 0.0, 0.0, 0.0};
  for (int round = 0; round < kRounds; ++round) {
    // First of all its points, then of those of its longest stretch without a gap.
    arcs_m_.clear();
    for (const Eigen::Vector2d& p : points) {
      if (on(found.curve, p)) arcs_m_.push_back(found.curve.arc(p));
    }
    if (arcs_m_.size() < config_.min_cells) return std::nullopt;
    std::sort(arcs_m_.begin(), arcs_m_.end());
    double begin = arcs_m_.front(), longest = -1.0;
    for (std::size_t i = 1; i <= arcs_m_.size(); ++i) {
      if (i < arcs_m_.size() && arcs_m_[i] - arcs_m_[i - 1] <= config_.max_gap_m) continue;
      if (arcs_m_[i - 1] - begin > longest) {
        longest = arcs_m_[i - 1] - begin;
        found.begin_m = begin;
        found.end_m = arcs_m_[i - 1];
      }
      if (i < arcs_m_.size()) begin = arcs_m_[i];
    }
    const double middle = 0.5 * (found.begin_m + found.end_m);
    found.curve = found.curve.moved(middle);
    found.begin_m -= middle;
    found.end_m -= middle;
    CurveFit fit(found.curve, weak_information());
    for (const Eigen::Vector2d& p : points) {
      if (!on(found.curve, p)) continue;
      const double arc = found.curve.arc(p);
      if (arc >= found.begin_m && arc <= found.end_m) fit.add(p, kScatter_m * kScatter_m);
    }
    found.curve = fit.solve();
    found.covariance = fit.covariance();
  }
  if (found.end_m - found.begin_m < config_.min_length_m) return std::nullopt;
  const double curvature = std::abs(found.curve.curvature_per_m), length = found.end_m - found.begin_m;
  if (curvature > config_.max_curvature_per_m) return std::nullopt;
  // Through any bush there is some short arc: one that bends must be long.
  if (length < kShortArc_m && curvature * length > kShortArcTurn_rad) return std::nullopt;

  std::size_t near = 0;
  double square = 0.0;
  const auto belongs = [&](const Eigen::Vector2d& p) {
    if (!on(found.curve, p)) return false;
    const double arc = found.curve.arc(p);
    return arc >= found.begin_m - 0.5 && arc <= found.end_m + 0.5;
  };
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = found.curve.local(p);
    if (!found.curve.is_within(q, 4.0 * config_.tolerance_m)) continue;
    const double arc = found.curve.arc_of_local(q), distance = found.curve.distance_of_local(q);
    if (arc < found.begin_m - 0.5 || arc > found.end_m + 0.5) continue;
    ++near;
    if (std::abs(distance) < config_.tolerance_m) square += distance * distance;
  }
  const auto rest = std::partition(points.begin(), points.end(), [&](const auto& p) { return !belongs(p); });
  taken = static_cast<std::size_t>(points.end() - rest);
  if (taken < config_.min_cells) return std::nullopt;
  // Bushes and parked cars have lines through them as well, but most of what is about those lies off them.
  if (static_cast<double>(taken) < config_.min_purity * static_cast<double>(near)) return std::nullopt;
  found.residual_m = std::sqrt(square / static_cast<double>(taken));
  return found;
}

}  // namespace boresight::ghosts
