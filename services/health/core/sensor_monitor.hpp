// Verdict on one radar: delivery, rate, data integrity, mounting error.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/axis_judge.hpp"
#include "services/health/core/consequence.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/core/function/delivery_monitor.hpp"
#include "services/health/core/function/disturbance_monitor.hpp"
#include "services/health/core/function/radar_levels.hpp"
#include "services/health/core/function/sight_monitor.hpp"
#include "services/health/core/rate_window.hpp"

namespace boresight::health {

/// Uses received data only, not the middleware's state of connections. Times are CLOCK_MONOTONIC, ns.
class SensorMonitor {
 public:
  /// `start_ns`: start of supervision. A silent radar is INITIALISING until its deadline has passed once.
  SensorMonitor(const RadarConfig& radar, const Config& config, std::int64_t start_ns);

  void observe(const RadarScan& scan, std::int64_t now_ns);
  void observe(const EgoMotion& motion);
  void observe(const AlignmentEstimate& estimate);
  /// The gateway's counts for this radar.
  void observe(const SourceStatistics& statistics, std::int64_t now_ns);
  /// Reports the results of all tests to the fault memory and derives the verdict from the failed events in it.
  /// `vehicle` has the values of a freeze frame that do not belong to this radar.
  [[nodiscard]] SensorHealth judge(FaultMemory& faults, std::int64_t now_ns, const FreezeFrame& vehicle);
  /// Continues with the verdicts of an earlier process.
  void restore(const FaultMemory& faults);
  /// What this radar is used to deliver, to be kept over a restart.
  [[nodiscard]] RadarLevels levels() const;
  void restore(const RadarLevels& levels);

  [[nodiscard]] std::uint32_t radar_id() const { return radar_id_; }
  /// True if a scan arrived within the radar's deadline.
  [[nodiscard]] bool delivers(std::int64_t now_ns) const { return delivery_.delivers(now_ns); }

 private:
  std::uint32_t radar_id_;
  Config config_;
  DeliveryMonitor delivery_;
  SightMonitor sight_monitor_;
  UnexplainedDetections unexplained_;
  DisturbanceMonitor disturbance_;
  VehicleMotion motion_{.speed_mps = std::numeric_limits<double>::quiet_NaN(), .yaw_rate_radps = 0.0};
  std::uint64_t lost_scans_ = 0;
  std::uint64_t last_sequence_ = 0;
  double detections_per_scan_ = 0.0;
  RateWindow messages_;
  RateWindow rejected_;
  RateWindow suspect_;
  RateWindow received_;       // scans
  RateWindow frozen_;         // scans with the same data as before
  RateWindow contradicting_;  // scans that contradict the vehicle's motion
  SourceStatistics last_statistics_{};
  bool has_statistics_ = false;
  bool has_estimate_ = false;
  AngleJudge yaw_;
  AngleJudge pitch_;
  AngleJudge roll_;
  Sight sight_;
  Eigen::Matrix3d mounting_ = Eigen::Matrix3d::Zero();  // by the latest estimate that counts; zero without one
  SightLoss sight_loss_;                                // of it, else of the last known misalignment
  void observe_content(const RadarScan& scan, std::int64_t now_ns);
  void judge_axes(const AlignmentEstimate& estimate);
  [[nodiscard]] Event event(RadarEvent radar_event) const;
  [[nodiscard]] SensorHealth quantities(std::int64_t now_ns);
  void set_consequences(SensorHealth& health, float speed_mps) const;
  [[nodiscard]] FreezeFrame frame_of(const SensorHealth& health, const FreezeFrame& vehicle) const;
  void test(FaultMemory& faults, std::int64_t now_ns, const SensorHealth& health, const FreezeFrame& vehicle);
  void test_axis(FaultMemory& faults, RadarEvent misaligned, RadarEvent beyond_limit, const AngleJudge& angle,
                 std::int64_t now_ns, const FreezeFrame& frame) const;
  void set_verdict(SensorHealth& health, const FaultMemory& faults) const;

  // Of the latest estimate:
  AlignmentReason reason_ = AlignmentReason::kNone;
  AlignmentFinding finding_ = AlignmentFinding::kNone;
  float finding_value_ = 0.0F;
  std::uint32_t finding_radar_ = 0;
  AlignmentValue range_rate_scale_{};
  AlignmentDrift drift_{};
  std::uint32_t step_changes_ = 0;
  double speed_scale_ = 1.0;
  double speed_scale_std_ = 0.0;
  std::array<float, 4> estimate_{};     // as in a freeze frame
  std::array<float, 10> covariance_{};  //
};

}  // namespace boresight::health
