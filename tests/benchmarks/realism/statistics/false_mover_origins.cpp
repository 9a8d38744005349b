#include "tests/benchmarks/realism/statistics/false_mover_origins.hpp"

#include <algorithm>
#include <cmath>

#include "tests/benchmarks/realism/statistics/origin_criteria.hpp"

namespace boresight::bench::realism {

namespace {

constexpr double kBesideBehind_rad = 10.0 * M_PI / 180.0;
constexpr std::size_t kBesideBins = 5;  // 0.2 of sin(azimuth)

}  // namespace

void FalseMoverOrigins::add(const ObservedScan& scan) {
  for (const ObservedDetection& d : scan.detections) {
    if (!d.is_false_mover()) continue;
    const bool tracked = is_beside_tracked_object(scan, d), behind = is_behind_object(scan, d, 0.0);
    const bool twice = is_at_twice_the_range(scan, d), rest = is_rest_of_object(scan, d);
    beside_tracked_.add(tracked);
    behind_.add(behind);
    for (const double turn_rad : {-kBesideBehind_rad, kBesideBehind_rad}) {
      beside_behind_.add(is_behind_object(scan, d, turn_rad));
    }
    twice_.add(twice);
    rest_.add(rest);
    none_.add(!tracked && !behind && !twice && !rest && !is_beside_object(scan, d) && !is_doppler_ambiguity(d) &&
              !is_ambiguous_azimuth(scan, d, kSineStep));
    mirror_images_.add(d.provenance == Provenance::kGhostType2);
    for (const ObservedDetection& other : scan.detections) {
      if (!is_at_range_and_rate(other, d)) continue;
      const double distance = std::abs(std::sin(other.azimuth_rad) - std::sin(d.azimuth_rad));
      ++sine_distances_[std::min(static_cast<std::size_t>(distance / kSineBin), kSineBins - 1)];
    }
  }
}

void FalseMoverOrigins::merge(const FalseMoverOrigins& other) {
  for (const auto share : {&FalseMoverOrigins::beside_tracked_, &FalseMoverOrigins::behind_,
                           &FalseMoverOrigins::beside_behind_, &FalseMoverOrigins::twice_, &FalseMoverOrigins::rest_,
                           &FalseMoverOrigins::none_, &FalseMoverOrigins::mirror_images_}) {
    (this->*share).merge(other.*share);
  }
  for (std::size_t i = 0; i < kSineBins; ++i) sine_distances_[i] += other.sine_distances_[i];
}

double FalseMoverOrigins::sine_step() const {
  double most = 0.0, step = kNoFigure;
  for (std::size_t i = 2 * kBesideBins; i + kBesideBins < kSineBins; ++i) {
    const double beside =
        0.5 * static_cast<double>(sine_distances_[i - kBesideBins] + sine_distances_[i + kBesideBins]);
    const double excess = static_cast<double>(sine_distances_[i]) - beside;
    if (excess <= most) continue;
    most = excess;
    step = (static_cast<double>(i) + 0.5) * kSineBin;
  }
  return step;
}

}  // namespace boresight::bench::realism
