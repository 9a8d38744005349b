#include "tests/benchmarks/realism/statistics/false_movers.hpp"

#include <algorithm>
#include <cmath>

#include "tests/benchmarks/realism/common/neighbours.hpp"
#include "tests/benchmarks/realism/statistics/origin_criteria.hpp"

namespace boresight::bench::realism {

namespace {

constexpr std::array<double, 3> kBeyond_mps{0.5, 2.0, 5.0};
constexpr double kNearZeroRate_mps = 1.0;
constexpr double kRateSpan_mps = 60.0;  // of the deviations, for the density: fits the printed densities and counts

// The same false mover in the next scan: by range rate and place, moved along the line of sight.
constexpr double kAgain_m = 1.5, kAgainRate_mps = 1.0;

// Azimuth ambiguity by chance: the same search at two other distances of sin(azimuth).
constexpr std::array<double, 2> kSineBeside{0.52, 0.92};

double mean_of(const std::array<Samples, 3>& by_facing) {
  double sum = 0.0, n = 0.0;
  for (const Samples& counts : by_facing) {
    if (counts.size() == 0) continue;
    sum += counts.mean() * static_cast<double>(counts.size());
    n += static_cast<double>(counts.size());
  }
  return n > 0.0 ? sum / n : kNoFigure;
}

double per(std::size_t count, std::size_t scans) {
  return scans > 0 ? static_cast<double>(count) / static_cast<double>(scans) : kNoFigure;
}

}  // namespace

void FalseMovers::add(const ObservedScan& scan) {
  std::vector<ObservedDetection> movers;
  for (const ObservedDetection& d : scan.detections) {
    if (d.is_false_mover()) movers.push_back(d);
  }
  Radar& radar = radars_[scan.radar];
  add_chains(scan, movers, radar);
  add_numbers(scan, movers);
  add_causes(scan, movers);
  if (radar.counts.empty()) radar.first_s = scan.t_s;
  radar.counts.push_back(static_cast<double>(movers.size()));
  radar.last_s = scan.t_s;
}

void FalseMovers::add_numbers(const ObservedScan& scan, const std::vector<ObservedDetection>& movers) {
  ++scans_;
  counts_[static_cast<std::size_t>(scan.facing)].add(static_cast<double>(movers.size()));
  std::size_t near = 0;
  for (const ObservedDetection& d : movers) {
    range_m_.add(d.range_m);
    near_zero_.add(std::abs(d.range_rate_mps) <= kNearZeroRate_mps);
    for (std::size_t b = 0; b < kDeviations; ++b) {
      const double deviation = std::abs(d.deviation_mps);
      in_band_[b] += deviation >= kDeviationEdges_mps[b] && deviation < kDeviationEdges_mps[b + 1] ? 1 : 0;
    }
    const bool counts_near = d.range_m <= kNearRange_m && !d.is_in_box;
    near += counts_near ? 1 : 0;
    near_valid_ += counts_near && d.is_valid ? 1 : 0;
  }
  near_counts_[static_cast<std::size_t>(scan.facing)].add(static_cast<double>(near));
  for (std::size_t r = 0; r < kDensities; ++r) {
    const double to_m = std::min(kDensityEdges_m[r + 1], scan.range_max_m);
    const double from_m = std::min(kDensityEdges_m[r], to_m);
    area_m2_[r] += 0.5 * scan.view_rad * (to_m * to_m - from_m * from_m);
  }
  for (const ObservedDetection& d : scan.detections) {
    if (d.is_of_mover()) continue;
    of_unlabelled_.add(d.is_false_mover());
    for (std::size_t l = 0; l < kBeyond_mps.size(); ++l) beyond_[l] += d.is_false_mover(kBeyond_mps[l]) ? 1 : 0;
    if (!d.is_false_mover(kBeyond_mps[0])) continue;
    for (std::size_t r = 0; r < kDensities; ++r) {
      in_ring_[r] += d.range_m >= kDensityEdges_m[r] && d.range_m < kDensityEdges_m[r + 1] ? 1 : 0;
    }
  }
}

void FalseMovers::add_causes(const ObservedScan& scan, const std::vector<ObservedDetection>& movers) {
  using simulator::Cause;
  for (const ObservedDetection& d : movers) {
    doppler_measured_.add(is_doppler_ambiguity(d));
    doppler_by_truth_.add(d.cause == Cause::kDopplerAmbiguity);
    azimuth_by_truth_.add(d.cause == Cause::kAzimuthAmbiguity);
    azimuth_truth_count_ += d.cause == Cause::kAzimuthAmbiguity ? 1 : 0;
    azimuth_at_step_.add(is_ambiguous_azimuth(scan, d, kSineStep));
    for (const double step : kSineBeside) azimuth_beside_.add(is_ambiguous_azimuth(scan, d, step));
    beside_object_.add(is_beside_object(scan, d));
    valid_[0].add(d.is_valid);
    unambiguous_[0].add(d.is_unambiguous);
    existence_[0].add(d.existence);
  }
  for (const ObservedDetection& d : scan.detections) {
    if (d.is_of_mover()) {
      if (!std::isnan(d.rigid_deviation_mps)) doppler_of_movers_.add(is_ambiguous_width(d.rigid_deviation_mps));
      if (d.is_in_box && std::abs(d.deviation_mps) > kMoving_mps) {
        valid_[1].add(d.is_valid);
        unambiguous_[1].add(d.is_unambiguous);
        existence_[1].add(d.existence);
      }
      continue;
    }
    const bool by_truth = d.cause == Cause::kDopplerAmbiguity;
    if (d.is_stationary() || is_doppler_ambiguity(d)) doppler_of_stationary_.add(is_doppler_ambiguity(d));
    if (d.is_stationary() || by_truth) doppler_of_stationary_truth_.add(by_truth);
  }
}

void FalseMovers::add_chains(const ObservedScan& scan, const std::vector<ObservedDetection>& movers, Radar& radar) {
  const bool is_next = !radar.counts.empty() && scan.number == radar.number + 1;
  const double step_s = scan.t_s - radar.time_s;
  const auto is_again = [&](const ObservedDetection& before, const ObservedDetection& now, double turn_rad) {
    if (std::abs(now.range_rate_mps - before.range_rate_mps) > kAgainRate_mps) return false;
    const Eigen::Vector2d sight = turned_about(before.position_m, scan.sensor_m, turn_rad) - scan.sensor_m;
    const double range_m = sight.norm();
    if (!(range_m > 0.0)) return false;
    // Only the part of the motion over ground that the range rate shows is known.
    const Eigen::Vector2d expected = scan.sensor_m + sight * (1.0 + before.deviation_mps * step_s / range_m);
    return (now.position_m - expected).norm() <= kAgain_m;
  };
  std::vector<Chain> open;
  std::vector<bool> is_taken(movers.size(), false);
  for (const Chain& chain : radar.open) {
    std::size_t next = movers.size();
    bool seen = false;
    for (std::size_t i = 0; i < movers.size() && is_next; ++i) {
      if (!is_again(chain.last, movers[i], 0.0)) continue;
      seen = true;
      if (!is_taken[i] && next == movers.size()) next = i;
    }
    if (is_next) {
      again_.add(seen);
      for (const double turn : kChanceTurns_rad) {
        chance_.add(std::any_of(movers.begin(), movers.end(),
                                [&](const ObservedDetection& d) { return is_again(chain.last, d, turn); }));
      }
    }
    if (next == movers.size()) {
      chain_scans_.add(static_cast<double>(chain.scans));
    } else {
      is_taken[next] = true;
      open.push_back({movers[next], chain.scans + 1});
    }
  }
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (!is_taken[i]) open.push_back({movers[i], 1});
  }
  radar.open = std::move(open);
  radar.number = scan.number;
  radar.time_s = scan.t_s;
}

