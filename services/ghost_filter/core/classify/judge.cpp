#include "services/ghost_filter/core/classify/judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

/// What is crossed by the lines of sight of moving detections is kept for so many crossings in all.
constexpr std::size_t kMostKept = 4 * kMaxDetections;

/// Nearer detections in the same direction, of which something may be the ghost.
constexpr std::size_t kMostFronts = 64;

/// Ways over two mirrors, the least likely ghosts, are what costs most where mirrors are many: so many are followed for
/// a detection, and for all of a scan.
constexpr std::size_t kMostPairs = 32, kMostPairsOfScan = 2048, kMostWallsOfScan = 2048;
constexpr std::size_t kMostWallPairs = 512;

/// Chances that something else was detected at a moving detection's place, moved on, in the scans before: of a vehicle
/// that nothing announces, and of clutter.
constexpr double kCompanyOfNew = 0.8, kCompanyOfClutter = 0.02;

/// Detections of what stands, expected for each m² in a scan: anywhere, for each that was there before, and where
/// enough were for it to be beyond doubt. One is the detection itself.
constexpr double kStillAnywhere = 0.01, kStillForEach = 0.01, kStillKnown = 0.3;
constexpr std::uint32_t kOftenEnough = 30;

/// Images of what is so slow look as if they stood, from many directions; of others only when they cross the line of
/// sight.
constexpr double kSlowObject_mps = 3.0, kLeastSlow = 0.3;

/// What is so much less likely than all else cannot change a verdict.
constexpr double kNegligible = 1e-3;
/// What is so much likelier a ghost than all else is one, by whatever way.
constexpr double kBeyondDoubt = 20.0;
/// What is so much likelier of type 2 than that needs no look whether it is likelier still of type 1, which takes most.
constexpr double kOneTypeOnly = 200.0;

}  // namespace

Judge::Judge(const ClassConfig& config) : config_(config) {
  crossings_.reserve(kMaxReflectorSegments + kMaxObjects);
  likely_.reserve(MirrorFan::kMaxMirrors);
  ways_.reserve(MirrorFan::kMaxMirrors);
  sides_.reserve(MirrorFan::kMaxMirrors);
  walls_.reserve(kMostWallPairs);
  fronts_.reserve(kMostFronts);
  const Strength straight_back = strength_of_ghost(1, 1.0);
  most_of_strength_ = likelihood(straight_back, straight_back.mean_db, kFluctuation_db, config_.strength_doubt);
  kept_crossings_.reserve(kMostKept);
  kept_.reserve(kMaxDetections);
}

void Judge::begin(const Surroundings& surroundings) {
  s_ = surroundings;
  fan_.build(s_.mirrors, s_.sensor_m);
  likely_.clear();
  for (const Mirror& mirror : s_.mirrors) {
    if (mirror.existence >= kLeastChance && likely_.size() < likely_.capacity()) likely_.push_back(&mirror);
  }
  std::sort(likely_.begin(), likely_.end(),
            [](const Mirror* a, const Mirror* b) { return a->existence > b->existence; });
  ways_.clear();
  for (const Mirror* mirror : likely_) ways_.emplace_back(*mirror, s_.sensor_m);
  walls_are_found_ = false;
  crossings_.clear();
  kept_crossings_.clear();
  kept_.clear();
  next_kept_ = 0;
  pairs_left_of_scan_ = kMostPairsOfScan;
  walls_left_of_scan_ = kMostWallsOfScan;
  has_slow_ = std::any_of(s_.objects.begin(), s_.objects.end(), [](const Object& o) {
    return !o.own && o.weight > kLeastSlow && o.velocity_mps.squaredNorm() < square(kSlowObject_mps);
  });
  unmoved_ = unheard_ = 0;
  for (const Object& o : s_.objects) {
    if (may_be_unheard(o)) unheard_ |= o.sectors;
    if (!o.own && o.weight > kLeastSlow && !shows_rate(o)) unmoved_ |= o.sectors;
  }
}

double Judge::reach_of_mover(const MovedMover& mover) const {
  return kFarMover * std::sqrt(mover.variance_m2 + square(config_.extent_std_m));
}

