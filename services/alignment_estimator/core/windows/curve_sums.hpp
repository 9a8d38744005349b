// Sums over the detections of one scan with a curve of azimuth errors. All other parameters act through the three
// components of the sensor's velocity g, so that a detection touches 3 × 3 sums and two knots of the curve only.
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/alignment_estimator/core/filter/scan_sums.hpp"
#include "services/alignment_estimator/core/filter/sightings.hpp"
#include "services/alignment_estimator/core/windows/columns.hpp"

namespace boresight::alignment::windows {

using Curve = Eigen::Matrix<double, kKnots, 1>;

/// Places of the knots: evenly spaced over the field of view.
struct Knots {
  double first_rad = 0.0;
  double step_rad = 1.0;
};

struct CurveJudgement {
  double gate = 5.0;                                            ///< Tukey's constant
  double rate_factor = 1.0;                                     ///< of the variances
  double angle_factor = 1.0;                                    //
  Eigen::Matrix3d velocity_variance = Eigen::Matrix3d::Zero();  ///< of g as predicted: widens the gate
  double curve_variance = 0.0;                                  ///< of the curve at any azimuth: widens the gate
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();                ///< the vehicle's z axis in the sensor's
  double height_m = 0.0;                                        ///< of the sensor over the road
  double height_excess = 0.0;                                   ///< see local::kAbove
  double mirror_share = 0.0;                                    ///< see local::kMirror
  double wide_std_mps = 0.0;                                    ///< widens the gate of a radar that may have turned
};

struct CurveSums {
  /// Without the part that comes from the noise of the angles, so that score and information agree.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d score = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, kKnots, 3> curve_by_velocity = Eigen::Matrix<double, kKnots, 3>::Zero();
  Curve curve_diagonal = Curve::Zero(), curve_next = Curve::Zero(), curve_score = Curve::Zero();
  /// Of detections above and below the road.
  struct Heights {
    Eigen::Vector3d by_velocity = Eigen::Vector3d::Zero();
    Curve by_curve = Curve::Zero();
    double diagonal = 0.0, score = 0.0;
  };
  std::array<Heights, 2> heights;
  Eigen::Matrix3d wide_information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d wide_score = Eigen::Vector3d::Zero();
  double detections = 0.0;
  ScanSums common;  ///< for the noise scale and the efficiency; its information and score are not filled
};

[[nodiscard]] CurveSums sum_scan(const Sightings& sightings, const Eigen::Vector3d& velocity, const Curve& curve,
                                 const Knots& knots, const CurveJudgement& judgement);

}  // namespace boresight::alignment::windows
