#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/reflector_map/curve_fit.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kBehind_m = 160.0;  // what lies farther from the vehicle is forgotten
constexpr double kBirthLogOdds = 0.0;
constexpr double kSeenLogOdds = 0.7, kUnseenLogOdds = -0.08;
constexpr double kSurest = 5.0, kDead = -2.0;
constexpr double kGate = 3.0;        // standard deviations
constexpr double kScatter_m = 0.15;  // of a rail's reflections about its middle line

}  // namespace

ReflectorMap::ReflectorMap(const MapConfig& config)
    : config_(config), grid_(config.capacity, config.cell_m), curves_(config), dbscan_(config.capacity) {
  reflectors_.reserve(kMaxReflectorSegments);
  claimed_.reserve(config.capacity);
  free_.reserve(config.capacity);
  sorted_.reserve(config.capacity);
  cluster_begin_.reserve(config.capacity + 2);
}

void ReflectorMap::clear() {
  grid_.clear();
  reflectors_.clear();
  updated_ns_ = 0;
}

void ReflectorMap::update(const Odometry& odometry, double speed_std_mps, double yaw_rate_std_radps) {
  const double elapsed_s = static_cast<double>(odometry.now_ns() - updated_ns_) * 1e-9;
  if (elapsed_s >= 0.0 && elapsed_s < config_.update_period_s) return;
  updated_ns_ = odometry.now_ns();
  grid_.forget(odometry.now_ns() - static_cast<std::int64_t>(config_.memory_s * 1e9));
  predict(std::clamp(elapsed_s, 0.0, 1.0), speed_std_mps, yaw_rate_std_radps, odometry.position_m());
  for (std::uint32_t i = 0; i < reflectors_.size(); ++i) {
    claim(i);
    refine(i);
  }
  drop_dead(odometry.position_m());
  search();
  grid_.settle();
}

void ReflectorMap::predict(double elapsed_s, double speed_std_mps, double yaw_rate_std_radps,
                           const Eigen::Vector2d& vehicle_m) {
  for (Reflector& r : reflectors_) {
    // The origin follows the vehicle, so that the parameters are about what is near.
    const double arc = std::clamp(r.curve.arc(vehicle_m), r.begin_m(), r.end_m());
    if (std::abs(arc) > 5.0) {
      r.curve = r.curve.moved(arc);
      r.arc_shift_m += arc;
      r.covariance = moved_covariance(r.covariance, arc);
    }
    // The frame drifts as the ego motion is wrong: it turns about the vehicle and slides along its way.
    const double distance = (r.curve.origin_m - vehicle_m).norm();
    const double turn = yaw_rate_std_radps * elapsed_s;
    const double slide = speed_std_mps * elapsed_s + turn * distance + 0.02 * elapsed_s;
    r.covariance(0, 0) += slide * slide;
    r.covariance(1, 1) += turn * turn + 1e-6 * elapsed_s;
    r.covariance(2, 2) += 1e-8 * elapsed_s;
  }
}

void ReflectorMap::claim(std::uint32_t index) {
  claimed_.clear();
  Reflector& r = reflectors_[index];
  const std::span<StationaryGrid::Cell> cells = grid_.cells();
  const double step = config_.cell_m;
  const auto look = [&](double arc) {
    const Eigen::Vector2d p = r.curve.at(arc);
    const Eigen::Vector2d tangent = r.curve.tangent_at(arc);
    const Eigen::Vector2d across(-tangent.y(), tangent.x());
    const double variance = r.covariance(0, 0) + arc * (2.0 * r.covariance(0, 1) + arc * r.covariance(1, 1));
    const double gate = config_.tolerance_m + std::min(0.5, kGate * std::sqrt(std::max(0.0, variance)));
    bool any = false;
    for (int k = -1; k <= 1; ++k) {
      const std::uint32_t at = grid_.index_at(p + k * config_.cell_m * across);
      if (at == StationaryGrid::kUnclaimed) continue;
      any = any || cells[at].claimed_by == index;
      if (cells[at].claimed_by != StationaryGrid::kUnclaimed) continue;
      if (std::abs(r.curve.distance(cells[at].mean_m())) > gate) continue;
      cells[at].claimed_by = index;
      claimed_.push_back(at);
      any = true;
    }
    return any;
  };
  const double begin = r.begin_m(), end = r.end_m();
  for (double arc = begin; arc <= end; arc += step) look(arc);
  // And beyond its ends as far as there is something, so that it grows as the vehicle drives along it.
  for (const double sign : {-1.0, 1.0}) {
    double last = sign < 0.0 ? begin : end;
    for (double arc = last + sign * step; std::abs(arc - last) <= config_.max_gap_m; arc += sign * step) {
      if (!look(arc)) continue;
      if (!r.occupancy.extend(arc + r.arc_shift_m)) break;
      last = arc;
    }
  }
}

