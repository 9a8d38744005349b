#include "services/ghost_filter/core/classify/mirror_trials.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "services/ghost_filter/core/classify/sectors.hpp"
#include "services/ghost_filter/core/density/normal.hpp"
#include "services/ghost_filter/core/mirror/image.hpp"

namespace boresight::ghosts {

namespace {

/// A mirror shows every second image, and hardly ever is there one without a mirror. What hides an image hides it for
/// many scans, so that one that is missing counts for less than its share.
constexpr double kSeen = 1.5, kNotSeen = -0.3;

constexpr double kSureObject = 0.8;                // that the object exists
constexpr double kSurePlace = 0.7, kGap = 0.5;     // that there is something of the mirror; rather nothing
constexpr double kInReach = 0.6;                   // of the farthest detection: images are weak
constexpr double kBefore_m = 2.0;                  // as far before a mirror what is detected of it may be
constexpr double kHides_m = 2.0;                   // beside the way
constexpr double kSlowPlace_mps = 2.0;             // below it an object may be classified as stationary
constexpr double kLeastRate_mps = 0.7;             // and less still is rather that than the image
constexpr double kBeside_m = 3.0, kOff_mps = 1.5;  // of an image
constexpr double kTold = 2.0;                      // standard deviations of its place that must be within that
constexpr double kOfOther_m = 6.0;                 // about a box: what is detected there may be of that object
constexpr double kOfBody_m = 1.0;                  // the same of whose face it is: images lie right behind it

bool hides(const Object& o, const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction, double length_m) {
  const Eigen::Vector2d q = o.position_m - from_m;
  const double along = std::clamp(q.dot(direction), 0.0, length_m);
  return (q - along * direction).squaredNorm() < square(kHides_m);
}

}  // namespace

double mirrors_by_length(double length_m, double age_s) {
  // On simulated drives (seeds 101 and 102 of all scenarios) reflectors showed, of the images looked for: 3 % if under
  // 10 m long, 5 % under 20 m, 25 % under 40 m, 37 % under 75 m, 57 % beyond.
  constexpr double kOfNone = -4.0, kPerMetre = 0.12, kMost = 3.0;
  // What is new may be the first that is seen of something long.
  constexpr double kNew = 2.0, kPerSecond = -5.0;
  return std::max(std::min(kMost, kOfNone + kPerMetre * length_m), kNew + kPerSecond * age_s);
}

void MirrorTrials::begin() {
  farthest_m_.fill(0.0);
  farthest_of_all_m_ = 0.0;
}

void MirrorTrials::saw(const Eigen::Vector2d& direction, double range_m) {
  double& farthest = farthest_m_[sector_of<kSectors>(direction)];
  farthest = std::max(farthest, range_m);
  farthest_of_all_m_ = std::max(farthest_of_all_m_, range_m);
}

MirrorTrials::Outcome MirrorTrials::look_for(const Object& o, const Mirror& mirror, const Scan& scan) const {
  if (!mirror.beam.may_light(o.position_m, o.position_m)) return Outcome::kUnknown;
  const auto image = image_of(mirror, scan.sensor_m, o.position_m);
  if (!image) return Outcome::kUnknown;
  const double far = image->first_m + image->second_m;
  const double there =
      mirror.occupancy == nullptr ? 1.0 : mirror.occupancy->probability(image->arc_m + mirror.arc_shift_m, 0.5);
  if (there < kGap || square(kTold) * o.position_covariance.trace() > square(kBeside_m)) return Outcome::kUnknown;
  // An image that is seen tells from wherever it is; one that is missing, only from where it would be seen. A radar
  // that is crooked turns object, mirror and image alike, but some of them were seen by another one.
  const double variance = square(far * scan.mounting_std_rad) + o.position_covariance.trace();
  bool must_show = there > kSurePlace && far < kInReach * farthest_of_all_m_ &&
                   square(kTold) * variance < square(kBeside_m) &&
                   farthest_m_[sector_of<kSectors>(image->departure)] > image->first_m - kBefore_m;
  const Eigen::Vector2d turn = scan.sensor_m + image->first_m * image->departure;
  const Eigen::Vector2d sight = o.position_m - scan.sensor_m;
  const double direct_m = std::max(0.1, sight.norm());
  const Eigen::Vector2d e = sight / direct_m;
  // Seen by three bounces, and by two.
  struct Place {
    double range_m, rate_mps;
  };
  const double carried = (image->departure - image->arrival).dot(mirror.velocity_mps);
  const std::array<Place, 2> places{
      {{far, image->arrival.dot(o.velocity_mps) + carried},
       {0.5 * (far + direct_m), 0.5 * ((image->arrival + e).dot(o.velocity_mps) + carried +
                                       (image->departure - e).dot(scan.sensor_velocity_mps))}}};
  for (const Place& place : places) {
    if (std::abs(place.rate_mps) < kLeastRate_mps) return Outcome::kUnknown;
    must_show = must_show && std::abs(place.rate_mps) > kSlowPlace_mps;
  }
  const Object* const body = mirror.body == kNobody ? nullptr : &scan.objects[mirror.body];
  for (const Object& other : scan.objects) {
    if (&other == &o || &other == body || other.own || other.weight + other.image < 0.5) continue;
    if (hides(other, scan.sensor_m, image->departure, image->first_m) ||
        hides(other, turn, image->arrival, image->second_m)) {
      return Outcome::kUnknown;
    }
  }
  const std::size_t own = scan.movers->earlier();
  bool is_seen = false;
  for (const Place& place : places) {
    const Eigen::Vector2d p = scan.sensor_m + place.range_m * image->departure;
    for (const Object& other : scan.objects) {
      if (other.weight > 0.5 && is_on(other, p, &other == body ? kOfBody_m : kOfOther_m)) return Outcome::kUnknown;
    }
    scan.movers->near(scan.odometry->point_to_frame(p), [&](const Mover& mover, std::uint32_t number) {
      if (number < own || mover.object != kNobody) return;
      const Eigen::Vector2d beside = scan.odometry->point_to_vehicle(mover.position_m) - p;
      is_seen =
          is_seen || (beside.squaredNorm() < square(kBeside_m) && std::abs(mover.rate_mps - place.rate_mps) < kOff_mps);
    });
  }
  if (is_seen) return Outcome::kSeen;
  return must_show ? Outcome::kNotSeen : Outcome::kUnknown;
}

double MirrorTrials::evidence_of(const Mirror& mirror, const Scan& scan) const {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < scan.objects.size(); ++i) {
    const Object& o = scan.objects[i];
    if (i == mirror.body || o.own || o.weight < kSureObject || o.moving < 1.0) continue;
    const Outcome outcome = look_for(o, mirror, scan);
    if (outcome != Outcome::kUnknown) sum += outcome == Outcome::kSeen ? kSeen : kNotSeen;
  }
  return sum;
}

}  // namespace boresight::ghosts
