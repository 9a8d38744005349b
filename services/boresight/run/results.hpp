// What the chain computed from one input: values and references into the chain's memory, valid during a call.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/track_list.hpp"

namespace boresight::run {

/// A time on the recording's own clock.
struct Moment {
  std::int64_t time_ns = 0;   ///< since the epoch, or on the clock of the tables
  std::int64_t start_ns = 0;  ///< of the first measurement
  /// Since the first measurement, rounded to a microsecond.
  [[nodiscard]] std::int64_t since_start_us() const {
    const std::int64_t since_ns = time_ns - start_ns;
    return (since_ns + (since_ns < 0 ? -500 : 500)) / 1000;
  }
};

/// A scan that passed all stages. Index i is the same detection everywhere; its corrected_flag bits are those of
/// `classified`.
struct ScanResult {
  Moment at;
  std::uint64_t number;  ///< of the scan of this radar, from 1
  const RadarScan& scan;
  const ClassifiedScan& classified;
  const TrackList& tracks;
};

/// An estimate that the alignment estimator would publish.
struct EstimateResult {
  Moment at;
  const AlignmentEstimate& message;
  Eigen::Vector3d rotation_vehicle_rad;  ///< d of R(actual) = Exp(d)·R(nominal)
  Eigen::Matrix4d covariance;            ///< over (k_v, d_x, d_y, d_z)
};

/// The verdicts on all radars at one time.
struct HealthResult {
  Moment at;
  DataQualifier overall = DataQualifier::kNotAvailable;
  AlignmentVehicleChange load_change{};   ///< of the vehicle, the latest
  AlignmentVehicleChange speed_change{};  //
  std::size_t number_of_sensors = 0;
  std::array<SensorHealth, kMaxRadars> sensors{};
};

/// Called in the order in which the results arise; each may be empty.
struct Listeners {
  std::function<void(const ScanResult&)> scan;
  std::function<void(const EstimateResult&)> estimate;
  std::function<void(const HealthResult&)> health;
};

}  // namespace boresight::run
