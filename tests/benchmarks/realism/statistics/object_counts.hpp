// Section 1: detections of an object in one scan of one radar, and misses that last.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// Which scans of a radar count for an object.
enum class Counting : std::uint8_t {
  /// Schumann et al. have no object numbers: from the first to the last detection by any radar, 0.3 s off both ends, in
  /// view of the radar asked. Hidden objects count as missed.
  kFirstToLast,
  kInSight,  ///< hidden objects do not count, as with the boxes of Caesar et al.
};
inline constexpr std::size_t kCountings = 2;

struct CountSelection {
  RoadUser user = RoadUser::kCar;
  double range_from_m = 0.0, range_to_m = kEverywhere;
  double aspect_from_rad = 0.0, aspect_to_rad = 4.0;
};

class ObjectCounts {
 public:
  void add(const ObservedScan& scan);
  /// Ends a drive: object and scan numbers begin again.
  void end_drive();
  void merge(const ObjectCounts& other);

  [[nodiscard]] double mean(Counting counting, const CountSelection& of) const;
  [[nodiscard]] double percent_none(Counting counting, const CountSelection& of) const;
  [[nodiscard]] double variance_over_mean(Counting counting, const CountSelection& of) const;
  [[nodiscard]] double most(const CountSelection& of) const;

  /// P(none | none in this radar's scan before).
  [[nodiscard]] double none_after_none(Counting counting, RoadUser user) const;
  /// Scans without detection between two with one.
  [[nodiscard]] const Samples& gaps(Counting counting, RoadUser user) const;
  /// About the mean of one object, radar and range bin.
  [[nodiscard]] double variance_over_mean_in_track(Counting counting, RoadUser user) const;
  /// Of the counts of successive scans, about the same mean. `lag` 1, 2 or 5.
  [[nodiscard]] double correlation(Counting counting, RoadUser user, std::size_t lag) const;

 private:
  struct Visit {  // an object in view in one scan of one radar
    double t_s;
    std::uint64_t scan;
    RoadUser user;
    float range_m, aspect_rad;
    unsigned count;
    bool in_sight;
  };
  struct Counted {
    RoadUser user;
    float range_m, aspect_rad;
    unsigned count;
  };
  static constexpr std::array<std::size_t, 3> kLags{1, 2, 5};
  struct Sums {
    std::vector<Counted> all;
    std::array<Share, kRoadUsers> none_after_none;
    std::array<Samples, kRoadUsers> gaps;
    std::array<WithinGroups, kRoadUsers> in_track;
    std::array<std::array<LagCorrelation, kLags.size()>, kRoadUsers> correlation;
  };
  using Series = std::vector<Visit>;
  void close(const Series& series, Counting counting);
  static void add_runs(const Series& series, Sums& sums);
  static void add_bins(const Series& series, Sums& sums);
  template <typename Use>
  void for_each(Counting counting, const CountSelection& of, const Use& use) const;

  std::map<std::pair<std::uint32_t, std::uint32_t>, Series> open_;  // by radar and object
  std::map<std::uint32_t, std::pair<double, double>> detected_s_;   // by object: first and last
  std::array<Sums, kCountings> sums_;
};

}  // namespace boresight::bench::realism
