#include "services/alignment_estimator/core/filter/small_step_change_detector.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/filter/common_mode.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::alignment {

namespace {

/// Lengths of the windows about x, y, z, in units of FilterConfig::step_change_window_s.
constexpr std::array<std::int64_t, 3> kLengths{16, 1, 1};
/// Roll is measured only in turns and while the body pitches. Up to this many windows are joined until σ is small
/// enough.
constexpr std::array<int, 3> kMostJoined{8, 1, 1};
constexpr double kJoinedUntil_rad = 0.8 * kRadiansPerDegree;
/// Roll is hardly above the noise even then. There are fewer windows and so fewer chances of a false alarm, so the
/// limits are lower (shares of the configured σ).
constexpr std::array<double, 3> kLimitShare{0.6, 1.0, 1.0};
/// σ of unmodelled effects, such as the scene or the load: with other radars for comparison, and for a single radar, to
/// which side slip and body pitch look like a change of its mounting.
constexpr std::array<double, 3> kFloor_rad{0.2 * kRadiansPerDegree, 0.05 * kRadiansPerDegree, 0.02 * kRadiansPerDegree};
constexpr std::array<double, 3> kAloneFloor_rad{1.0 * kRadiansPerDegree, 0.25 * kRadiansPerDegree,
                                                0.1 * kRadiansPerDegree};
/// σ of the two axes beside the tested one. The std of the estimate does not bound them, because it does not include a
/// change; the possible mountings do. The rotation about x, which a window hardly measures, keeps the estimate's std.
constexpr double kLooseStd_rad = 0.07;
/// A radar whose variance of the axis is larger by this factor is not used for comparison.
constexpr double kComparable = 9.0;

/// A median of three or more has at most this share of the variance of one.
constexpr double kMedianShare = 0.5;

/// Factors of the sums: after each window, so that they decay, and after an unconfirmed suspicion.
constexpr double kKept = 0.9, kKeptUnconfirmed = 0.5;
/// Share of its limit beyond which a sum counts as doubt.
constexpr double kSuspiciousShare = 0.5;

}  // namespace

SmallStepChangeDetector::SmallStepChangeDetector(std::size_t radars, const FilterConfig& config)
    : config_(config), number_(std::min(radars, kMaxRadars)) {}

void SmallStepChangeDetector::clear(std::size_t radar) {
  radars_[radar] = {};
}

double SmallStepChangeDetector::sum(std::size_t radar, std::size_t axis) const {
  const std::array<double, 2>& sums = radars_[radar].axes[axis].sums;
  return (sums[0] >= sums[1] ? sums[0] : -sums[1]) / (kLimitShare[axis] * config_.step_change_small_sum_stds);
}

double SmallStepChangeDetector::confirming_stds(const FilterConfig& config, std::size_t axis) {
  return kLimitShare[axis] * config.step_change_small_confirm_stds;
}

bool SmallStepChangeDetector::doubted(std::size_t radar) const {
  const auto& axes = radars_[radar].axes;
  return axes[1].suspected != 0 || axes[2].suspected != 0 || std::abs(sum(radar, 1)) > kSuspiciousShare ||
         std::abs(sum(radar, 2)) > kSuspiciousShare;
}

std::uint32_t SmallStepChangeDetector::add(std::size_t radar, std::int64_t time_ns, const Eigen::Matrix3d& information,
                                           const Eigen::Vector3d& score, const Eigen::Matrix3d& covariance) {
  std::uint32_t changed = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    // All radars use the same time grid of windows, so that they can be compared.
    const auto length_ns = kLengths[a] * static_cast<std::int64_t>(config_.step_change_window_s * 1e9);
    const std::int64_t window = time_ns / length_ns;
    if (window != window_[a]) {
      close(a);
      for (std::size_t r = 0; r < number_; ++r) {
        if (judge(r, a)) changed |= 1u << r;
      }
      window_[a] = window;
    }
    Axis& own = radars_[radar].axes[a];
    if (!own.active) own.covariance = covariance;
    own.active = true;
    own.information += information;
    own.score += score;
  }
  return changed;
}

void SmallStepChangeDetector::close(std::size_t a) {
  const auto i = static_cast<Eigen::Index>(a);
  for (std::size_t r = 0; r < number_; ++r) {
    Axis& axis = radars_[r].axes[a];
    Eigen::Matrix3d information = axis.information;
    information.diagonal().array() += 1.0 / square(kLooseStd_rad);
    if (a != 0) information(0, 0) += 1.0 / (axis.covariance(0, 0) + square(kFloor_rad[0]));
    const Eigen::Matrix3d inverse = information.inverse();
    axis.deviation_rad = inverse.row(i).dot(axis.score);
    axis.variance = inverse(i, i) + axis.covariance(i, i);
    axis.known = axis.active && std::isfinite(axis.deviation_rad) && axis.variance > 0.0;
    ++axis.joined;
    axis.ended = !axis.known || axis.joined >= kMostJoined[a] || inverse(i, i) < square(kJoinedUntil_rad);
    if (!axis.ended) continue;
    axis.information.setZero();
    axis.score.setZero();
    axis.joined = 0;
    axis.active = false;
  }
}

bool SmallStepChangeDetector::judge(std::size_t r, std::size_t a) {
  Axis& axis = radars_[r].axes[a];
  axis.confirmed = false;
  if (!axis.ended) return false;
  axis.stds = 0.0;
  if (!axis.known) return false;
  std::array<Deviation, kMaxRadars> others;
  std::size_t count = 0;
  for (std::size_t q = 0; q < number_; ++q) {
    const Axis& other = radars_[q].axes[a];
    if (q != r && other.known && other.variance < kComparable * (axis.variance + square(kFloor_rad[a]))) {
      others[count++] = {other.deviation_rad, other.variance};
    }
  }
  const Deviation common = common_mode({others.data(), count}, axis.deviation_rad);
  const double own = axis.deviation_rad - common.value_rad;
  const double variance = axis.variance + (count > 2 ? kMedianShare : 1.0) * common.variance +
                          square(count == 0 ? kAloneFloor_rad[a] : kFloor_rad[a]);
  axis.stds = own / std::sqrt(variance);
  radars_[r].own(static_cast<Eigen::Index>(a)) = own;
  if (axis.suspected != 0) {
    axis.confirmed = axis.suspected * axis.stds > confirming_stds(config_, a);
    axis.suspected = 0;
    for (double& sum : axis.sums) sum *= kKeptUnconfirmed;
    return axis.confirmed;
  }
  const double limit = kLimitShare[a] * config_.step_change_small_sum_stds;
  for (std::size_t s = 0; s < 2; ++s) {
    const double excess = (s == 0 ? axis.stds : -axis.stds) - kLimitShare[a] * config_.step_change_small_stds;
    // One window alone cannot reach the limit.
    axis.sums[s] = std::max(0.0, kKept * axis.sums[s] + std::min(excess, 0.7 * limit));
    if (axis.sums[s] > limit) axis.suspected = s == 0 ? 1 : -1;
  }
  return false;
}

}  // namespace boresight::alignment
