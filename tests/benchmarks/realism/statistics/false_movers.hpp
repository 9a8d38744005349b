// Section 6: false movers, detections that deviate by over 1 m/s and are of no moving object.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

class FalseMovers {
 public:
  /// Edges of the table's deviations: 1–2, 2–5, 5–10, 10–20, 20–36 m/s.
  static constexpr std::array<double, 6> kDeviationEdges_mps{1.0, 2.0, 5.0, 10.0, 20.0, 36.0};
  static constexpr std::size_t kDeviations = kDeviationEdges_mps.size() - 1;
  /// Edges of the densities: 0–10, 10–25, 25–50, 50–100 m.
  static constexpr std::array<double, 5> kDensityEdges_m{0.0, 10.0, 25.0, 50.0, 100.0};
  static constexpr std::size_t kDensities = kDensityEdges_m.size() - 1;
  /// Caesar et al. judge detections within 50 m and outside all boxes.
  static constexpr double kNearRange_m = 50.0;

  void add(const ObservedScan& scan);
  /// Ends a drive: scan numbers begin again.
  void end_drive();
  void merge(const FalseMovers& other);

  [[nodiscard]] double per_scan() const;
  [[nodiscard]] const Samples& per_scan(Facing facing) const { return counts_[static_cast<std::size_t>(facing)]; }
  [[nodiscard]] double near_per_scan() const;
  [[nodiscard]] const Samples& near_per_scan(Facing facing) const {
    return near_counts_[static_cast<std::size_t>(facing)];
  }
  [[nodiscard]] double near_valid_per_scan() const;
  /// Mean number in a scan with a deviation of over 0.5 (0), 2 (1) or 5 (2) m/s.
  [[nodiscard]] double per_scan_beyond(std::size_t limit) const;
  [[nodiscard]] double percent_of_unlabelled() const { return of_unlabelled_.percent(); }
  [[nodiscard]] double density_per_m2_mps(std::size_t ring) const;
  [[nodiscard]] double density_of_view_per_m2_mps() const;
  [[nodiscard]] double percent_of_deviation(std::size_t band) const;
  [[nodiscard]] double percent_near_zero_rate() const { return near_zero_.percent(); }
  [[nodiscard]] const Samples& range_m() const { return range_m_; }

  [[nodiscard]] double seen_again() const { return again_.value(); }
  [[nodiscard]] double seen_again_by_chance() const { return chance_.value(); }
  /// Chains of the same false mover from scan to scan.
  [[nodiscard]] double percent_of_chains_single() const;
  [[nodiscard]] double percent_in_chains_of(std::size_t least_scans) const;

  /// Correlation of the counts of one radar at these times.
  static constexpr std::array<double, 3> kLags_s{0.0, 1.0, 3.0};  // 0: from scan to scan
  [[nodiscard]] double correlation(std::size_t lag) const { return correlation_[lag].value(); }
  /// Variance / mean about the slowly changing rate, from the differences of successive counts.
  [[nodiscard]] double variance_over_mean() const;

  /// Doppler ambiguity: share of the false movers by the measured definition and by the truth, share of stationary
  /// detections likewise, share of labelled detections. By the measured definition other false movers count, too.
  [[nodiscard]] double percent_doppler_measured() const { return doppler_measured_.percent(); }
  [[nodiscard]] double percent_doppler_by_truth() const { return doppler_by_truth_.percent(); }
  [[nodiscard]] double percent_doppler_of_stationary() const { return doppler_of_stationary_.percent(); }
  [[nodiscard]] double percent_doppler_of_stationary_by_truth() const { return doppler_of_stationary_truth_.percent(); }
  [[nodiscard]] double percent_doppler_of_movers() const { return doppler_of_movers_.percent(); }
  /// Azimuth ambiguity: share by the measured definition beyond chance, share and number in a scan by the truth.
  [[nodiscard]] double percent_azimuth_measured() const;
  [[nodiscard]] double percent_azimuth_by_truth() const { return azimuth_by_truth_.percent(); }
  [[nodiscard]] double azimuth_by_truth_per_scan() const;
  /// Range and range rate of a labelled detection of the same scan, over 4° beside it.
  [[nodiscard]] double percent_beside_object() const { return beside_object_.percent(); }

  /// The sensor's own flags and existence probability, of false movers and of movers in their boxes.
  [[nodiscard]] double percent_valid(bool real) const { return valid_[real ? 1 : 0].percent(); }
  [[nodiscard]] double percent_unambiguous(bool real) const { return unambiguous_[real ? 1 : 0].percent(); }
  [[nodiscard]] double existence_separates() const {
    return chance_that_first_exceeds(existence_[1].values(), existence_[0].values());
  }

 private:
  struct Chain {
    ObservedDetection last;
    std::size_t scans;
  };
  struct Radar {
    std::vector<Chain> open;
    std::vector<double> counts;
    double first_s = 0.0, last_s = 0.0, time_s = 0.0;
    std::uint64_t number = 0;
  };
  void add_numbers(const ObservedScan& scan, const std::vector<ObservedDetection>& movers);
  void add_causes(const ObservedScan& scan, const std::vector<ObservedDetection>& movers);
  void add_chains(const ObservedScan& scan, const std::vector<ObservedDetection>& movers, Radar& radar);

  std::array<Samples, 3> counts_, near_counts_;  // by facing
  std::size_t scans_ = 0, near_valid_ = 0, azimuth_truth_count_ = 0;
  std::array<std::size_t, 3> beyond_{};
  std::array<std::size_t, kDensities> in_ring_{};
  std::array<double, kDensities> area_m2_{};  // of the rings in view, summed over scans
  std::array<std::size_t, kDeviations> in_band_{};
  Share of_unlabelled_, near_zero_, again_, chance_;
  Samples range_m_, chain_scans_;
  std::array<LagCorrelation, kLags_s.size()> correlation_;
  double step_squares_ = 0.0, step_sum_ = 0.0;
  Share doppler_measured_, doppler_by_truth_, doppler_of_stationary_, doppler_of_stationary_truth_, doppler_of_movers_;
  Share azimuth_at_step_, azimuth_beside_, azimuth_by_truth_, beside_object_;
  std::array<Share, 2> valid_, unambiguous_;
  std::array<Samples, 2> existence_;
  std::map<std::uint32_t, Radar> radars_;
};

}  // namespace boresight::bench::realism