void ReflectorMap::refine(std::uint32_t index) {
  Reflector& r = reflectors_[index];
  const std::span<const StationaryGrid::Cell> cells = grid_.cells();
  std::size_t fresh = 0;
  double square = 0.0;
  CurveFit fit(r.curve, r.covariance.inverse());
  for (const std::uint32_t at : claimed_) {
    const StationaryGrid::Cell& cell = cells[at];
    if (cell.fresh_count == 0) continue;
    const Eigen::Vector2d p = cell.fresh_mean_m();
    const double noise = cell.fresh_variance_m2 / (static_cast<double>(cell.fresh_count) * cell.fresh_count);
    // Half of the noise is common to what one radar measures in one place: it does not average out.
    fit.add(p, 4.0 * (kScatter_m * kScatter_m + noise));
    const double distance = r.curve.distance(p);
    square += distance * distance;
    r.occupancy.hit(r.curve.arc(p) + r.arc_shift_m);
    r.detections += cell.fresh_count;
    ++fresh;
  }
  r.occupancy.settle();
  if (fresh < 3) {
    r.log_odds += kUnseenLogOdds;
    return;
  }
  r.log_odds = std::min(kSurest, r.log_odds + kSeenLogOdds);
  r.residual_m += 0.1 * (std::sqrt(square / static_cast<double>(fresh)) - r.residual_m);
  const Curve changed = fit.solve();
  if (!changed.origin_m.allFinite() || !changed.tangent.allFinite() ||
      std::abs(changed.curvature_per_m) > config_.max_curvature_per_m) {
    r.log_odds = kDead - 1.0;
    return;
  }
  r.curve = changed;
  r.covariance = fit.covariance();
}

bool ReflectorMap::repeats(const Reflector& a, const Reflector& b) const {
  // The shorter one's ends and middle lie on the longer one.
  const Reflector& longer = a.end_m() - a.begin_m() >= b.end_m() - b.begin_m() ? a : b;
  const Reflector& shorter = &longer == &a ? b : a;
  for (const double share : {0.0, 0.5, 1.0}) {
    const Eigen::Vector2d p = shorter.curve.at(shorter.begin_m() + share * (shorter.end_m() - shorter.begin_m()));
    const double arc = longer.curve.arc(p);
    if (arc < longer.begin_m() - config_.bin_m || arc > longer.end_m() + config_.bin_m) return false;
    if (std::abs(longer.curve.distance(p)) > 2.0 * config_.tolerance_m) return false;
  }
  return true;
}

void ReflectorMap::drop_dead(const Eigen::Vector2d& vehicle_m) {
  for (Reflector& r : reflectors_) {
    const double arc = r.curve.arc(vehicle_m) + r.arc_shift_m;
    r.occupancy.keep(arc - kBehind_m, arc + kBehind_m);
    if (r.occupancy.last() < r.occupancy.first()) r.log_odds = kDead - 1.0;
  }
  for (std::size_t i = 0; i < reflectors_.size(); ++i) {
    for (std::size_t k = i + 1; k < reflectors_.size(); ++k) {
      if (reflectors_[i].log_odds < kDead || reflectors_[k].log_odds < kDead) continue;
      if (!repeats(reflectors_[i], reflectors_[k])) continue;
      const bool first_longer =
          reflectors_[i].end_m() - reflectors_[i].begin_m() >= reflectors_[k].end_m() - reflectors_[k].begin_m();
      reflectors_[first_longer ? k : i].log_odds = kDead - 1.0;
    }
  }
  std::erase_if(reflectors_, [](const Reflector& r) { return r.log_odds < kDead; });
}

