// Objects lost because of a ghost filter: the same tracker holds a track of them when it is given perfect labels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "services/simulator/detection_truth.hpp"
#include "services/simulator/judge/matching.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::bench {

using judge::kNone;
using judge::match;
using judge::Matching;

/// For each object and second: number of scans in which the object was not hidden, number of these with a confirmed
/// track, and number of detections.
class TrackedObjects {
 public:
  struct Second {
    std::size_t scans = 0, tracked = 0, detections = 0, hidden = 0;
    /// False for an object that comes into sight at the end of the second: no tracker can confirm it in time, and a
    /// track at its place belongs to another object.
    [[nodiscard]] bool is_long_in_sight() const {
      constexpr double kLeast = 0.25;
      return static_cast<double>(scans) >= kLeast * static_cast<double>(scans + hidden);
    }
    [[nodiscard]] double share() const { return static_cast<double>(tracked) / static_cast<double>(scans); }
  };
  void add(const Matching& matching, const std::vector<closed_loop::Object>& objects);
  /// Counts an object's direct detections that are classified correctly: moving, or stationary after the object
  /// stopped.
  void add_detections(const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth);
  void clear() { seconds_.clear(); }
  [[nodiscard]] const std::map<std::uint32_t, Second>& seconds() const { return seconds_; }

 private:
  std::map<std::uint32_t, Second> seconds_;
};

/// One lost second of one object.
struct LostSecond {
  double until_s;
  std::uint32_t object_id;
};

struct LostObjects {
  static constexpr double kHeldShare = 0.9, kLostShare = 0.5;  ///< shares of a second's scans with a track
  /// Seconds in which the tracker with perfect labels holds the object throughout. Hidden objects are not counted: a
  /// track at their place is as likely another object's.
  std::size_t object_seconds = 0;
  std::vector<LostSecond> lost;  ///< of these: the tracker with the filter's labels holds it for less than half
  /// Seconds held only with the filter's labels. If both numbers are large, losses are chance of the tracker rather
  /// than errors of the filter.
  std::size_t gained = 0;
  /// Of the lost seconds: those with at least kMinCorrectShare of the object's direct detections classified correctly.
  /// The cause is then an error at another place or time, or chance of the tracker.
  static constexpr double kMinCorrectShare = 0.9;
  std::size_t lost_though_correct = 0;
  /// Seconds held with perfect labels, and lost with the filter's labels, per object over the drive.
  struct Seconds {
    std::size_t held = 0, lost = 0;
  };
  std::map<std::uint32_t, Seconds> of_object;
  /// Objects that are lost in over half of the seconds in which perfect labels hold them.
  [[nodiscard]] std::size_t mostly_lost() const;
  void add_second(double until_s, const TrackedObjects& with_perfect_labels, const TrackedObjects& with_filter);
};

/// Seconds lost with perfect labels of which a random share of the moving detections is labelled as ghosts: as large a
/// share as the bar on moving detections allows. For comparison: where objects are rarely detected or close together, a
/// track depends on single detections.
struct LostByChance {
  static constexpr double kMislabelledShare = 0.03;
  static constexpr std::size_t kDraws = 5;
  std::array<std::size_t, kDraws> seconds{};
  LostByChance& operator+=(const LostByChance& other);
  [[nodiscard]] std::size_t least() const;
  [[nodiscard]] std::size_t most() const;
};

}  // namespace boresight::bench
