// Objects that a filter takes away: those which the same tracker has when it is given perfect labels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/classified_scan.hpp"
#include "tests/closed_loop/objects.hpp"
#include "tests/simulator/detection_truth.hpp"
#include "tests/simulator/judge/matching.hpp"

namespace boresight::bench {

using judge::kNone;
using judge::match;
using judge::Matching;

/// In how many of those scans of a second in which it was not hidden each object had a confirmed track, and how many
/// detections it had.
class TrackedObjects {
 public:
  struct Second {
    std::size_t scans = 0, tracked = 0, detections = 0, hidden = 0;
    /// Of who comes into sight as the second ends no tracker can know in it: what lies there is something else's track.
    [[nodiscard]] bool is_long_in_sight() const {
      constexpr double kLeast = 0.25;
      return static_cast<double>(scans) >= kLeast * static_cast<double>(scans + hidden);
    }
    [[nodiscard]] double share() const { return static_cast<double>(tracked) / static_cast<double>(scans); }
  };
  void add(const Matching& matching, const std::vector<closed_loop::Object>& objects);
  /// Of an object's own detections, those that are told to be what they are: moving, or, of what came to a stand,
  /// stationary.
  void add_detections(const ClassifiedScan& scan, const std::vector<simulator::DetectionTruth>& truth);
  void clear() { seconds_.clear(); }
  [[nodiscard]] const std::map<std::uint32_t, Second>& seconds() const { return seconds_; }

 private:
  std::map<std::uint32_t, Second> seconds_;
};

/// A second of an object's.
struct LostSecond {
  double until_s;
  std::uint32_t object_id;
};

struct LostObjects {
  static constexpr double kHasIt = 0.9, kHasItNot = 0.5;  ///< shares of the scans of a second
  /// In which perfect labels have the object all through. What is not seen is not the filter's to lose: the track that
  /// lies there is as likely another object's.
  std::size_t object_seconds = 0;
  std::vector<LostSecond> lost;  ///< of these: the filter's labels have it for less than half
  /// The other way round. Where both are many, what is lost is so by the tracker's chance and not by the filter.
  std::size_t gained = 0;
  /// Of those lost: with at least kToldRight of the object's own detections told to move. What took it away then was
  /// told wrong elsewhere or before, or is the tracker's chance.
  static constexpr double kToldRight = 0.9;
  std::size_t lost_though_told = 0;
  /// Each object's seconds of both kinds, over the drive.
  struct Seconds {
    std::size_t held = 0, lost = 0;
  };
  std::map<std::uint32_t, Seconds> of_object;
  /// Objects that are lost for over half of the seconds in which perfect labels have them.
  [[nodiscard]] std::size_t rather_lost() const;
  void add_second(double until_s, const TrackedObjects& with_perfect_labels, const TrackedObjects& with_filter);
};

/// Seconds that are lost where perfect labels miss but so large a share of what moves, by chance: as many as the
/// bar on moving detections allows. It is for comparison: a tracker has chances of its own where objects are hardly
/// seen or close together.
struct LostByChance {
  static constexpr double kThrownOut = 0.03;
  static constexpr std::size_t kDraws = 5;
  std::array<std::size_t, kDraws> seconds{};
  LostByChance& operator+=(const LostByChance& other);
  [[nodiscard]] std::size_t least() const;
  [[nodiscard]] std::size_t most() const;
};

}  // namespace boresight::bench
