#include "services/ghost_filter/core/classify/judge.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

/// Ways over two mirrors, the least likely ghosts, are what costs most where mirrors are many: so many are followed for
/// a detection, and for all of a scan.
constexpr std::size_t kMostPairs = 32, kMostPairsOfScan = 2048;

/// Chances that something else was detected at a moving detection's place, moved on, in the scans before: of a vehicle
/// that nothing announces, and of clutter.
constexpr double kCompanyOfNew = 0.8, kCompanyOfClutter = 0.02;

/// Detections of what stands, expected for each m² in a scan: anywhere, for each that was there before, and where
/// enough were for it to be beyond doubt. One is the detection itself.
constexpr double kStillAnywhere = 0.01, kStillForEach = 0.01, kStillKnown = 0.3;
constexpr std::uint32_t kOftenEnough = 30;

/// Images of what is so slow look as if they stood, from many directions; of others only when they cross the line of
/// sight.
constexpr double kSlow_mps = 3.0, kLeastSlow = 0.3;

/// What is so much less likely than all else cannot change a verdict.
constexpr double kNegligible = 1e-3;

}  // namespace

Judge::Judge(const ClassConfig& config) : config_(config) {
  crossings_.reserve(kMaxReflectorSegments + kMaxObjects);
}

void Judge::begin(const Surroundings& surroundings) {
  s_ = surroundings;
  fan_.build(s_.mirrors, s_.sensor_m);
  crossings_.clear();
  pairs_left_of_scan_ = kMostPairsOfScan;
  has_slow_ = std::any_of(s_.objects.begin(), s_.objects.end(), [](const Object& o) {
    return !o.own && o.weight > kLeastSlow && o.velocity_mps.squaredNorm() < square(kSlow_mps);
  });
}

double Judge::reach_of_mover(const MovedMover& mover) const {
  return kFarMover * std::sqrt(mover.variance_m2 + square(config_.extent_std_m));
}

double Judge::rate_variance(const Measured& m) const {
  return square(m.rate_std_mps) + square(config_.range_rate_slack_mps);
}

void Judge::cross(const Measured& m, std::uint32_t but_object) {
  crossings_.clear();
  fan_.visit(m.direction, [&](const Mirror& mirror) {
    if (mirror.body != kNobody && mirror.body == but_object) return;
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, m.range_m + 2.0 * m.range_std_m, m.azimuth_std_rad);
    if (!turn || crossings_.size() == crossings_.capacity()) return;
    // How far behind the mirror it lies, across it.
    const double sine = -m.direction.dot(turn->normal), cosine = m.direction.dot(left_of(turn->normal));
    const double depth = (m.range_m - turn->distance_m) * sine;
    const double std = std::sqrt(square(sine * m.range_std_m) + square(cosine * m.range_m * m.azimuth_std_rad) +
                                 square(turn->offset_std_m) + square(0.1));
    crossings_.push_back({&mirror, *turn, below(depth / std)});
  });
}

const StationaryGrid::Cell* Judge::known_still(const Measured& m) const {
  const std::uint32_t at = s_.stationary->index_at(s_.odometry->point_to_frame(m.position_m));
  if (at == StationaryGrid::kUnclaimed || s_.stationary->cells()[at].count < 3) return nullptr;  // one is it itself
  return &s_.stationary->cells()[at];
}

bool Judge::was_before(const StationaryGrid::Cell& cell, const Measured& m, const Object& o) const {
  constexpr double kAround_m = 0.5;
  const double elapsed_s = static_cast<double>(s_.odometry->now_ns() - cell.first_ns) * 1e-9;
  return elapsed_s > o.age_s || !is_on(o, m.position_m + elapsed_s * o.velocity_mps, kAround_m);
}

double Judge::of_stationary(const Measured& m, std::uint32_t seen) const {
  // Where it was detected before, what stands is detected again; an image that creeps is detected there for a while,
  // too, so that often tells more than once.
  const double expected = std::clamp(kStillForEach * seen, kStillAnywhere, kStillKnown);
  // The tail of the errors is fatter than Gaussian.
  const double fit =
      0.95 * gaussian(m.rate_mps, square(m.still_std_mps)) + 0.05 * gaussian(m.rate_mps, square(2.5 * m.still_std_mps));
  return expected * fit * likelihood({-5.0, 15.0}, m.rcs_dbsm, 0.0, 0.3);
}