void ReflectorMap::search() {
  free_.clear();
  for (const StationaryGrid::Cell& cell : grid_.cells()) {
    if (cell.claimed_by == StationaryGrid::kUnclaimed) free_.push_back(cell.mean_m());
  }
  if (free_.size() < config_.min_cells) return;
  const std::size_t clusters = dbscan_.cluster(free_, config_.cluster_radius_m, config_.cluster_min_cells);
  const auto labels = dbscan_.labels();
  // Counting sort by cluster.
  cluster_begin_.assign(clusters + 1, 0);
  for (const std::int32_t label : labels) {
    if (label >= 0) ++cluster_begin_[static_cast<std::size_t>(label) + 1];
  }
  for (std::size_t c = 1; c <= clusters; ++c) cluster_begin_[c] += cluster_begin_[c - 1];
  sorted_.resize(cluster_begin_[clusters]);
  for (std::size_t i = labels.size(); i-- > 0;) {
    if (labels[i] >= 0) sorted_[--cluster_begin_[static_cast<std::size_t>(labels[i]) + 1]] = free_[i];
  }
  // Each cluster's begin has moved into the next one's slot.
  for (std::size_t c = 0; c < clusters; ++c) {
    const std::size_t begin = cluster_begin_[c + 1];
    const std::size_t end = c + 2 <= clusters ? cluster_begin_[c + 2] : sorted_.size();
    search_part({sorted_.data() + begin, end - begin}, 0);
  }
}

void ReflectorMap::search_part(std::span<Eigen::Vector2d> points, int depth) {
  if (points.size() < config_.min_cells || reflectors_.size() == reflectors_.capacity()) return;
  if (points.size() > CurveSearch::kMaxPoints) {
    // Halved across its longer side: a part is searched at a cost that does not depend on the whole.
    Eigen::Array2d low = points.front(), high = points.front();
    for (const Eigen::Vector2d& p : points) {
      low = low.min(p.array());
      high = high.max(p.array());
    }
    const Eigen::Index axis = (high - low)(0) > (high - low)(1) ? 0 : 1;
    const std::size_t half = points.size() / 2;
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(),
                     [axis](const auto& a, const auto& b) { return a(axis) < b(axis); });
    if (depth < 16) {
      search_part(points.first(half), depth + 1);
      search_part(points.subspan(half), depth + 1);
    }
    return;
  }
  for (int found = 0; found < 4; ++found) {
    std::size_t taken = 0;
    const std::optional<FoundCurve> curve = curves_.find(points, taken);
    if (!curve || reflectors_.size() == reflectors_.capacity()) return;
    take(*curve, points.last(taken));
    points = points.first(points.size() - taken);
  }
}

void ReflectorMap::take(const FoundCurve& found, std::span<const Eigen::Vector2d> points) {
  Reflector r{found.curve, found.covariance, 0.0, {}, kBirthLogOdds, found.residual_m, 0};
  r.occupancy.reset(found.begin_m, found.end_m, config_.bin_m);
  for (const Eigen::Vector2d& p : points) r.occupancy.hit(r.curve.arc(p));
  r.detections = static_cast<std::uint32_t>(points.size());
  r.occupancy.settle();
  reflectors_.push_back(r);
  for (std::size_t i = 0; i + 1 < reflectors_.size(); ++i) {
    if (!repeats(reflectors_[i], reflectors_.back())) continue;
    reflectors_.pop_back();
    return;
  }
}

}  // namespace boresight::ghosts
