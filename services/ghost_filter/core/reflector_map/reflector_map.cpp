#include "services/ghost_filter/core/reflector_map/reflector_map.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/reflector_map/joining.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kBehind_m = 130.0;  // what lies farther from the vehicle is forgotten
constexpr double kBirthLogOdds = 0.0;
constexpr double kSeenLogOdds = 0.7, kUnseenLogOdds = -0.12, kImpureLogOdds = -0.7;
constexpr double kSurestReflector = 5.0, kDead = -2.0;
constexpr double kGate = 3.0;            // standard deviations
constexpr double kMostSlack_m = 0.5;     // by which the gate of an uncertain curve is wider than the tolerance
constexpr double kRailScatter_m = 0.15;  // of a rail's reflections about its middle line
constexpr double kBeside = 4.0;          // what lies off the line, but within so many tolerances, speaks against it
/// Share of the purity of a new reflector that a known one must show.
constexpr double kStillPure = 0.6;
/// Errors of a radar's azimuth in one place, and a post's depth, are common to many detections: they count for less.
constexpr double kInCommon = 4.0;

}  // namespace

ReflectorMap::ReflectorMap(const MapConfig& config)
    : config_(config),
      grid_(config.capacity, config.cell_m),
      curves_(config),
      dbscan_(config.capacity),
      clusters_(config.capacity),
      exact_clusters_(config.capacity) {
  reflectors_.reserve(kMaxReflectorSegments);
  free_.reserve(config.capacity);
  inexact_.reserve(config.capacity);
}

void ReflectorMap::clear() {
  grid_.clear();
  reflectors_.clear();
  index_.clear();
  next_reflector_ = next_tile_ = 0;
  updated_ns_ = indexed_ns_ = 0;
}

Reflector* ReflectorMap::reflector_of(const Eigen::Vector2d& position_m, double variance_m2, double& arc_m) {
  Reflector* best = nullptr;
  double least = config_.tolerance_m + kMostSlack_m;
  index_.visit(position_m, [&](std::uint32_t number) {
    Reflector& r = reflectors_[number];
    const Eigen::Vector2d q = r.curve.local(position_m);
    const double distance = std::abs(r.curve.distance_of_local(q));
    if (distance >= kBeside * config_.tolerance_m) return;
    const double arc = r.curve.arc_of_local(q);
    const double begin = r.begin_m(), end = r.end_m();
    if (arc < begin - config_.max_gap_m || arc > end + config_.max_gap_m) return;
    const bool is_within = arc >= begin && arc <= end;
    const bool is_on = distance <= config_.tolerance_m + std::min(kMostSlack_m, std::sqrt(variance_m2));
    // What is measured too badly to tell whether it lies beside tells nothing of that.
    if (is_within && variance_m2 < config_.tolerance_m * config_.tolerance_m) {
      ++(is_on ? r.evidence.on : r.evidence.beside);
    }
    // An end is continued by what lies on its line as well as it was measured; along it, as well as the line is known.
    if (!is_on &&
        (!is_within || distance > config_.tolerance_m + std::sqrt(variance_m2 + kGate * kGate * r.variance_at(arc)))) {
      return;
    }
    if (distance >= least) return;
    best = &r;
    least = distance;
    arc_m = arc;
  });
  return best;
}

std::uint32_t ReflectorMap::add(const Eigen::Vector2d& position_m, double variance_m2, std::int64_t time_ns,
                                std::uint32_t cell) {
  if (!position_m.allFinite() || !(variance_m2 >= 0.0)) return cell;
  double arc = 0.0;
  Reflector* const r = reflector_of(position_m, variance_m2, arc);
  const bool is_exact = variance_m2 < config_.tolerance_m * config_.tolerance_m;
  if (r != nullptr && r->occupancy.extend(arc + r->arc_shift_m)) {
    const Eigen::Vector2d q = r->curve.local(position_m);
    r->evidence.add_local(q, r->curve.distance_of_local(q),
                          kInCommon * (kRailScatter_m * kRailScatter_m + variance_m2));
    r->occupancy.hit(arc + r->arc_shift_m);
  }
  return grid_.add(position_m, time_ns, r != nullptr, is_exact, cell);
}

