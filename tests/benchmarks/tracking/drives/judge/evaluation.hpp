// All drives of a profile, or of several, judged for each tracker at equal numbers of false tracks and at fixed
// thresholds.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/benchmarks/tracking/drives/judge/judgement.hpp"

namespace boresight::bench::tracking {

/// False tracks at a time at which trackers are compared.
inline constexpr std::array<double, 3> kFalseTracks = {1.0, 2.0, 4.0};
/// The same for a curve of each tracker alone.
inline constexpr std::array<double, 8> kCurveFalseTracks = {0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

/// A way to choose which tracks count that needs no truth.
struct FixedRule {
  const char* name;
  Rule rule;
};
inline constexpr std::size_t kLikely = 0, kSure = 1, kConfirmed = 2;
inline constexpr std::array<FixedRule, 3> kFixedRules = {
    {{"existence ≥ 0.5", {0.5F, false}},
     {"existence ≥ 0.9", {0.9F, false}},
     {"confirmed", {-std::numeric_limits<float>::infinity(), true}}}};

/// What the tracker gets of the origins of detections.
enum class Origins { kFiltered, kTrue, kNone };

/// The drives of one tracker.
struct Contestant {
  std::string name;
  bool is_baseline = false;
  Origins origins = Origins::kFiltered;
  std::vector<ScoredDrive> drives;
  std::vector<double> ms_per_scan;            ///< of each drive; NaN: not known
  std::vector<std::vector<double>> steps_ms;  ///< of each drive: CPU time of each scan; may be empty
};

/// An object that is in view for long enough to be found.
struct JudgedObject {
  std::size_t drive;
  std::uint32_t id;
  ObjectClass object_class;
};

/// At one rule or operating point.
struct Outcome {
  std::string rule;                  ///< as shown
  std::vector<ObjectTally> objects;  ///< by index of Evaluation::objects
  ListTally lists;
  std::vector<ListTally> lists_of_drives;

  [[nodiscard]] double false_tracks() const { return lists.false_tracks / lists.lists; }
  [[nodiscard]] double duplicates() const { return lists.duplicates / lists.lists; }
  void append(const Outcome& other);
};

struct TrackerResult {
  std::string name;
  bool is_baseline = false;
  Origins origins = Origins::kFiltered;
  std::array<Outcome, kFalseTracks.size()> at_false_tracks;
  std::array<Outcome, kCurveFalseTracks.size()> curve;
  std::array<Outcome, kFixedRules.size()> fixed;
  Reliability reliability;
  std::vector<std::size_t> long_false_tracks;  ///< of each drive
  std::vector<double> ms_per_scan;
  std::vector<double> step_ms;  ///< of each scan; empty: not known
  void append(const TrackerResult& other);
};

struct Evaluation {
  std::string name;
  std::size_t drives = 0;
  std::vector<JudgedObject> objects;
  std::vector<TrackerResult> trackers;  ///< the product's
  /// By index of kFalseTracks: the baseline that tracks objects for longer there.
  std::array<Outcome, kFalseTracks.size()> better_baseline;
  std::vector<TrackerResult> baselines;
  void append(const Evaluation& other);
};

/// The contestants have the same drives. The product's trackers are judged at as many false tracks as the better
/// baseline reaches, if that is less than wanted.
[[nodiscard]] Evaluation evaluate(std::string name, const std::vector<Contestant>& contestants);

/// Mean of the objects' shares of lists in which they are tracked.
[[nodiscard]] double mean_share(const std::vector<ObjectTally>& objects);

}  // namespace boresight::bench::tracking