bool Judge::has_company(const Measured& m, std::uint32_t index) const {
  bool found = false;
  const Eigen::Vector2d place = s_.odometry->point_to_frame(m.position_m);
  const std::int64_t now_ns = s_.odometry->now_ns();
  const std::size_t own = s_.movers->earlier();
  s_.movers->near(place, [&](const Mover& mover, std::uint32_t number) {
    if (found || (number >= own && mover.index == index)) return;
    const double elapsed_s = static_cast<double>(now_ns - mover.time_ns) * 1e-9;
    const Eigen::Vector2d moved = mover.position_m + elapsed_s * mover.rate_mps * mover.direction;
    if ((moved - place).squaredNorm() > 9.0) return;
    found = std::abs(mover.rate_mps - m.rate_mps) < 1.5;
  });
  return found;
}

double Judge::behind_mirror(const Measured& m) const {
  double most = 0.0;
  fan_.visit(m.direction, [&](const Mirror& mirror) {
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, m.range_m - config_.margin_m, m.azimuth_std_rad);
    if (turn) most = std::max(most, turn->probability);
  });
  return most;
}

Densities Judge::weigh(const Measured& m, std::uint32_t index) {
  Densities densities;
  cross(m, kNobody);
  bool is_hidden = false;
  const double of_hidden = hidden(m, kNobody, is_hidden);
  real(m, index, is_hidden, densities);
  ghosts(m, index, kNobody, kNegligible * densities.sum(), densities);
  densities.type1 += of_hidden;
  densities.type2 += densities.of_images;
  return densities;
}

double Judge::images(const Measured& m, std::uint32_t object, double least) {
  Densities densities;
  cross(m, object);
  ghosts(m, kNobody, object, least, densities);
  bool is_hidden = false;
  return densities.type1 + densities.type2 + hidden(m, object, is_hidden);
}

void Judge::ghosts(const Measured& m, std::uint32_t index, std::uint32_t but_object, double least,
                   Densities& densities) {
  const std::size_t most = std::min(kMostPairs, pairs_left_of_scan_);
  pairs_left_ = most;
  for (const Crossing& crossing : crossings_) {
    // By different mirrors a ghost would be elsewhere: one fits, or two found for one that is there. So the best
    // counts.
    const double by_one = type2(m, crossing, index, but_object, std::max(least, kLittle * densities.type2));
    const double best = std::max(densities.type2, by_one);
    const double by_two = type2_of_two(m, crossing, index, but_object, std::max(least, kLittle * best));
    densities.type2 = std::max(densities.type2, by_one + by_two);
  }
  pairs_left_of_scan_ -= most - pairs_left_;
  densities.type1 = type1(m, index, but_object, std::max(least, kNegligible * densities.type2));
}

void Judge::real(const Measured& m, std::uint32_t index, bool is_hidden, Densities& densities) const {
  double behind = 0.0;
  for (const Crossing& crossing : crossings_) behind = std::max(behind, crossing.turn.probability * crossing.beyond);
  of_objects(m, false, densities);
  const bool company = has_company(m, index);
  const double above_db = m.rcs_dbsm - kUsualRcs_dbsm;
  densities.moving += of_movers(m, index) * (1.0 - 0.7 * behind);
  densities.moving += config_.new_object_density * (company ? kCompanyOfNew : 1.0 - kCompanyOfNew) *
                      (1.0 - 0.7 * behind) * (is_hidden ? 0.5 : 1.0) *
                      likelihood(kNewStrength, above_db, 0.0, config_.strength_doubt);
  densities.clutter = config_.clutter_density * (company ? kCompanyOfClutter : 1.0 - kCompanyOfClutter) *
                      likelihood(kClutterStrength, above_db, 0.0, config_.strength_doubt);
  const StationaryGrid::Cell* const cell = known_still(m);
  densities.stationary = of_stationary(m, cell == nullptr ? 1 : cell->count);
}

Densities Judge::weigh_still(const Measured& m) {
  Densities densities;
  crossings_.clear();
  // Where something is known to stand, and where it fits what stands best, nothing else needs to be asked for.
  const StationaryGrid::Cell* const cell = known_still(m);
  std::uint32_t seen = cell == nullptr ? 1 : cell->count;
  const bool like_slow = has_slow_ && seen < kOftenEnough;
  if (like_slow || (std::abs(m.rate_mps) > m.still_std_mps && cell == nullptr)) cross(m, kNobody);
  of_objects(m, true, densities);
  if (densities.likeliest != kNobody && cell != nullptr && !was_before(*cell, m, s_.objects[densities.likeliest]))
    seen = 1;
  densities.stationary = of_stationary(m, seen);
  const double least = kNegligible * densities.sum();
  if (like_slow) densities.type1 = type1(m, kNobody, kNobody, least);
  // The image of a vehicle may look as if it stood, when it crosses the line of sight.
  for (const Crossing& crossing : crossings_) {
    densities.type2 =
        std::max(densities.type2, type2(m, crossing, kNobody, kNobody, std::max(least, kLittle * densities.type2)));
  }
  return densities;
}

}  // namespace boresight::ghosts
