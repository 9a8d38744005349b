// The tracks of a drive that count by a rule, beside the truth.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/benchmarks/tracking/drives/judge/scored_drive.hpp"
#include "tests/benchmarks/tracking/drives/judge/threshold.hpp"

namespace boresight::bench::tracking {

/// Sums over the track lists in which an object is in view, real numbers because operating points are mixtures.
struct ObjectTally {
  double lists_in_view = 0.0, lists_tracked = 0.0;
  double errors_with_covariance = 0.0, errors_inside = 0.0;  ///< of the stated 95 % ellipse
  /// While the object is near (ScoredDrive::kNear_m) and tracked; the heading's while it moves.
  struct Near {
    double lists = 0.0, along_m2 = 0.0, across_m2 = 0.0, length_m2 = 0.0, axis_rad2 = 0.0;
    double lists_moving = 0.0, heading_rad2 = 0.0;
  } near;

  [[nodiscard]] double share() const { return lists_in_view > 0.0 ? lists_tracked / lists_in_view : 0.0; }
  void add(const ObjectTally& other, double weight);
};

/// Sums over the track lists of a drive, of tracks within the judged range.
struct ListTally {
  double lists = 0.0, false_tracks = 0.0, at_an_object = 0.0;
  double assigned = 0.0;    ///< of those at an object
  double duplicates = 0.0;  ///< at an object, not assigned, and not stated to be stationary

  void add(const ListTally& other, double weight);
};

struct Judgement {
  std::vector<ObjectTally> objects;  ///< by index of ScoredDrive::objects()
  ListTally lists;
};

/// One-to-one assignment, nearest first; objects that are not judged come last.
[[nodiscard]] Judgement judge_drive(const ScoredDrive& drive, const Rule& rule);
/// The mixture of both rules.
[[nodiscard]] Judgement judge_drive(const ScoredDrive& drive, const OperatingPoint& point);

}  // namespace boresight::bench::tracking
