// All radars of the vehicle under one method: messages in their order in, estimates with key figures out.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "interfaces/messages/ego_motion.hpp"
#include "services/alignment_estimator/core/config.hpp"
#include "services/alignment_estimator/core/kpi/convergence.hpp"
#include "services/alignment_estimator/core/kpi/residual_statistics.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/alignment_estimator/core/plausibility/plausibility.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment {

/// Result of a scan.
enum class ScanResult : std::uint8_t {
  kUsed,          ///< processed; nothing to publish yet
  kPublish,       ///< processed, and the radar's estimate is due
  kUnknownRadar,  ///< this radar is not in the vehicle file
  kNoEgoMotion,   ///< waiting: no ego motion at the time of the scan
};

/// No allocation after construction.
class Estimator {
 public:
  /// Throws std::invalid_argument for an unknown method.
  Estimator(const VehicleConfig& vehicle, const Config& config);

  void add_ego_motion(const EgoMotion& motion) { ego_.add(motion); }
  [[nodiscard]] ScanResult add_scan(const RadarScan& scan);
  /// A scan that was rejected because its detections are copies: no estimate, but the reason for none.
  void add_rejected_scan(const RadarScan& scan);
  /// Writes everything but the header, key figures included; false for an unknown radar.
  [[nodiscard]] bool write(std::uint32_t radar_id, AlignmentEstimate& out) const;

  /// By index in the vehicle's list of radars. With a wrong input, the estimate is not converged.
  [[nodiscard]] RadarEstimate estimate(std::size_t radar) const;
  [[nodiscard]] plausibility::Finding finding(std::size_t radar) const { return plausibility_.finding(radar); }
  [[nodiscard]] const ResidualStatistics& residuals(std::size_t radar) const { return radars_[radar].residuals; }
  [[nodiscard]] const Convergence& convergence(std::size_t radar) const { return radars_[radar].convergence; }

  /// Memory over ignition cycles; without radars if the method has none.
  [[nodiscard]] Memory memory() const;
  /// To be called before the first scan; `away_s`: time since the memory was written, infinite if it is not known.
  void restore(const Memory& memory, double away_s) { method_->restore(memory, away_s); }
  /// Applies the result of a static calibration, at any time: see Method::seed(). False also for an unknown radar.
  [[nodiscard]] bool seed(const RotationSeed& seed);

 private:
  struct Radar {
    RadarConfig config;
    std::optional<Eigen::Matrix3d> actual;  ///< true rotation, if the truth is known
    bool seen = false;
    std::int64_t next_publish_ns = 0;
    std::int64_t last_time_ns = 0;
    double drive_s =
        0.0;  ///< driving time of scans given to the method at sufficient speed: the clock of the key figures
    std::uint64_t drive_scans = 0;
    std::uint64_t scans_used = 0;
    ResidualStatistics residuals;
    Convergence convergence;
  };
  void begin(std::size_t index);
  /// Gives the scan in `detections_` to the method.
  void offer(std::size_t index, const EgoSample& ego);
  void observe(std::size_t index, const EgoSample& ego, double elapsed_s);

  Config config_;
  EgoHistory ego_;
  std::unique_ptr<Method> method_;
  plausibility::Plausibility plausibility_;
  std::vector<Radar> radars_;
  ScanDetections detections_;
  std::array<double, kMaxDetections> predicted_;
};

}  // namespace boresight::alignment
