// Drives whose inputs are wrong in one way, offered to the search for wrong inputs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "services/alignment_estimator/core/plausibility/plausibility.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment::plausibility {

enum class Wrong : std::uint8_t {
  kNothing,
  kSwapped,  ///< the first two radars
  kYaw20,    ///< of the first radar in the vehicle file
  kYaw90,
  kAzimuth,      ///< of the first radar
  kAllAzimuths,  ///< of all
  kRangeRate,    ///< of the first
  kAllRangeRates,
  kYawRate,
  kKmh,
  kMph,
  kDegrees,
  kFrozen,       ///< from the third second on
  kFrozenAtAll,  ///< speed and yaw rate
  kZero,
  kMissing,    ///< from the beginning
  kGoesStale,  ///< from the fifth second on
  kCopies,     ///< of the first radar
  kOtherRadar  ///< the first radar sends the detections of the second
};
inline constexpr Wrong kAllWrong[] = {Wrong::kSwapped,     Wrong::kYaw20,     Wrong::kYaw90,         Wrong::kAzimuth,
                                      Wrong::kAllAzimuths, Wrong::kRangeRate, Wrong::kAllRangeRates, Wrong::kYawRate,
                                      Wrong::kKmh,         Wrong::kMph,       Wrong::kDegrees,       Wrong::kFrozen,
                                      Wrong::kFrozenAtAll, Wrong::kZero,      Wrong::kMissing,       Wrong::kGoesStale,
                                      Wrong::kCopies,      Wrong::kOtherRadar};
inline constexpr const char* kWrongNames[] = {
    "nothing",    "swapped", "yaw 20 deg", "yaw 90 deg", "azimuth", "all azimuths",  "range rate", "all range rates",
    "yaw rate",   "km/h",    "mph",        "deg/s",      "frozen",  "frozen at all", "zero",       "missing",
    "goes stale", "copies",  "other radar"};

inline AlignmentFinding expected(Wrong wrong) {
  constexpr AlignmentFinding kFindings[] = {AlignmentFinding::kNone,
                                            AlignmentFinding::kRadarsSwapped,
                                            AlignmentFinding::kNominalYawWrong,
                                            AlignmentFinding::kNominalYawWrong,
                                            AlignmentFinding::kAzimuthMirrored,
                                            AlignmentFinding::kAzimuthMirrored,
                                            AlignmentFinding::kRangeRateMirrored,
                                            AlignmentFinding::kRangeRateMirrored,
                                            AlignmentFinding::kYawRateMirrored,
                                            AlignmentFinding::kSpeedUnit,
                                            AlignmentFinding::kSpeedUnit,
                                            AlignmentFinding::kYawRateUnit,
                                            AlignmentFinding::kSpeedFrozen,
                                            AlignmentFinding::kSpeedFrozen,
                                            AlignmentFinding::kSpeedZero,
                                            AlignmentFinding::kEgoMotionMissing,
                                            AlignmentFinding::kEgoMotionMissing,
                                            AlignmentFinding::kCopiedDetections,
                                            AlignmentFinding::kOtherRadar};
  return kFindings[static_cast<std::size_t>(wrong)];
}

/// Messages in the order of measurement; makes them wrong, matches motion to scans, and offers the scans.
class Bench {
 public:
  Bench(VehicleConfig vehicle, Wrong wrong, const PlausibilityConfig& config = {}) : wrong_(wrong) {
    if (wrong == Wrong::kYaw20) vehicle.radars[0].mounting_pose.yaw_rad += 20.0 * kRadiansPerDegree;
    if (wrong == Wrong::kYaw90) vehicle.radars[0].mounting_pose.yaw_rad += 90.0 * kRadiansPerDegree;
    vehicle_ = std::move(vehicle);
    plausibility_ = std::make_unique<Plausibility>(vehicle_, config);
    found_s_.resize(vehicle_.radars.size(), std::numeric_limits<double>::infinity());
    wrong_s_.resize(vehicle_.radars.size(), 0.0);
  }

