// Scans of one radar, linearised at a given point of the model and summed into blocks.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/config.hpp"
#include "services/alignment_estimator/core/filter/efficiency.hpp"
#include "services/alignment_estimator/core/filter/noise_scale.hpp"
#include "services/alignment_estimator/core/filter/scan_motion.hpp"
#include "services/alignment_estimator/core/filter/sightings.hpp"
#include "services/alignment_estimator/core/filter/spread.hpp"
#include "services/alignment_estimator/core/windows/block.hpp"
#include "services/alignment_estimator/core/windows/config.hpp"
#include "services/alignment_estimator/core/windows/output.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/estimation/unknown_elevation.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::windows {

class RadarSums {
 public:
  /// What the residuals have shown of the radar: it outlasts a block.
  struct Learnt {
    NoiseScale noise;
    Efficiency efficiency;
  };
  /// Numbers of detections of a scan.
  struct Counts {
    double detections = 0.0, stationary = 0.0, inliers = 0.0;
  };
  RadarSums(const RadarConfig& radar, const FilterConfig& filter, const Priors& priors, const SumsConfig& config);

  /// Driving time that a scan stands for: since the scan before, or a cycle after a gap.
  [[nodiscard]] double elapsed_s(std::int64_t time_ns);
  /// The detections of a scan that can be used. False: too few.
  [[nodiscard]] bool take(const ScanDetections& scan, Sightings& sightings) const;
  /// Begins a block. Residuals are those at `point`, derivatives those at `derivatives_at`: along a direction that the
  /// data do not determine, derivatives that follow the estimate would pose as information. `covariance` of the local
  /// parameters widens the gate, after a start by more.
  void begin_block(const Point& point, const Point& derivatives_at, const LocalMatrix& covariance, bool is_start);
  Counts add(const Sightings& sightings, const ScanMotion3d& motion, const EgoSample& ego, double elapsed_s);

  [[nodiscard]] const Block& block() const { return block_; }
  [[nodiscard]] const Eigen::Matrix3d& linearised() const { return derivatives_at_.sensor_to_vehicle; }
  [[nodiscard]] const Knots& knots() const { return knots_; }
  [[nodiscard]] const UnknownElevation& unknown_elevation() const { return unknown_; }
  [[nodiscard]] Unmeasured unmeasured() const { return {lowering_, mean_sine_}; }
  [[nodiscard]] const Learnt& learnt() const { return learnt_; }
  void set_learnt(const Learnt& learnt) { learnt_ = learnt; }
  [[nodiscard]] double angle_noise_scale() const { return std::sqrt(learnt_.noise.angle_variance_factor()); }
  [[nodiscard]] double range_rate_noise_scale() const { return std::sqrt(learnt_.noise.rate_variance_factor()); }
  /// See NoiseScale::set_scales().
  void set_noise_scales(double range_rate, double angle) { learnt_.noise.set_scales(range_rate, angle); }
  void set_spread(const Spread& spread) { spread_ = spread; }

 private:
  [[nodiscard]] MotionVariances variances_of(const EgoSample& ego, bool has_elevation) const;
  [[nodiscard]] CurveJudgement judgement_of(const ScanModel& model, const MotionVariances& variances,
                                            double speed_mps) const;
  [[nodiscard]] ScanModel model_of(const ScanMotion3d& motion) const;
  /// Takes away the directions of which only the noise of the angles speaks; returns the number of the others.
  int keep_supported(double elapsed_s, bool has_elevation, CurveSums& sums, ScanModel& model);
  void note_unmeasured(const CurveSums& sums, double elapsed_s);
  void note_turn(const ScanModel& model, double speed_mps);

  RadarConfig radar_;
  FilterConfig filter_;
  SumsConfig config_;
  double body_pitch_variance_, side_slip_variance_;
  UnknownElevation unknown_;
  Knots knots_;
  Learnt learnt_;
  Spread spread_;
  Block block_;
  Point derivatives_at_;
  /// Of the parameters that widen the gate, and of the curve at any azimuth.
  Eigen::Matrix<double, local::kCurve, local::kCurve> gate_covariance_;
  double curve_variance_ = 0.0;
  /// Sliding means of a radar without elevation: reduction of its range rates, and sine of the elevation.
  double lowering_ = 0.0, mean_sine_ = 0.0;
  std::int64_t last_time_ns_ = 0;
};

}  // namespace boresight::alignment::windows
