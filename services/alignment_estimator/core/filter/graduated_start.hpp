// Finds the rotation of a radar from its first scans alone, among any number of moving objects: graduated non-convexity
// over a window of scans. One pass per scan keeps the cost of every scan similar.
// Equations: docs/algorithms/alignment.md (A21).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/scan_motion.hpp"
#include "services/alignment_estimator/core/filter/scan_sums.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"
#include "services/alignment_estimator/core/windows/scan_model.hpp"

namespace boresight::alignment {

/// Start and extent of the search.
struct StartPrior {
  windows::Point point;
  double speed_scale_variance = 1.0;
  double rotation_variance = 1.0;
  double log_angle_noise_std = 0.0;  ///< of ln(real / assumed variance of the angles)
};

/// Pitch and yaw about the vehicle's axes, and k_v. Half a second contains too little information about roll, which is
/// taken as known. So is pitch if the directions of the detections do not span three dimensions.
struct StartResult {
  double speed_scale = 1.0;
  Eigen::Matrix3d sensor_to_vehicle = Eigen::Matrix3d::Identity();
  std::array<bool, 3> searched{};                        ///< axes of the vehicle
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< of k_v and the rotation about the vehicle's axes, inflated
  double inlier_ratio = 0.0;
  Spread spread;  ///< of the window
};

class GraduatedStart {
 public:
  enum class Verdict {
    kSearching,
    kNothing,  ///< no stationary world found; the window is empty again
    kFound,
  };

  explicit GraduatedStart(const FilterConfig& config);

  /// Empties the window.
  void clear();
  /// Adds a scan to the window while there is room, and makes the passes that are due. The prior is that of the first
  /// pass; results of other radars meanwhile are applied together with the result.
  [[nodiscard]] Verdict add(const Sightings& sightings, const std::array<double, 3>& position_m,
                            const ScanMotion3d& motion, double elapsed_s, const StartPrior& prior, double angle_scale);
  [[nodiscard]] const StartResult& result() const { return result_; }

 private:
  static constexpr std::size_t kMaxScans = 64;
  static constexpr std::size_t kMaxPerScan = 96;
  static constexpr std::size_t kCapacity = 3072;
  struct Scan {
    std::size_t first, count;
    ScanMotion3d motion;
    double ambiguity_mps;
    bool has_elevation;
  };
  void store(const Sightings& sightings, const ScanMotion3d& motion);
  void begin(const StartPrior& prior);
  [[nodiscard]] windows::ScanModel model_of(const ScanMotion3d& motion, const std::array<double, 3>& position_m) const;
  void pass(const std::array<double, 3>& position_m, double angle_scale, bool last);
  [[nodiscard]] Verdict judge() const;

  FilterConfig config_;
  std::vector<double> columns_;  ///< eleven columns of kCapacity values
  std::array<Scan, kMaxScans> scans_;
  std::size_t number_of_scans_ = 0;
  std::size_t number_of_sightings_ = 0;
  double seconds_ = 0.0;
  int passes_ = 0;
  double passes_due_ = 0.0;
  double scale_mps_ = 0.0;
  StartPrior prior_;
  Eigen::Vector4d off_ = Eigen::Vector4d::Zero();
  double inliers_ = 0.0, near_ = 0.0, stationary_ = 0.0, counted_ = 0.0;
  StartResult result_;
  windows::Point point_;
};

}  // namespace boresight::alignment
