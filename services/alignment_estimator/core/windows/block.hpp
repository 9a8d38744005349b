// Information of one radar about its model's parameters, summed over its scans.
#pragma once

#include <array>

#include "services/alignment_estimator/core/filter/sightings.hpp"
#include "services/alignment_estimator/core/windows/curve_sums.hpp"
#include "services/alignment_estimator/core/windows/scan_model.hpp"

namespace boresight::alignment::windows {

/// Score s and information L of the local parameters at `point`: the log likelihood of a difference d from the point is
/// s·d − ½ d·L·d.
struct Block {
  Point point;
  LocalVector score = LocalVector::Zero();
  LocalMatrix information = LocalMatrix::Zero();
  /// The same of rate scale and rotation with a wide gate, which also a suddenly turned radar passes.
  Eigen::Vector4d wide_score = Eigen::Vector4d::Zero();
  Eigen::Matrix4d wide_information = Eigen::Matrix4d::Zero();
  double detections = 0.0, stationary = 0.0;
  /// Largest variance of a yaw by errors of the other parameters (rad²): in a turn, of stamps, positions, gain and
  /// slip.
  double turn_variance = 0.0;
  double seconds = 0.0;
  int scans = 0;

  void clear(const Point& at) {
    *this = Block();
    point = at;
  }
};

/// Variances of the errors of the motion (ScanModel::by_motion).
using MotionVariances = std::array<double, kMotionErrors>;

/// Factors that make information and score of a robust loss those of its covariance (Efficiency).
struct LossFactors {
  double information = 1.0, score = 1.0;
};

/// Adds the sums of one scan; the errors of its motion are eliminated. No allocation.
void add_scan(Block& block, const ScanModel& model, const CurveSums& sums, const MotionVariances& variances,
              const LossFactors& factors);

}  // namespace boresight::alignment::windows