  void add(EgoMotion motion, double time_s) {
    start(time_s);
    if (wrong_ == Wrong::kMissing || (wrong_ == Wrong::kGoesStale && time_s - start_s_ > 5.0)) return;
    if (wrong_ == Wrong::kZero) motion.speed_mps = 0.0F;
    if (wrong_ == Wrong::kKmh) motion.speed_mps *= 3.6F;
    if (wrong_ == Wrong::kMph) motion.speed_mps *= 2.23694F;
    if (wrong_ == Wrong::kDegrees) motion.yaw_rate_radps *= static_cast<float>(kDegreesPerRadian);
    if (wrong_ == Wrong::kYawRate) motion.yaw_rate_radps *= -1.0F;
    if ((wrong_ == Wrong::kFrozen || wrong_ == Wrong::kFrozenAtAll) && time_s - start_s_ > 3.0) {
      motion.speed_mps = frozen_.speed_mps;
      if (wrong_ == Wrong::kFrozenAtAll) motion.yaw_rate_radps = frozen_.yaw_rate_radps;
    } else {
      frozen_ = motion;
    }
    ego_.add(motion);
  }

  void add(std::size_t radar, const RadarScan& scan, double time_s) {
    start(time_s);
    if (wrong_ == Wrong::kSwapped && radar < 2) radar = 1 - radar;
    take(radar, scan, time_s);
    if (wrong_ == Wrong::kOtherRadar) {
      if (radar == 0) return;
      if (radar == 1) offer(0, time_s);
    }
    offer(radar, time_s);
  }

  /// From now on the inputs are right. Not for a wrong nominal yaw.
  void repair() { wrong_ = Wrong::kNothing; }

  [[nodiscard]] Finding finding(std::size_t radar) const { return plausibility_->finding(radar); }
  [[nodiscard]] const Plausibility& plausibility() const { return *plausibility_; }
  /// Seconds until the expected finding of a radar; infinite if it never came.
  [[nodiscard]] double found_s(std::size_t radar) const { return found_s_[radar]; }
  /// Seconds with another finding than the expected one.
  [[nodiscard]] double wrong_s(std::size_t radar) const { return wrong_s_[radar]; }
  [[nodiscard]] Finding worst() const { return worst_; }
  [[nodiscard]] const VehicleConfig& vehicle() const { return vehicle_; }
  std::function<void(std::size_t, const ScanDetections&, const EgoSample&)> before;  ///< each scan that is offered

  /// Of the first radar, of the first two, or of all.
  [[nodiscard]] std::size_t affected() const {
    switch (wrong_) {
      case Wrong::kNothing:
        return 0;
      case Wrong::kSwapped:
        return 2;
      case Wrong::kYaw20:
      case Wrong::kYaw90:
      case Wrong::kAzimuth:
      case Wrong::kRangeRate:
      case Wrong::kCopies:
      case Wrong::kOtherRadar:
        return 1;
      default:
        return vehicle_.radars.size();
    }
  }

 private:
  void start(double time_s) {
    if (start_s_ < 0.0) start_s_ = time_s;
  }
  void take(std::size_t radar, const RadarScan& scan, double) {
    take_detections(scan, vehicle_.radars[radar], *detections_);
    ScanDetections& d = *detections_;
    const bool first = radar == 0;
    for (std::size_t i = 0; i < d.count; ++i) {
      if (wrong_ == Wrong::kAllAzimuths || (wrong_ == Wrong::kAzimuth && first)) d.azimuth_rad[i] *= -1.0;
      if (wrong_ == Wrong::kAllRangeRates || (wrong_ == Wrong::kRangeRate && first)) d.range_rate_mps[i] *= -1.0;
      if (wrong_ == Wrong::kCopies && first) {
        d.azimuth_rad[i] = d.azimuth_rad[0];
        d.elevation_rad[i] = d.elevation_rad[0];
        d.range_rate_mps[i] = d.range_rate_mps[0];
        d.range_m[i] = d.range_m[0];
      }
    }
  }
  void offer(std::size_t radar, double time_s) {
    const EgoSample ego = ego_.at(detections_->time_ns);
    if (before) before(radar, *detections_, ego);
    plausibility_->add(radar, *detections_, ego);
    const Finding found = plausibility_->finding(radar);
    const AlignmentFinding right = radar < affected() ? expected(wrong_) : AlignmentFinding::kNone;
    if (found.finding == right) {
      found_s_[radar] = std::min(found_s_[radar], time_s - start_s_);
    } else if (found.finding != AlignmentFinding::kNone) {
      wrong_s_[radar] += vehicle_.radars[radar].cycle_time_s;
      worst_ = found;
    }
  }

  Wrong wrong_;
  VehicleConfig vehicle_;
  std::unique_ptr<Plausibility> plausibility_;
  std::unique_ptr<ScanDetections> detections_ = std::make_unique<ScanDetections>();
  EgoHistory ego_;
  EgoMotion frozen_{};
  Finding worst_;
  std::vector<double> found_s_, wrong_s_;
  double start_s_ = -1.0;
};

}  // namespace boresight::alignment::plausibility
