#include "services/tracker/core/clusters.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::tracking {

namespace {

/// What the ghost filter is sure of is not told by it with more certainty than this.
constexpr double kLeastReal = 0.01;

double realness_of(const ClassifiedScan& scan, std::size_t i) {
  return std::clamp(1.0 - static_cast<double>(scan.ghost_probability(i)), kLeastReal, 1.0);
}

}  // namespace

Clusterer::Clusterer(const RulesConfig& config) : config_(config), dbscan_(kMaxDetections) {
  points_.reserve(kMaxDetections);
  index_.reserve(kMaxDetections);
  members_.reserve(kMaxDetections);
  whose_.resize(kMaxDetections);
  clusters_.reserve(geometry::Assignment::kCapacity);
}

std::span<const Cluster> Clusterer::find(const ClassifiedScan& scan, std::span<const KnownPlace> known) {
  points_.clear();
  index_.clear();
  clusters_.clear();
  dropped_ = 0;
  const std::size_t count = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  for (std::size_t i = 0; i < count; ++i) {
    if (scan.provenance[i] != Provenance::kMoving) continue;
    const Eigen::Vector2d p(scan.x_vehicle_m[i], scan.y_vehicle_m[i]);
    const bool finite = std::isfinite(scan.range_rate_over_ground_mps[i]) && std::isfinite(scan.range_m[i]) &&
                        std::isfinite(scan.range_std_m[i]) && std::isfinite(scan.azimuth_std_rad[i]) &&
                        std::isfinite(scan.range_rate_std_mps[i]) && std::isfinite(scan.z_vehicle_m[i]) &&
                        std::isfinite(scan.ghost_probability(i));
    if (!p.allFinite() || !finite) continue;
    points_.push_back(p);
    index_.push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t found = dbscan_.cluster(points_, config_.cluster_radius_m, config_.cluster_min_points);
  const auto labels = dbscan_.labels();
  for (std::size_t c = 0; c < found; ++c) {
    members_.clear();
    for (std::size_t k = 0; k < labels.size(); ++k) {
      if (labels[k] == static_cast<std::int32_t>(c)) members_.push_back(static_cast<std::uint32_t>(k));
    }
    part(scan, known);
  }
  return clusters_;
}

Seen Clusterer::seen(const ClassifiedScan& scan, std::uint32_t point) const {
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  const std::size_t i = index_[point];
  return {points_[point],
          (points_[point] - sensor).normalized(),
          static_cast<double>(scan.range_std_m[i]),
          static_cast<double>(scan.range_m[i] * scan.azimuth_std_rad[i]),
          static_cast<double>(scan.range_rate_over_ground_mps[i]),
          static_cast<double>(scan.range_rate_std_mps[i])};
}

void Clusterer::part(const ClassifiedScan& scan, std::span<const KnownPlace> known) {
  const Eigen::Vector2d kUnknown(0.0, 0.0);
  std::span<std::uint32_t> rest = members_;
  std::size_t vehicle = known.size();
  bool are_several = false;
  for (const std::uint32_t k : rest) {
    whose_[k] = owner_of(seen(scan, k), known);
    if (whose_[k] == known.size() || known[whose_[k]].is_small) continue;
    are_several = are_several || (vehicle != known.size() && vehicle != whose_[k]);
    vehicle = whose_[k];
  }
  if (!are_several && vehicle != known.size()) {
    // What is of one vehicle alone is of one thing with what lies at it and is nobody's, but not with the next lane.
    for (const std::uint32_t k : rest) {
      if (whose_[k] != known.size()) continue;
      if (is_beside(seen(scan, k), known[vehicle])) {
        are_several = true;
      } else {
        whose_[k] = vehicle;
      }
    }
  }
  for (std::size_t o = 0; o < known.size() && !rest.empty(); ++o) {
    if (!known[o].is_small && !are_several) continue;
    const auto others = std::partition(rest.begin(), rest.end(), [&](auto k) { return whose_[k] == o; });
    const auto own = static_cast<std::size_t>(others - rest.begin());
    split(scan, rest.first(own), known[o].is_small ? kUnknown : known[o].velocity_mps);
    rest = rest.subspan(own);
  }
  split(scan, rest, are_several || vehicle == known.size() ? kUnknown : known[vehicle].velocity_mps);
}

std::size_t Clusterer::alike(const ClassifiedScan& scan, std::span<std::uint32_t> rest,
                             const Eigen::Vector2d& velocity_mps, double spread_mps) {
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  const auto rate_of = [&](std::uint32_t k) {
    const Eigen::Vector2d sight = points_[k] - sensor;
    return static_cast<double>(scan.range_rate_over_ground_mps[index_[k]]) -
           velocity_mps.dot(sight) / std::max(1e-3, sight.norm());
  };
  // The median range rate is what the body with the most detections does.
  const auto middle = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2);
  std::nth_element(rest.begin(), middle, rest.end(), [&](auto a, auto b) { return rate_of(a) < rate_of(b); });
  const double median = rate_of(*middle);
  const auto others =
      std::partition(rest.begin(), rest.end(), [&](auto k) { return std::abs(rate_of(k) - median) <= spread_mps; });
  return static_cast<std::size_t>(others - rest.begin());
}