void ReflectorMap::update(const Odometry& odometry, double speed_std_mps, double yaw_rate_std_radps) {
  now_ns_ = odometry.now_ns();
  const double elapsed_s = std::clamp(static_cast<double>(now_ns_ - updated_ns_) * 1e-9, 0.0, 1.0);
  updated_ns_ = std::max(updated_ns_, now_ns_);
  refine_due(odometry, elapsed_s, {speed_std_mps, yaw_rate_std_radps});
  visit_tiles(now_ns_, elapsed_s);
  if (!index_is_due_ && static_cast<double>(now_ns_ - indexed_ns_) * 1e-9 < config_.update_period_s) return;
  index_.build(reflectors_, config_.max_gap_m);
  indexed_ns_ = now_ns_;
  index_is_due_ = false;
}

void ReflectorMap::refine_due(const Odometry& odometry, double elapsed_s, const DriftStds& stds) {
  const double share = std::min(1.0, elapsed_s / std::max(1e-3, config_.update_period_s));
  const auto most = static_cast<std::size_t>(std::ceil(share * static_cast<double>(reflectors_.size())));
  for (std::size_t k = 0; k < most && !reflectors_.empty(); ++k) {
    if (next_reflector_ >= reflectors_.size()) next_reflector_ = 0;
    Reflector& r = reflectors_[next_reflector_];
    refine(r, odometry, stds);
    if (r.log_odds >= kDead && !unite(r)) {
      ++next_reflector_;
      continue;
    }
    // The last one takes the place of what is dead, so that it comes next; numbers change.
    std::erase_if(reflectors_, [](const Reflector& each) { return each.log_odds < kDead; });
    index_.clear();
    index_is_due_ = true;
  }
}

void ReflectorMap::refine(Reflector& r, const Odometry& odometry, const DriftStds& stds) {
  const double elapsed_s = std::clamp(static_cast<double>(now_ns_ - r.refined_ns) * 1e-9, 0.0, 1.0);
  r.refined_ns = now_ns_;
  // The frame drifts as the ego motion is wrong: it turns about the vehicle and slides along its way.
  const double distance = (r.curve.origin_m - odometry.position_m()).norm();
  const double turn = stds.yaw_rate_radps * elapsed_s;
  const double slide = stds.speed_mps * elapsed_s + turn * distance + 0.02 * elapsed_s;
  r.covariance(0, 0) += slide * slide;
  r.covariance(1, 1) += turn * turn + 1e-6 * elapsed_s;
  r.covariance(2, 2) += 1e-8 * elapsed_s;

  const Evidence evidence = r.evidence;
  r.evidence = {};
  r.detections += evidence.points;
  r.occupancy.settle();
  if (evidence.points < 3) {
    r.log_odds += kUnseenLogOdds;
  } else {
    const bool is_pure = evidence.on >= kStillPure * config_.min_purity * (evidence.on + evidence.beside);
    r.log_odds = std::min(kSurestReflector, r.log_odds + (is_pure ? kSeenLogOdds : kImpureLogOdds));
    r.residual_m += 0.1 * (std::sqrt(evidence.squares_m2 / evidence.points) - r.residual_m);
    CurveFit fit(r.curve, r.covariance.inverse());
    fit.add(evidence);
    r.curve = fit.solve();
    r.covariance = fit.covariance();
  }
  if (!r.curve.origin_m.allFinite() || !r.curve.tangent.allFinite() || !r.covariance.allFinite() ||
      std::abs(r.curve.curvature_per_m) > config_.max_curvature_per_m) {
    r.log_odds = kDead - 1.0;
    return;
  }
  const double beside = r.curve.arc(odometry.position_m());
  r.occupancy.keep(beside + r.arc_shift_m - kBehind_m, beside + r.arc_shift_m + kBehind_m);
  if (r.occupancy.last() < r.occupancy.first()) {
    r.log_odds = kDead - 1.0;
    return;
  }
  // The origin follows the vehicle, so that the parameters are about what is near.
  const double arc = std::clamp(beside, r.begin_m(), r.end_m());
  if (std::abs(arc) > 5.0) {
    r.curve = r.curve.moved(arc);
    r.arc_shift_m += arc;
    r.covariance = moved_covariance(r.covariance, arc);
  }
}

