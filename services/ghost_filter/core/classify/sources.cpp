#include "services/ghost_filter/core/classify/sources.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace boresight::ghosts {

namespace {

constexpr double kSigmas = 5.5;       // beyond, a place counts for nothing
constexpr double kMoverSigmas = 4.0;  // the same about what was detected
constexpr double kDrift_mps = 8.0;    // by which a velocity is wrong of which one component is known
constexpr double kBeyond_m = 10.0;    // a mirror may be there beyond its ends
// Rays from the sensor that are no wider find what they may touch by their direction.
constexpr double kSectorMargin_m = 1.2, kSectorMargin_rad = 0.05;
constexpr double kStraight_rad = 0.01;  // a curve that turns less over the way is taken for straight

/// A mirror as the sensor sees it.
struct Seen {
  const Mirror* mirror;
  double arc_m, distance_m, side;
};

/// By a mirror to `goal_m`, about which things lie within `radius_m`: length and arrival, or nothing.
std::optional<std::pair<double, Eigen::Vector2d>> way_by(const Seen& seen, const Eigen::Vector2d& sensor_m,
                                                         const Eigen::Vector2d& goal_m, double radius_m) {
  const Mirror& m = *seen.mirror;
  const double bend = std::abs(m.curve.curvature_per_m);
  const Eigen::Vector2d q = m.curve.local(goal_m);
  double arc = q.x(), distance = q.y();
  const bool bent = bend * (std::abs(q.x()) + std::abs(seen.arc_m)) > kStraight_rad;
  if (bent) {
    // Far round a circle sides and arcs tell little.
    if (bend * q.norm() > 1.0) return std::pair(std::numeric_limits<double>::quiet_NaN(), Eigen::Vector2d(0.0, 0.0));
    arc = m.curve.arc_of_local(q);
    distance = m.curve.distance_of_local(q);
  }
  distance *= seen.side;
  if (distance < -radius_m - 0.5) return std::nullopt;
  distance = std::max(distance, 0.1);
  double turns = seen.arc_m + (arc - seen.arc_m) * seen.distance_m / (seen.distance_m + distance);
  const double slack = kBeyond_m + radius_m + 0.5 * bend * (arc - seen.arc_m) * (arc - seen.arc_m);
  if (turns < m.begin_m - slack || turns > m.end_m + slack) return std::nullopt;
  Eigen::Vector2d point = m.curve.at(turns);
  if (bent) {
    // One step towards where the angles are equal: by Fermat's principle the rest changes the length little.
    const Eigen::Vector2d tangent = m.curve.tangent_at(turns), a = sensor_m - point, b = goal_m - point;
    turns += (tangent.dot(a) * distance + tangent.dot(b) * seen.distance_m) / (seen.distance_m + distance);
    point = m.curve.at(turns);
  }
  const Eigen::Vector2d on = goal_m - point;
  const double last = std::max(0.1, on.norm());
  return std::pair((point - sensor_m).norm() + last, Eigen::Vector2d(on / last));
}

}  // namespace

Sources::Sources() : next_mover_(RecentMovers::kCapacity, kNone), spots_(RecentMovers::kCapacity), cells_(kMax) {
  sources_.reserve(kMax);
  ways_.reserve(kMax * MirrorFan::kMaxMirrors);
}