void Clusterer::split(const ClassifiedScan& scan, std::span<std::uint32_t> rest, const Eigen::Vector2d& velocity_mps) {
  // Where two vehicles pass each other, one place has two motions; a third and a fourth may be wheels and ghosts.
  constexpr int kMostMotions = 4;
  const Eigen::Vector2d kNone(0.0, 0.0);
  const double spread_mps = config_.cluster_max_range_rate_spread_mps;
  for (int motion = 0; motion < kMostMotions && !rest.empty(); ++motion) {
    std::size_t own = alike(scan, rest, kNone, spread_mps);
    // Alongside, the ends of one body show range rates farther apart than those of two that pass each other. But a
    // velocity that is not known well makes several of one: it counts where it finds more alike.
    if (own < rest.size() && velocity_mps != kNone) {
      const std::size_t with_velocity = alike(scan, rest, velocity_mps, spread_mps);
      own = with_velocity > own ? with_velocity : alike(scan, rest, kNone, spread_mps);
    }
    if (clusters_.size() == clusters_.capacity()) {
      ++dropped_;
    } else {
      add(scan, rest.first(own), velocity_mps);
    }
    rest = rest.subspan(own);
  }
}

void Clusterer::add(const ClassifiedScan& scan, std::span<std::uint32_t> members, const Eigen::Vector2d& velocity_mps) {
  // A body's detections are alike to a tenth of that; where most are, the others are wheels.
  constexpr double kBody_mps = 0.5;
  const std::size_t most = alike(scan, members, velocity_mps, kBody_mps);
  const std::size_t of_body = 2 * most > members.size() ? most : members.size();
  const Eigen::Vector2d sensor(scan.geometry.sensor_position_vehicle_m[0], scan.geometry.sensor_position_vehicle_m[1]);
  Cluster cluster{};
  cluster.position_m.setZero();
  const bool has_rcs = (scan.fields & scan_field::kRcs) != 0;
  cluster.mean_sight.setZero();
  cluster.z_min_m = 1e9;
  cluster.z_max_m = -1e9;
  double range_variance = 0.0, cross_variance = 0.0, rate_variance = 0.0;
  double sum = 0.0, sum_of_body = 0.0, square = 0.0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const std::uint32_t k = members[n];
    const std::size_t i = index_[k];
    const double real = realness_of(scan, i);
    sum += real;
    square += real * real;
    cluster.position_m += real * points_[k];
    const Seen told = seen(scan, k);
    if (n < of_body) {
      sum_of_body += real;
      cluster.mean_sight += real * told.sight;
      cluster.range_rate_over_ground_mps += real * told.rate_mps;
      rate_variance += real * real * told.rate_std_mps * told.rate_std_mps;
    }
    range_variance += real * real * told.range_std_m * told.range_std_m;
    cross_variance += real * real * told.across_std_m * told.across_std_m;
    cluster.z_min_m = std::min(cluster.z_min_m, static_cast<double>(scan.z_vehicle_m[i]));
    cluster.z_max_m = std::max(cluster.z_max_m, static_cast<double>(scan.z_vehicle_m[i]));
    // fmax: the other one where one is no number.
    if (has_rcs) cluster.strongest_dbsm = std::fmax(cluster.strongest_dbsm, static_cast<double>(scan.rcs_dbsm[i]));
    // A ghost beside an object shall not make it longer.
    if (real >= 0.5 && cluster.number_on_outline < cluster.outline.size()) {
      cluster.outline_rate_mps[cluster.number_on_outline] = told.rate_mps;
      cluster.outline_dbsm[cluster.number_on_outline] =
          has_rcs ? static_cast<double>(scan.rcs_dbsm[i]) : std::numeric_limits<double>::quiet_NaN();
      cluster.outline[cluster.number_on_outline++] = points_[k];
    }
    ++cluster.number_of_detections;
  }
  cluster.realness = square / sum;
  cluster.weight = sum;
  cluster.position_m /= sum;
  cluster.mean_sight /= sum_of_body;
  cluster.range_rate_over_ground_mps /= sum_of_body;
  const Eigen::Vector2d sight = cluster.position_m - sensor;
  if (sight.squaredNorm() < 1e-6) return;
  cluster.line_of_sight = sight.normalized();
  const Eigen::Vector2d u = cluster.line_of_sight, v(-u.y(), u.x());
  cluster.covariance_m2 =
      range_variance / (sum * sum) * u * u.transpose() + cross_variance / (sum * sum) * v * v.transpose();
  cluster.range_rate_variance = rate_variance / (sum_of_body * sum_of_body);
  clusters_.push_back(cluster);
}

std::span<const Cluster> Clusterer::join(std::size_t first, std::size_t second) {
  Cluster& into = clusters_[first];
  const Cluster& part = clusters_[second];
  const double weight = into.weight + part.weight, share = part.weight / weight;
  into.position_m += share * (part.position_m - into.position_m);
  into.range_rate_over_ground_mps += share * (part.range_rate_over_ground_mps - into.range_rate_over_ground_mps);
  into.realness += share * (part.realness - into.realness);
  into.mean_sight += share * (part.mean_sight - into.mean_sight);
  into.line_of_sight = (into.line_of_sight + share * (part.line_of_sight - into.line_of_sight)).normalized();
  into.weight = weight;
  into.strongest_dbsm = std::fmax(into.strongest_dbsm, part.strongest_dbsm);
  into.z_min_m = std::min(into.z_min_m, part.z_min_m);
  into.z_max_m = std::max(into.z_max_m, part.z_max_m);
  into.number_of_detections += part.number_of_detections;
  for (std::uint32_t k = 0; k < part.number_on_outline && into.number_on_outline < into.outline.size(); ++k) {
    into.outline_rate_mps[into.number_on_outline] = part.outline_rate_mps[k];
    into.outline_dbsm[into.number_on_outline] = part.outline_dbsm[k];
    into.outline[into.number_on_outline++] = part.outline[k];
  }
  clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(second));
  return clusters_;
}

}  // namespace boresight::tracking