void FalseMovers::end_drive() {
  for (const auto& [id, radar] : radars_) {
    for (const Chain& chain : radar.open) chain_scans_.add(static_cast<double>(chain.scans));
    const std::size_t n = radar.counts.size();
    if (n < 2) continue;
    const double cycle_s = (radar.last_s - radar.first_s) / static_cast<double>(n - 1);
    for (std::size_t k = 0; k < kLags_s.size(); ++k) {
      const auto lag = static_cast<std::size_t>(std::max(1.0, std::round(kLags_s[k] / cycle_s)));
      correlation_[k].add_series(radar.counts, lag);
    }
    for (std::size_t i = 1; i < n; ++i) {
      const double step = radar.counts[i] - radar.counts[i - 1];
      step_squares_ += 0.5 * step * step;
      step_sum_ += 0.5 * (radar.counts[i] + radar.counts[i - 1]);
    }
  }
  radars_.clear();
}

void FalseMovers::merge(const FalseMovers& other) {
  const auto add_all = [](auto& mine, const auto& its) {
    for (std::size_t i = 0; i < mine.size(); ++i) mine[i] += its[i];
  };
  const auto merge_all = [](auto& mine, const auto& its) {
    for (std::size_t i = 0; i < mine.size(); ++i) mine[i].merge(its[i]);
  };
  merge_all(counts_, other.counts_);
  merge_all(near_counts_, other.near_counts_);
  merge_all(correlation_, other.correlation_);
  merge_all(valid_, other.valid_);
  merge_all(unambiguous_, other.unambiguous_);
  merge_all(existence_, other.existence_);
  add_all(beyond_, other.beyond_);
  add_all(in_ring_, other.in_ring_);
  add_all(area_m2_, other.area_m2_);
  add_all(in_band_, other.in_band_);
  scans_ += other.scans_;
  near_valid_ += other.near_valid_;
  azimuth_truth_count_ += other.azimuth_truth_count_;
  step_squares_ += other.step_squares_;
  step_sum_ += other.step_sum_;
  range_m_.merge(other.range_m_);
  chain_scans_.merge(other.chain_scans_);
  for (const auto share :
       {&FalseMovers::of_unlabelled_, &FalseMovers::near_zero_, &FalseMovers::again_, &FalseMovers::chance_,
        &FalseMovers::doppler_measured_, &FalseMovers::doppler_by_truth_, &FalseMovers::doppler_of_stationary_,
        &FalseMovers::doppler_of_stationary_truth_, &FalseMovers::doppler_of_movers_, &FalseMovers::azimuth_at_step_,
        &FalseMovers::azimuth_beside_, &FalseMovers::azimuth_by_truth_, &FalseMovers::beside_object_}) {
    (this->*share).merge(other.*share);
  }
}

