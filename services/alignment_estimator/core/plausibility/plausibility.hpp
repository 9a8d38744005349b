// Wrong inputs, named: what a mounting error cannot explain (docs/algorithms/plausibility.md).
//
// Every half second each radar's velocity follows from its detections alone. Hypotheses about the inputs predict it
// from the nominal mounting and the signalled motion, each with its own mounting error, scale and slip. The one whose
// likelihood exceeds all others by far is reported.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/alignment_estimate.hpp"
#include "services/alignment_estimator/core/plausibility/config.hpp"
#include "services/alignment_estimator/core/plausibility/copies.hpp"
#include "services/alignment_estimator/core/plausibility/hypothesis.hpp"
#include "services/alignment_estimator/core/plausibility/speed_signal.hpp"
#include "services/alignment_estimator/core/plausibility/velocity_window.hpp"
#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/common/estimation/ego_history.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::alignment::plausibility {

/// Speed signals in these units are so many times the speed in m/s.
inline constexpr double kKmhPerMps = 3.6, kMphPerMps = 2.23694;

/// As in AlignmentEstimate.
struct Finding {
  AlignmentFinding finding = AlignmentFinding::kNone;
  double value = 0.0;
  std::uint32_t radar = 0;
};

/// No allocation after construction.
class Plausibility {
 public:
  Plausibility(const VehicleConfig& vehicle, const PlausibilityConfig& config);

  /// Takes every scan of the radar at index `radar`, also those without valid ego motion.
  void add(std::size_t radar, const ScanDetections& scan, const EgoSample& ego);
  /// Takes a scan that was rejected because its detections are copies.
  void add_rejected(std::size_t radar, const ScanDetections& scan);
  [[nodiscard]] Finding finding(std::size_t radar) const { return radars_[radar].finding; }
  /// Logarithm of the likelihood of a hypothesis, relative to the best of this radar: for tests and diagnosis.
  [[nodiscard]] double log_likelihood(std::size_t radar, std::size_t hypothesis) const {
    return radars_[radar].totals[hypothesis];
  }

 private:
  /// Hypotheses; the first five are about one radar, and so are those from kOther on.
  enum : std::size_t { kRight, kNominalYaw, kAzimuth, kRangeRate, kYawRate, kKmh, kMph, kDegrees, kOther };
  static constexpr std::size_t kFirstSignal = kYawRate;
  static constexpr std::size_t kMostHypotheses = kOther + kMaxRadars;

  /// The signalled motion in a window.
  struct Motion {
    double speed_mps = 0.0, yaw_rate_radps = 0.0;
    double first_speed_mps = 0.0, first_yaw_rate_radps = 0.0, last_speed_mps = 0.0, last_yaw_rate_radps = 0.0;
    double scans = 0.0, valid = 0.0;
  };
  struct Radar {
    std::uint32_t id = 0;
    std::array<double, 2> position_m{};
    Eigen::Matrix2d to_sensor = Eigen::Matrix2d::Identity(), to_vehicle = Eigen::Matrix2d::Identity();
    std::size_t most_per_scan = 0;
    VelocityWindow window;
    Motion motion;
    std::int64_t start_ns = 0, last_ns = 0;
    Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();  ///< the last fit
    std::vector<Hypothesis> hypotheses;
    std::array<double, kMostHypotheses> logs{};    ///< of the likelihoods, relative to the largest
    std::array<double, kMostHypotheses> totals{};  ///< with the limits of the yaw
    double best_total = 0.0;                       ///< of the hypotheses about one radar, with prior
    std::size_t windows = 0;                       ///< that have been counted
    Finding candidate, finding;
    double candidate_since_s = 0.0;
  };
  /// An explanation of a radar's data and its logarithm of the likelihood with prior.
  struct Best {
    std::size_t hypothesis = kRight, second = kRight;
    double log = 0.0, second_log = 0.0, third_log = 0.0;
  };

  void close(std::size_t radar, double time_s);
  void weigh(std::size_t radar, const VelocityFit& fit, double seconds);
  [[nodiscard]] double add_deviation(Radar& radar, std::size_t hypothesis, const VelocityFit& fit, double seconds,
                                     double background);
  void add_limits(Radar& radar) const;
  [[nodiscard]] bool is_of_radar(std::size_t hypothesis) const {
    return hypothesis < kFirstSignal || hypothesis >= kOther;
  }
  void decide(std::size_t radar, double time_s);
  [[nodiscard]] Best explain(std::size_t radar) const;
  [[nodiscard]] bool is_mutual(std::size_t radar, std::size_t other) const;
  [[nodiscard]] Finding name(std::size_t radar, const Best& best, double margin) const;
  void report(Radar& radar, const Finding& found, double time_s) const;

  PlausibilityConfig config_;
  std::vector<Radar> radars_;
  Copies copies_;
  SpeedSignal speed_signal_;
};

}  // namespace boresight::alignment::plausibility