bool Sources::gather(const RecentMovers& movers, const Odometry& odometry, double extent_std_m, double cell_m) {
  const std::size_t objects = sources_.size();
  cells_.clear();
  for (std::uint32_t i = 0; i < movers.size(); ++i) {
    const Mover& mover = movers[i];
    if (mover.weight < RecentMovers::kLeastWeight) continue;
    const double elapsed_s = static_cast<double>(odometry.now_ns() - mover.time_ns) * 1e-9;
    const Eigen::Vector2d p =
        odometry.point_to_vehicle(mover.position_m + elapsed_s * mover.rate_mps * mover.direction);
    const auto fresh = static_cast<std::uint32_t>(sources_.size());
    // Also after the last one: whether it is new is known only then.
    if (fresh == kMax) return false;
    const std::uint32_t number = cells_.at(geometry::grid_cell(p.x(), p.y(), cell_m), fresh);
    const double drift_m = kDrift_mps * elapsed_s;
    spots_[i] = {p, mover.variance_m2 + drift_m * drift_m};
    const double blur = kMoverSigmas * std::sqrt(spots_[i].variance_m2 + extent_std_m * extent_std_m);
    if (number == fresh) {
      sources_.push_back({p, {1.0, 0.0}, 0.0, 0.0, blur, 0.0});
      first_mover_[number] = kNone;
    } else {
      // The box about all of the cell.
      Source& s = sources_[number];
      const Eigen::Vector2d half(s.half_length_m, s.half_width_m);
      const Eigen::Vector2d low = (s.centre_m - half).cwiseMin(p), high = (s.centre_m + half).cwiseMax(p);
      s.centre_m = 0.5 * (low + high);
      s.half_length_m = 0.5 * (high - low).x();
      s.half_width_m = 0.5 * (high - low).y();
      s.blur_m = std::max(s.blur_m, blur);
    }
    next_mover_[i] = first_mover_[number];
    first_mover_[number] = i;
  }
  for (std::size_t k = objects; k < sources_.size(); ++k) {
    Source& s = sources_[k];
    s.radius_m = std::hypot(s.half_length_m, s.half_width_m) + s.blur_m;
  }
  return true;
}

void Sources::build(std::span<const Mirror> mirrors, std::span<const Object> objects, const RecentMovers& movers,
                    const Odometry& odometry, const Eigen::Vector2d& sensor_m, double extent_std_m,
                    double least_existence) {
  sources_.clear();
  for (const Object& o : objects) {
    const double blur = kSigmas * std::sqrt(std::max(0.0, o.position_covariance.trace()));
    const double half_length = o.half_length_m + kMostLonger_m, half_width = o.half_width_m + kMostWider_m;
    first_mover_[sources_.size()] = kNone;
    sources_.push_back(
        {o.position_m, o.axis, half_length, half_width, blur, std::hypot(half_length, half_width) + blur});
  }
  const std::size_t of_objects = sources_.size();
  for (double cell_m = 4.0; !gather(movers, odometry, extent_std_m, cell_m); cell_m *= 2.0) {
    sources_.resize(of_objects);
  }
  find_sectors(sensor_m);
  find_ways(mirrors.first(std::min(mirrors.size(), MirrorFan::kMaxMirrors)), sensor_m, least_existence);
}

void Sources::find_sectors(const Eigen::Vector2d& sensor_m) {
  in_sector_ = {};
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    const Source& s = sources_[k];
    const Eigen::Vector2d sight = s.centre_m - sensor_m;
    const double distance = sight.norm(), radius = s.radius_m + kSectorMargin_m + kSectorMargin_rad * distance;
    std::size_t first = 0, number = MirrorFan::kSectors;
    if (radius < 0.8 * distance) {
      // Between the tangents to the circle about it.
      const double along = std::sqrt(distance * distance - radius * radius);
      const Eigen::Vector2d left(-sight.y(), sight.x());
      first = MirrorFan::sector_of(along * sight - radius * left);
      const std::size_t last = MirrorFan::sector_of(along * sight + radius * left);
      number = (last + MirrorFan::kSectors - first) % MirrorFan::kSectors + 1;
    }
    for (std::size_t n = 0; n < number; ++n) {
      in_sector_[(first + n) % MirrorFan::kSectors][k / 64] |= std::uint64_t{1} << (k % 64);
    }
  }
}

