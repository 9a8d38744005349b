// One detection with truth, classification, object and track: a CSV row, and a count in the summary.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <tuple>
#include <vector>

#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

/// Whether the tracks known to the filter (those after the previous scan) contain the detection's object.
enum class ObjectTrack : std::uint8_t { kNone, kTentative, kConfirmed };

struct Explained {
  std::uint64_t seed;
  double t_s;
  std::uint32_t radar;
  simulator::DetectionTruth truth;
  Provenance label;
  bool rejected, found_moving;  ///< by the corrector
  double ghost_probability;
  double x_vehicle_m, y_vehicle_m, range_m, azimuth_vehicle_rad, range_rate_over_ground_mps, rcs_dbsm;
  double object_distance_m;  ///< from the true box of its object, without one from the nearest box; NaN: no box
  ObjectTrack object_track;
};

[[nodiscard]] const char* csv_header();
void write_csv(const Explained& row, std::ostream& out);

/// Explains the scans of one method on one drive, in order.
class Explainer {
 public:
  explicit Explainer(std::uint64_t seed) : seed_(seed) {}
  /// Valid until the next call.
  [[nodiscard]] const std::vector<Explained>& explain(const Observed& observed);

 private:
  std::uint64_t seed_;
  std::map<std::uint32_t, ObjectTrack> tracked_;  // by object, before this scan
  std::vector<Explained> rows_;
};

/// Truth × label × whether the object was tracked × distance from the object's box.
class Summary {
 public:
  static constexpr std::array<double, 6> kDistances_m = {0.5, 1.0, 2.0, 5.0, 10.0, 20.0};  ///< and farther
  void add(const Explained& row);
  void print(std::ostream& out) const;

 private:
  using Key = std::tuple<Provenance, Provenance, bool>;
  std::map<Key, std::array<std::uint64_t, kDistances_m.size() + 1>> counts_;
};

}  // namespace boresight::bench
