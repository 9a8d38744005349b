// Range-rate residuals of a whole drive before and after the correction. A sample of scans is kept in bounded memory
// and evaluated with the final estimate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/alignment_estimator/core/batch_calibration/batch_calibration.hpp"
#include "services/alignment_estimator/core/method.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

/// Key figures of Burza 2025, §8; NaN where there are no residuals.
struct Moments {
  double rmse_mps = 0.0;
  double skewness = 0.0;
  double kurtosis = 0.0;  ///< 3 for a Gaussian
};
[[nodiscard]] Moments moments(const std::vector<double>& residuals);

/// Equal bins over −limit … limit; values beyond are not counted.
struct Histogram {
  static constexpr std::size_t kBins = 81;
  double limit_mps = 0.0;
  std::array<std::uint64_t, kBins> before{}, after{};
};

struct ResidualSummary {
  /// Of detections that are stationary by the final estimate: their residual is within four stds of the noise.
  Moments before, after;
  double inlier_ratio = 0.0;  ///< NaN without detections
  std::uint64_t judged = 0;   ///< detections in the sample
  Histogram histogram{};      ///< of all detections of the sample
};

class ResidualSample {
 public:
  void add(const alignment::ScanDetections& scan, const EgoSample& ego);
  /// The sample in the form of the batch calibration, which needs all detections at once.
  [[nodiscard]] alignment::batch_calibration::Recording recording(const MountingPose& nominal,
                                                                  bool has_elevation) const;
  /// `nominal` is R(sensor→vehicle) as configured.
  [[nodiscard]] ResidualSummary judge(const alignment::RadarEstimate& estimate, const RadarConfig& radar,
                                      const Eigen::Matrix3d& nominal) const;

 private:
  static constexpr std::size_t kMostDetections = std::size_t{1} << 18;
  struct Scan {
    float speed_mps, yaw_rate_radps;
    float ambiguity_mps;
    std::size_t first, count;
  };
  struct Detection {
    float azimuth_rad, elevation_rad, range_rate_mps, azimuth_std_rad, elevation_std_rad, range_rate_std_mps;
  };
  void halve();
  std::vector<Scan> scans_;
  std::vector<Detection> detections_;
  std::uint64_t stride_ = 1, count_ = 0;
};

}  // namespace boresight::align
