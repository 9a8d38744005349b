// One object as the tracker knows it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "services/tracker/core/extent.hpp"
#include "services/tracker/core/kalman.hpp"

namespace boresight::tracking {

/// Who is before or behind, and may be the vehicle of which the track is a piece (pieces.hpp).
struct Companion {
  std::uint32_t id = 0;               ///< 0: nobody
  bool has_begun = false;             ///< been watched for a second
  double begun_m = 0.0;               ///< how far the ends that are seen were apart in that second
  double since_age_s = 0.0;           ///< of the track, from when on it has kept its distance
  double first_m = 0.0, now_m = 0.0;  ///< that distance at first, and now
  std::uint32_t scans = 0;            ///< of which first_m is the mean
  bool is_apart = false;              ///< it has moved on its own
};

struct TrackedObject {
  static constexpr std::size_t kLongestWindow = 32;  // of scans
  std::uint32_t id = 0;
  bool confirmed = false;
  KinematicState state;
  Extent extent;
  std::uint32_t history = 0;  // one bit for each scan that could see the object, the latest lowest; 1: detected
  std::uint32_t seen_scans = 0;
  std::array<float, kLongestWindow> evidence{};  // how real each of those scans' detections were, the latest first
  double existence = 0.5;
  double age_s = 0.0;
  double since_update_s = 0.0;
  std::uint32_t detections = 0;  // in the last scan
  double realness = 0.0;         // of those
  Companion companion;
  bool slow = false;  // when it was detected last
};

}  // namespace boresight::tracking
