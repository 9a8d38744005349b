#include "tests/benchmarks/realism/statistics/strength.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

/// kStrengthBins for a range beyond all bins.
std::size_t strength_bin(double range_m) {
  const auto above = std::upper_bound(kStrengthEdges_m.begin(), kStrengthEdges_m.end(), range_m);
  return above == kStrengthEdges_m.begin() ? kStrengthBins
                                           : static_cast<std::size_t>(above - kStrengthEdges_m.begin()) - 1;
}

bool is_within(float range_m, double from_m, double to_m) {
  return static_cast<double>(range_m) >= from_m && static_cast<double>(range_m) < to_m;
}

}  // namespace

void Strength::add(const ObservedScan& scan) {
  for (const ObservedDetection& d : scan.detections) {
    const Value value{static_cast<float>(d.range_m), static_cast<float>(d.rcs_dbsm), d.is_valid};
    if (d.is_false_mover()) {
      by_sort_[static_cast<std::size_t>(Sort::kFalseMover)].push_back(value);
    } else if (!d.is_of_mover()) {
      by_sort_[static_cast<std::size_t>(Sort::kStationary)].push_back(value);
    } else if (const ObservedObject* const object = scan.object(d.object); object != nullptr) {
      of_user_[static_cast<std::size_t>(object->user)].add(d.rcs_dbsm);
      if (is_moving_vehicle(object->user)) by_sort_[static_cast<std::size_t>(Sort::kVehicle)].push_back(value);
    }
  }
  for (const ObservedObject& object : scan.objects) {
    if (is_moving_vehicle(object.user)) add_vehicle(scan, object);
  }
}

void Strength::add_vehicle(const ObservedScan& scan, const ObservedObject& object) {
  std::vector<double> levels;
  const ObservedDetection* strongest = nullptr;
  for (const ObservedDetection& d : scan.detections) {
    if (!d.is_direct_of(object.id)) continue;
    levels.push_back(d.rcs_dbsm);
    if (strongest == nullptr || d.rcs_dbsm > strongest->rcs_dbsm) strongest = &d;
    if (const std::size_t bin = strength_bin(d.range_m); bin < kStrengthBins) {
      open_[{scan.radar, object.id, bin}].push_back(d.rcs_dbsm);
    }
  }
  if (strongest == nullptr) return;
  in_scan_.add_group(levels);
  strongest_.push_back({object.user, static_cast<float>(strongest->range_m), static_cast<float>(strongest->rcs_dbsm)});
  const auto [last, is_new] = last_.try_emplace({scan.radar, object.id}, Last{scan.number, strongest->rcs_dbsm});
  if (is_new) return;
  // The variance of a group of two is half of the squared difference.
  if (last->second.scan + 1 == scan.number) step_db_.add_group({last->second.rcs_dbsm, strongest->rcs_dbsm});
  last->second = {scan.number, strongest->rcs_dbsm};
}

void Strength::end_drive() {
  for (const auto& [key, levels] : open_) in_bin_[std::get<2>(key)].add_group(levels);
  open_.clear();
  last_.clear();
}

void Strength::merge(const Strength& other) {
  for (std::size_t s = 0; s < kSorts; ++s) {
    by_sort_[s].insert(by_sort_[s].end(), other.by_sort_[s].begin(), other.by_sort_[s].end());
  }
  for (std::size_t u = 0; u < kRoadUsers; ++u) of_user_[u].merge(other.of_user_[u]);
  for (std::size_t b = 0; b < kStrengthBins; ++b) in_bin_[b].merge(other.in_bin_[b]);
  in_scan_.merge(other.in_scan_);
  step_db_.merge(other.step_db_);
  strongest_.insert(strongest_.end(), other.strongest_.begin(), other.strongest_.end());
}

std::vector<float> Strength::values(Sort sort, double from_m, double to_m, bool valid_only) const {
  std::vector<float> found;
  for (const Value& v : by_sort_[static_cast<std::size_t>(sort)]) {
    if (valid_only && !v.is_valid) continue;
    if (is_within(v.range_m, from_m, to_m)) found.push_back(v.rcs_dbsm);
  }
  return found;
}

double Strength::quantile_dbsm(Sort sort, double from_m, double to_m, double share) const {
  return quantile_of(values(sort, from_m, to_m), share);
}

double Strength::vehicle_is_stronger(double from_m, double to_m) const {
  return chance_that_first_exceeds(values(Sort::kVehicle, from_m, to_m), values(Sort::kFalseMover, from_m, to_m));
}

double Strength::valid_vehicle_is_stronger(double from_m, double to_m) const {
  return chance_that_first_exceeds(values(Sort::kVehicle, from_m, to_m, true),
                                   values(Sort::kFalseMover, from_m, to_m, true));
}

double Strength::strongest_median_dbsm(double from_m, double to_m) const {
  Samples levels;
  for (const Strongest& s : strongest_) {
    if (is_within(s.range_m, from_m, to_m)) levels.add(static_cast<double>(s.rcs_dbsm));
  }
  return levels.quantile(0.5);
}

double Strength::percent_strongest_below(RoadUser user, double from_m, double to_m, double limit_dbsm) const {
  Share below;
  for (const Strongest& s : strongest_) {
    if (s.user == user && is_within(s.range_m, from_m, to_m)) below.add(static_cast<double>(s.rcs_dbsm) < limit_dbsm);
  }
  return below.percent();
}

}  // namespace boresight::bench::realism
