// Why a track may have no detections: what each radar could detect of the object in its latest scan.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "interfaces/messages/header.hpp"
#include "services/tracker/core/model/radar_model.hpp"

namespace boresight::tracking {

struct DetectabilityParameters {
  double likely = 0.5;         ///< from this probability on a condition holds (likelier than not)
  double merged_share = 0.2;   ///< an object whose detections are another's by this share is merged with it
  double recent_scan_s = 0.5;  ///< a radar whose latest scan is older does not count: several cycles of a radar
};

/// The first of these that holds for an object in a radar's scan. The later, the nearer is a detection of its own.
enum class Obstacle : std::uint8_t { kOutOfView, kOccluded, kZeroDoppler, kMerged, kNone };

/// `shared`: as of ObjectEstimate.
[[nodiscard]] Obstacle obstacle(const Sight& sight, double shared, const DetectabilityParameters& parameters);

/// Ages of the radars' latest scans, by the radar's index.
class RecentScans {
 public:
  RecentScans() { clear(); }
  void clear() { age_s_.fill(std::numeric_limits<double>::infinity()); }
  /// A scan of a radar, `elapsed_s` after the scan before. Index −1: of none of the vehicle's.
  void add(int radar, double elapsed_s);
  [[nodiscard]] double age_s(std::size_t radar) const { return age_s_[radar]; }

 private:
  std::array<double, kMaxRadars> age_s_;
};

/// Of one object, in the latest scan of each radar. A radar that has not looked since the object is known does not see
/// it.
class Detectability {
 public:
  void set(int radar, Obstacle obstacle);
  /// track_flag bit of the radar that came nearest to a detection of its own; 0 where nothing stood against it.
  [[nodiscard]] std::uint32_t flags(const RecentScans& scans, const DetectabilityParameters& parameters) const;

 private:
  std::array<Obstacle, kMaxRadars> by_radar_{};  // kOutOfView
};

}  // namespace boresight::tracking