bool ReflectorMap::unite(Reflector& r) {
  for (Reflector& other : reflectors_) {
    if (&other == &r || other.log_odds < kDead) continue;
    Reflector& longer = other.length_m() > r.length_m() ? other : r;
    Reflector& shorter = &longer == &r ? other : r;
    if (!runs_along(longer, shorter, config_) || !join(longer, shorter)) continue;
    shorter.log_odds = kDead - 1.0;
    return true;
  }
  return false;
}

void ReflectorMap::visit_tiles(std::int64_t now_ns, double elapsed_s) {
  const double share = std::min(1.0, elapsed_s / std::max(1e-3, config_.search_period_s));
  const auto most = static_cast<std::size_t>(std::ceil(share * static_cast<double>(grid_.tiles().size())));
  const std::int64_t oldest_ns = now_ns - static_cast<std::int64_t>(config_.memory_s * 1e9);
  for (std::size_t k = 0; k < most && !grid_.tiles().empty(); ++k) {
    if (next_tile_ >= grid_.tiles().size()) next_tile_ = 0;
    if (!grid_.forget(next_tile_, oldest_ns)) continue;
    StationaryGrid::Tile& tile = grid_.tiles()[next_tile_++];
    // As long as little is new, what was not found will not be found.
    if (tile.news == 0 || 8 * tile.news < tile.cells) continue;
    tile.news = 0;
    search(tile);
  }
}

void ReflectorMap::search(const StationaryGrid::Tile& tile) {
  // What is found must have room. In a large map there is none for most of the time, and the clusters, which were for
  // nothing then, cost most of a search.
  if (reflectors_.size() == reflectors_.capacity()) return;
  // With a margin, so that what stands across a border is seen whole.
  constexpr std::int32_t kTile = StationaryGrid::kTileCells, kMargin = kTile / 4;
  const geometry::GridCell first{tile.place.column * kTile - kMargin, tile.place.row * kTile - kMargin};
  const geometry::GridCell last{first.column + kTile + 2 * kMargin - 1, first.row + kTile + 2 * kMargin - 1};
  free_.clear();
  inexact_.clear();
  for (std::int32_t column = tile.place.column - 1; column <= tile.place.column + 1; ++column) {
    for (std::int32_t row = tile.place.row - 1; row <= tile.place.row + 1; ++row) {
      grid_.visit_unclaimed({column, row}, first, last, [&](const Eigen::Vector2d& mean_m, bool is_exact) {
        (is_exact ? free_ : inexact_).push_back(mean_m);
      });
    }
  }
  const std::size_t exact = free_.size();
  free_.insert(free_.end(), inexact_.begin(), inexact_.end());
  points_searched_ += free_.size();
  if (free_.size() < config_.min_cells) return;
  const std::size_t clusters = dbscan_.cluster(free_, config_.cluster_radius_m, config_.cluster_min_cells);
  clusters_.sort(free_, dbscan_.labels(), clusters);
  exact_clusters_.sort(free_, dbscan_.labels().first(exact), clusters);
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    // From afar a rail is a cloud, in which there are lines of all directions: where enough is known well, the rest
    // tells nothing.
    search_part(exact_clusters_[c].size() >= config_.min_cells ? exact_clusters_[c] : clusters_[c], 0);
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
  Reflector r{.curve = found.curve,
              .covariance = found.covariance,
              .arc_shift_m = 0.0,
              .occupancy = {},
              .log_odds = kBirthLogOdds,
              .residual_m = found.residual_m,
              .detections = static_cast<std::uint32_t>(points.size()),
              .id = ++births_,
              .born_ns = now_ns_,
              .refined_ns = now_ns_};
  r.occupancy.reset(found.begin_m, found.end_m, config_.bin_m);
  for (const Eigen::Vector2d& p : points) {
    r.occupancy.hit(r.curve.arc(p));
    grid_.claim(p);
  }
  r.occupancy.settle();
  reflectors_.push_back(r);
  if (!unite(reflectors_.back())) {
    index_.add(r, static_cast<std::uint32_t>(reflectors_.size() - 1), config_.max_gap_m);
    return;
  }
  std::erase_if(reflectors_, [](const Reflector& each) { return each.log_odds < kDead; });
  index_.clear();
  index_is_due_ = true;
}

}  // namespace boresight::ghosts
