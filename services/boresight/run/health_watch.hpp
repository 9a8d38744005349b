// The judgement of the health service on every radar, on the recording's clock. Services do not exist offline, so that
// only radars are judged.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/boresight/run/results.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/config.hpp"
#include "services/health/core/sensor_monitor.hpp"

namespace boresight::run {

class HealthWatch {
 public:
  /// Called with a verdict and its time on the clock of advance().
  using Report = std::function<void(const HealthResult& verdicts, std::int64_t now_ns)>;

  HealthWatch(const VehicleConfig& vehicle, const health::Config& config) : vehicle_(vehicle), config_(config) {}

  /// Starts the supervision at this time.
  void start(std::int64_t now_ns);
  [[nodiscard]] bool is_started() const { return !sensors_.empty(); }

  /// Judges at every period of the service up to this time, and reports once a second and when a verdict has changed.
  /// `sources` are the gateway's counts; they are taken at the period of its heartbeat. A pause of the recording of
  /// more than ten seconds is not judged any further. A clock that goes back by more than a second begins again.
  void advance(std::int64_t now_ns, std::span<const SourceStatistics> sources, const Report& report);
  /// Judges once more at the end.
  void finish(std::span<const SourceStatistics> sources, const Report& report);

  /// A scan that arrived at the time of the last advance().
  void observe(const RadarScan& scan);
  void observe(const AlignmentEstimate& estimate);
  void observe(const EgoMotion& motion);

 private:
  [[nodiscard]] health::SensorMonitor* sensor(std::uint32_t radar_id);
  void take(std::span<const SourceStatistics> sources, std::int64_t own_ns);
  void judge(std::int64_t own_ns, bool always, const Report& report);

  VehicleConfig vehicle_;
  health::Config config_;
  std::optional<health::FaultMemory> faults_;  // of this drive
  health::FreezeFrame vehicle_frame_;
  std::vector<health::SensorMonitor> sensors_;
  AlignmentVehicleChange load_change_{}, speed_change_{};  ///< the latest that an estimate reported
  HealthResult reported_;
  bool has_reported_ = false;
  std::int64_t reported_ns_ = 0;
  std::int64_t offset_ns_ = 0;  ///< own clock, which never goes back, minus that of advance()
  std::int64_t own_ns_ = 0;     ///< of the last advance()
  std::int64_t next_judgement_ns_ = 0, next_report_ns_ = 0, next_heartbeat_ns_ = 0;
};

}  // namespace boresight::run