double Judge::rate_variance(const Measured& m) const {
  return square(m.rate_std_mps) + square(config_.range_rate_slack_mps);
}

void Judge::cross(const Measured& m, std::uint32_t but_object) {
  crossings_.clear();
  const double farthest_m = m.range_m + 2.0 * m.range_std_m;
  fan_.visit(m.direction, [&](const Mirror& mirror) {
    if (mirror.least_range_m > farthest_m || (mirror.body != kNobody && mirror.body == but_object)) return;
    const auto turn = turn_at(mirror, s_.sensor_m, m.direction, farthest_m, m.azimuth_std_rad);
    if (!turn || crossings_.size() == crossings_.capacity()) return;
    // How far behind the mirror it lies, across it.
    const double sine = -m.direction.dot(turn->normal), cosine = m.direction.dot(left_of(turn->normal));
    const double depth = (m.range_m - turn->distance_m) * sine;
    const double std = std::sqrt(square(sine * m.range_std_m) + square(cosine * m.range_m * m.azimuth_std_rad) +
                                 square(turn->offset_std_m) + square(0.1));
    const Crossing crossing{&mirror, *turn, below(depth / std)};
    // What is not a number is no crossing, and has no place in an order.
    if (crossing.sure() >= 0.0) crossings_.push_back(crossing);
  });
  // The surest ones first: what they explain lets most of the others be left.
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.sure() > b.sure(); });
}