double FalseMovers::per_scan() const {
  return mean_of(counts_);
}
double FalseMovers::near_per_scan() const {
  return mean_of(near_counts_);
}
double FalseMovers::near_valid_per_scan() const {
  return per(near_valid_, scans_);
}
double FalseMovers::per_scan_beyond(std::size_t limit) const {
  return per(beyond_[limit], scans_);
}
double FalseMovers::azimuth_by_truth_per_scan() const {
  return per(azimuth_truth_count_, scans_);
}

double FalseMovers::density_per_m2_mps(std::size_t ring) const {
  return area_m2_[ring] > 0.0 ? static_cast<double>(in_ring_[ring]) / (area_m2_[ring] * kRateSpan_mps) : kNoFigure;
}

double FalseMovers::density_of_view_per_m2_mps() const {
  std::size_t in_view = 0;
  double area_m2 = 0.0;
  for (std::size_t r = 0; r < kDensities; ++r) {
    in_view += in_ring_[r];
    area_m2 += area_m2_[r];
  }
  return area_m2 > 0.0 ? static_cast<double>(in_view) / (area_m2 * kRateSpan_mps) : kNoFigure;
}

double FalseMovers::percent_of_deviation(std::size_t band) const {
  return range_m_.size() == 0 ? kNoFigure
                              : kPercent * static_cast<double>(in_band_[band]) / static_cast<double>(range_m_.size());
}

double FalseMovers::percent_of_chains_single() const {
  Share single;
  for (const float scans : chain_scans_.values()) single.add(scans < 1.5F);
  return single.percent();
}

double FalseMovers::percent_in_chains_of(std::size_t least_scans) const {
  double all = 0.0, within = 0.0;
  for (const float scans : chain_scans_.values()) {
    const double n = static_cast<double>(scans);
    all += n;
    if (n >= static_cast<double>(least_scans)) within += n;
  }
  return all > 0.0 ? kPercent * within / all : kNoFigure;
}

double FalseMovers::percent_azimuth_measured() const {
  return azimuth_at_step_.percent() - azimuth_beside_.percent();
}

double FalseMovers::variance_over_mean() const {
  return step_sum_ > 0.0 ? step_squares_ / step_sum_ : kNoFigure;
}

}  // namespace boresight::bench::realism
