// Section 4: RCS as the sensor states it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/benchmarks/realism/common/observed_scan.hpp"
#include "tests/benchmarks/realism/common/samples.hpp"

namespace boresight::bench::realism {

/// What a detection is by the measured definitions.
enum class Sort : std::uint8_t { kVehicle, kFalseMover, kStationary };
inline constexpr std::size_t kSorts = 3;

/// Ranges of the table: 0–10, 10–20, 20–30, 30–45, 45–65, 65–100 m.
inline constexpr std::array<double, 7> kStrengthEdges_m{0.0, 10.0, 20.0, 30.0, 45.0, 65.0, 100.0};
inline constexpr std::size_t kStrengthBins = kStrengthEdges_m.size() - 1;

class Strength {
 public:
  void add(const ObservedScan& scan);
  /// Ends a drive: object and scan numbers begin again.
  void end_drive();
  void merge(const Strength& other);

  [[nodiscard]] double quantile_dbsm(Sort sort, double from_m, double to_m, double share) const;
  /// Probability that a vehicle's detection is stronger than a false mover's.
  [[nodiscard]] double vehicle_is_stronger(double from_m, double to_m) const;
  /// The same of those that the sensor reports as valid.
  [[nodiscard]] double valid_vehicle_is_stronger(double from_m, double to_m) const;
  /// Median of the detections of pedestrians or two-wheelers.
  [[nodiscard]] double median_dbsm(RoadUser user) const {
    return of_user_[static_cast<std::size_t>(user)].quantile(0.5);
  }

  /// Standard deviations of one vehicle's detections: in a range bin, in one scan.
  [[nodiscard]] double std_in_bin_db(std::size_t bin) const { return in_bin_[bin].std_dev(); }
  [[nodiscard]] double std_in_scan_db() const { return in_scan_.std_dev(); }
  /// Of the strongest detection from scan to scan: sd of the difference / √2.
  [[nodiscard]] double std_scan_to_scan_db() const { return step_db_.std_dev(); }
  /// Strongest detection of a vehicle in a scan.
  [[nodiscard]] double strongest_median_dbsm(double from_m, double to_m) const;
  [[nodiscard]] double percent_strongest_below(RoadUser user, double from_m, double to_m, double limit_dbsm) const;

 private:
  struct Value {
    float range_m, rcs_dbsm;
    bool is_valid;  // by the sensor
  };
  struct Strongest {
    RoadUser user;
    float range_m, rcs_dbsm;
  };
  struct Last {
    std::uint64_t scan;
    double rcs_dbsm;
  };
  [[nodiscard]] std::vector<float> values(Sort sort, double from_m, double to_m, bool valid_only = false) const;
  void add_vehicle(const ObservedScan& scan, const ObservedObject& object);

  std::array<std::vector<Value>, kSorts> by_sort_;
  std::array<Samples, kRoadUsers> of_user_;
  std::array<WithinGroups, kStrengthBins> in_bin_;
  WithinGroups in_scan_, step_db_;
  std::vector<Strongest> strongest_;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::size_t>, std::vector<double>> open_;  // radar, object, bin
  std::map<std::pair<std::uint32_t, std::uint32_t>, Last> last_;                               // radar, object
};

}  // namespace boresight::bench::realism