const StationaryGrid::Cell* Judge::known_still(const Measured& m) const {
  if (m.cell == StationaryGrid::kUnclaimed) return nullptr;
  const StationaryGrid::Cell& cell = s_.stationary->cells()[m.cell];
  return cell.count < 3 ? nullptr : &cell;  // one is it itself
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

double Judge::moves(const Measured& m) const {
  // Beyond that nothing stands, and nobody needs to ask what was detected there before.
  constexpr double kSurely = 12.0;  // standard deviations
  if (std::abs(m.rate_mps) > kSurely * m.still_std_mps) return 1.0;
  const double moving =
      config_.new_object_density * likelihood(kNewStrength, m.rcs_dbsm - kUsualRcs_dbsm, 0.0, config_.strength_doubt);
  const StationaryGrid::Cell* const cell = known_still(m);
  return moving / (moving + of_stationary(m, cell == nullptr ? 1 : cell->count));
}

double Judge::behind_mirror(const Measured& m, std::uint32_t index) {
  cross(m, kNobody);
  if (kept_.size() < kept_.capacity() && kept_crossings_.size() + crossings_.size() <= kept_crossings_.capacity()) {
    kept_crossings_.insert(kept_crossings_.end(), crossings_.begin(), crossings_.end());
    kept_.push_back({index, static_cast<std::uint32_t>(kept_crossings_.size())});
  }
  double most = 0.0;
  for (const Crossing& crossing : crossings_) {
    if (crossing.turn.distance_m < m.range_m - config_.margin_m) most = std::max(most, crossing.turn.probability);
  }
  return most;
}

void Judge::cross_again(const Measured& m, std::uint32_t index) {
  // They come in the order in which they were asked for first.
  if (next_kept_ == kept_.size() || kept_[next_kept_].index != index) return cross(m, kNobody);
  const std::uint32_t begin = next_kept_ == 0 ? 0 : kept_[next_kept_ - 1].end;
  crossings_.assign(kept_crossings_.begin() + begin, kept_crossings_.begin() + kept_[next_kept_].end);
  ++next_kept_;
}

Densities Judge::weigh(const Measured& m, std::uint32_t index) {
  Densities densities;
  cross_again(m, index);
  bool is_hidden = false;
  const double of_hidden = hidden(m, kNobody, is_hidden);
  real(m, index, is_hidden, densities);
  const double rest = densities.sum();
  ghosts(m, index, kNobody, {kNegligible * rest, kBeyondDoubt * rest}, densities);
  densities.type1 += of_hidden;
  densities.type2 += densities.of_images;
  return densities;
}

double Judge::images(const Measured& m, std::uint32_t object, double least) {
  Densities densities;
  cross(m, object);
  ghosts(m, kNobody, object, {least, std::numeric_limits<double>::infinity()}, densities);
  bool is_hidden = false;
  return densities.type1 + densities.type2 + hidden(m, object, is_hidden);
}

void Judge::ghosts(const Measured& m, std::uint32_t index, std::uint32_t but_object, const Telling& telling,
                   Densities& densities) {
  const std::size_t most = std::min(kMostPairs, pairs_left_of_scan_);
  pairs_left_ = most;
  for (const Crossing& crossing : crossings_) {
    // By different mirrors a ghost would be elsewhere: one fits, or two found for one that is there. So the best
    // counts.
    const double by_one = type2(m, crossing, index, but_object, std::max(telling.least, kLittle * densities.type2));
    densities.type2 = std::max(densities.type2, by_one);
    if (densities.type2 > telling.enough) break;
    const double by_two =
        type2_of_two(m, crossing, index, but_object, std::max(telling.least, kLittle * densities.type2));
    densities.type2 = std::max(densities.type2, by_one + by_two);
    if (densities.type2 > telling.enough) break;
  }
  pairs_left_of_scan_ -= most - pairs_left_;
  if (densities.type2 > kOneTypeOnly * telling.enough) return;
  // Of what is a ghost beyond doubt only the likelier type matters.
  const double little = densities.type2 > telling.enough ? 1.0 : kLittle;
  densities.type1 = type1(m, index, but_object, std::max(telling.least, little * densities.type2));
  if (but_object == kNobody && densities.type1 + densities.type2 <= telling.enough && is_behind_alongside()) {
    densities.type1 += type1_of_two(m, std::max(telling.least, kLittle * (densities.type1 + densities.type2)));
  }
}

void Judge::real(const Measured& m, std::uint32_t index, bool is_hidden, Densities& densities) const {
  double behind = 0.0;
  for (const Crossing& crossing : crossings_) behind = std::max(behind, crossing.sure());
  of_objects(m, false, densities);
  const Recent recent = of_movers(m, index);
  const double above_db = m.rcs_dbsm - kUsualRcs_dbsm;
  densities.moving += recent.density * (1.0 - 0.7 * behind);
  densities.moving += config_.new_object_density * (recent.in_company ? kCompanyOfNew : 1.0 - kCompanyOfNew) *
                      (1.0 - 0.7 * behind) * (is_hidden ? 0.5 : 1.0) *
                      likelihood(kNewStrength, above_db, 0.0, config_.strength_doubt);
  densities.clutter = config_.clutter_density * (recent.in_company ? kCompanyOfClutter : 1.0 - kCompanyOfClutter) *
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
  // Behind what drives across the line of sight its type-1 ghosts look as if they stood, too.
  const bool behind_unmoved = unmoved_ != 0 && seen < kOftenEnough && (unmoved_ & sectors_about(m.direction, 0.0)) != 0;
  if (like_slow || (std::abs(m.rate_mps) > m.still_std_mps && cell == nullptr)) cross(m, kNobody);
  of_objects(m, true, densities);
  if (densities.likeliest != kNobody && cell != nullptr && !was_before(*cell, m, s_.objects[densities.likeliest]))
    seen = 1;
  if (densities.moving == 0.0 && crossings_.empty() && !like_slow && !behind_unmoved) {
    densities.stationary = 1.0;  // how dense it is tells nothing where nothing else can be
    return densities;
  }
  densities.stationary = of_stationary(m, seen);
  const double least = kNegligible * densities.sum();
  if (like_slow || behind_unmoved) densities.type1 = type1(m, kNobody, kNobody, least);
  // Between two walls it is lit by way of both, too; what is not alongside shows a range rate and seldom such ghosts.
  if (behind_unmoved) densities.type1 += type1_of_two(m, std::max(least, kLittle * densities.type1));
  // The image of a vehicle may look as if it stood, when it crosses the line of sight.
  for (const Crossing& crossing : crossings_) {
    densities.type2 =
        std::max(densities.type2, type2(m, crossing, kNobody, kNobody, std::max(least, kLittle * densities.type2)));
  }
  return densities;
}

}  // namespace boresight::ghosts
