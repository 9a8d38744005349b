// Finds a radar's parameters from its first scans alone: graduated non-convexity over a window of scans. One pass per
// scan keeps the cost of every scan similar.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "services/alignment_estimator/core/planar/config.hpp"
#include "services/alignment_estimator/core/planar/planar_sums.hpp"
#include "services/alignment_estimator/core/planar/support.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"

namespace boresight::alignment::planar {

class PlanarStart {
 public:
  enum class Verdict {
    kSearching,
    kNothing,  ///< no stationary world found; the window is empty again
    kFound,
  };

  /// Allocates the window.
  explicit PlanarStart(const PlanarConfig& config);

  void clear();
  /// Adds this scan to the window, or makes a pass if the window is full. The prior has the mean `prior_mean` and the
  /// stds of the configuration.
  [[nodiscard]] Verdict add(const ScanDetections& scan, const Setting& setting, double elapsed_s,
                            const Parameters& prior_mean);

  // Once found:
  [[nodiscard]] const Parameters& parameters() const { return at_; }
  /// Information of the window's detections without the prior, at parameters().
  [[nodiscard]] const Square& information() const { return information_; }
  [[nodiscard]] double inlier_ratio() const { return inlier_ratio_; }

 private:
  static constexpr std::size_t kMaxScans = 64, kMaxPerScan = 128, kCapacity = 4096, kMinDetections = 150;
  static constexpr std::size_t kColumns = 6;
  struct Scan {
    std::size_t first, count;
    double speed_mps, yaw_rate_radps, ambiguity_mps;
  };
  void store(const ScanDetections& scan, const Setting& setting);
  void pass(const MountingPose& nominal, const Parameters& prior_mean, double added_variance);

  PlanarConfig config_;
  std::vector<double> columns_;  ///< kColumns of kCapacity
  std::array<Scan, kMaxScans> scans_;
  std::size_t number_of_scans_ = 0, number_of_detections_ = 0;
  double seconds_ = 0.0;
  bool has_elevation_ = true;
  int passes_ = 0;
  double scale_mps_ = 0.0;
  Parameters at_ = Parameters::Zero();
  Square information_ = Square::Zero();
  double inlier_ratio_ = 0.0;
};

}  // namespace boresight::alignment::planar