void Sources::find_ways(std::span<const Mirror> mirrors, const Eigen::Vector2d& sensor_m, double least_existence) {
  std::array<Seen, MirrorFan::kMaxMirrors> seen{};
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    const double distance = mirrors[i].curve.distance(sensor_m);
    seen[i] = {&mirrors[i], mirrors[i].curve.arc(sensor_m), std::abs(distance), distance < 0.0 ? -1.0 : 1.0};
    reached_[i] = {};
  }
  ways_.clear();
  for (std::size_t k = 0; k < sources_.size(); ++k) {
    first_way_[k] = static_cast<std::uint32_t>(ways_.size());
    const Source& s = sources_[k];
    for (std::uint32_t i = 0; i < mirrors.size(); ++i) {
      if (mirrors[i].existence < least_existence) continue;
      const auto way = way_by(seen[i], sensor_m, s.centre_m, s.radius_m);
      if (!way) continue;
      ways_.push_back({i, way->first, way->second});
      reached_[i][k / 64] |= std::uint64_t{1} << (k % 64);
    }
  }
  first_way_[sources_.size()] = static_cast<std::uint32_t>(ways_.size());
}

void Sources::touched(const Ray& ray, std::uint32_t by_mirror, std::vector<Touch>& touches) const {
  touches.clear();
  const Eigen::Vector2d& d = ray.direction;
  const auto look = [&](std::uint32_t k) {
    const Source& s = sources_[k];
    const double x = s.centre_m.x() - ray.from_m.x(), y = s.centre_m.y() - ray.from_m.y();
    const double along = x * d.x() + y * d.y(), across = std::abs(x * d.y() - y * d.x());
    const double margin = kSigmas * (ray.std_m + ray.std_per_m * std::max(0.0, along));
    if (across > s.radius_m + margin || along < -s.radius_m || along - s.radius_m > ray.farthest_m) return;
    const double c = std::abs(s.axis.x() * d.x() + s.axis.y() * d.y());
    const double t = std::abs(s.axis.x() * d.y() - s.axis.y() * d.x());
    if (across > s.half_length_m * t + s.half_width_m * c + s.blur_m + margin) return;
    touches.push_back({k, along, s.half_length_m * c + s.half_width_m * t + s.blur_m});
  };
  const bool of_sensor = by_mirror >= MirrorFan::kMaxMirrors;
  if (of_sensor && (kSigmas * ray.std_m > kSectorMargin_m || kSigmas * ray.std_per_m > kSectorMargin_rad)) {
    for (std::uint32_t k = 0; k < sources_.size(); ++k) look(k);
    return;
  }
  const SourceBits& bits = of_sensor ? in_sector_[MirrorFan::sector_of(d)] : reached_[by_mirror];
  for (std::size_t word = 0; word < kMax / 64; ++word) {
    for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
      look(static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(left)));
    }
  }
}

MirrorBits Sources::ways(const Ray& ray, std::span<const Touch> touches, double length_m, double slack_m,
                         std::uint32_t but_source) const {
  MirrorBits bits{};
  for (const Touch& touch : touches) {
    if (touch.source == but_source) continue;
    const Eigen::Vector2d beside = ray.from_m + touch.along_m * ray.direction - sources_[touch.source].centre_m;
    const double off = beside.norm() + touch.reach_m;
    for (std::uint32_t k = first_way_[touch.source]; k < first_way_[touch.source + 1]; ++k) {
      const Way& way = ways_[k];
      std::uint64_t& word = bits[way.mirror / 64];
      const std::uint64_t bit = std::uint64_t{1} << (way.mirror % 64);
      if ((word & bit) != 0) continue;
      // To first order about the source's centre, and what is left out at most.
      const double there = touch.along_m + way.length_m + way.arrival.dot(beside);
      const double tolerance = (1.0 + ray.direction.dot(way.arrival)) * touch.reach_m + off * off / way.length_m;
      if (!(std::abs(length_m - there) > tolerance + slack_m)) word |= bit;
    }
  }
  return bits;
}

}  // namespace boresight::ghosts
