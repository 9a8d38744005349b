#include "tests/benchmarks/realism/statistics/rigid_deviations.hpp"

#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kWronglyResolved_mps = 20.0;  // beyond: Doppler ambiguity, a row of section 6
constexpr double kLargeDeviation_mps = 1.0, kSmallDeviation_mps = 0.5;
constexpr double kLeastRadial_mps = 1.0;  // of a body, for a ratio

}  // namespace

void RigidDeviations::add(const ObservedScan& scan) {
  for (const ObservedDetection& d : scan.detections) {
    if (!d.is_of_mover() || std::isnan(d.rigid_deviation_mps)) continue;
    if (std::abs(d.rigid_deviation_mps) > kWronglyResolved_mps) continue;
    const ObservedObject* const object = scan.object(d.object);
    if (object == nullptr) continue;
    all_.push_back({object->user, static_cast<float>(object->aspect_rad), static_cast<float>(d.rigid_deviation_mps),
                    static_cast<float>(d.body_radial_mps)});
  }
}

void RigidDeviations::merge(const RigidDeviations& other) {
  all_.insert(all_.end(), other.all_.begin(), other.all_.end());
}

template <typename Use>
void RigidDeviations::for_each(const DeviationSelection& of, const Use& use) const {
  for (const Deviation& d : all_) {
    const double aspect_rad = static_cast<double>(d.aspect_rad);
    if (d.user != of.user || aspect_rad < of.aspect_from_rad || aspect_rad > of.aspect_to_rad) continue;
    use(static_cast<double>(d.deviation_mps), static_cast<double>(d.body_radial_mps));
  }
}

double RigidDeviations::percent_beyond(const DeviationSelection& of, double limit_mps) const {
  Share beyond;
  for_each(of, [&](double deviation_mps, double) { beyond.add(std::abs(deviation_mps) > limit_mps); });
  return beyond.percent();
}

double RigidDeviations::ratio(const DeviationSelection& of, double share) const {
  Samples ratios;
  for_each(of, [&](double deviation_mps, double radial_mps) {
    if (std::abs(deviation_mps) > kLargeDeviation_mps && std::abs(radial_mps) >= kLeastRadial_mps) {
      ratios.add(deviation_mps / radial_mps);
    }
  });
  return ratios.quantile(share);
}

double RigidDeviations::rest_std_mps(const DeviationSelection& of) const {
  Samples rest;
  for_each(of, [&](double deviation_mps, double) {
    if (std::abs(deviation_mps) <= kSmallDeviation_mps) rest.add(deviation_mps);
  });
  return rest.robust_std();
}

}  // namespace boresight::bench::realism
