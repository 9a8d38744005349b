#include "services/alignment_estimator/core/filter/step_change_detector.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "services/alignment_estimator/core/filter/common_mode.hpp"

namespace boresight::alignment {

namespace {

/// A block counts for an axis if its σ is below this share of the step change looked for.
constexpr double kMaxStdShare = 0.35;
/// Blocks with a larger σ are joined, up to this many.
constexpr int kMaxJoined = 8;
constexpr double kPriorStd_rad = 0.07;
/// Number of blocks over which the drift and the usual share of stationary detections are averaged.
constexpr double kSlowBlocks = 60.0;
constexpr double kCollapse = 0.5;
/// Fewest detections for a share of stationary ones.
constexpr double kMinDetections = 20.0;
/// A single radar cannot subtract the common part: its limit is higher by this factor.
constexpr double kSingleRadarFactor = 1.25;

}  // namespace

StepChangeDetector::StepChangeDetector(std::size_t radars, const FilterConfig& config)
    : config_(config), number_(std::min(radars, kMaxRadars)) {}

void StepChangeDetector::clear(std::size_t radar) {
  radars_[radar] = {};
}

double StepChangeDetector::sum(std::size_t radar) const {
  return *std::max_element(radars_[radar].sums.begin(), radars_[radar].sums.end());
}

std::uint32_t StepChangeDetector::add(std::size_t radar, std::int64_t time_ns, const Eigen::Matrix2d& information,
                                      const Eigen::Vector2d& score, double stationary, double detections) {
  // All radars use the same time grid of blocks, so that they can be compared.
  const auto length_ns = static_cast<std::int64_t>(config_.step_change_block_s * 1e9);
  const std::int64_t block = time_ns / length_ns;
  std::uint32_t suspicious = 0;
  if (block != block_) {
    for (std::size_t r = 0; r < number_; ++r) close(radars_[r]);
    suspicious = judge();
    block_ = block;
  }
  Radar& own = radars_[radar];
  own.active = true;
  own.information += information;
  own.score += score;
  own.stationary += stationary;
  own.detections += detections;
  return suspicious;
}

void StepChangeDetector::close(Radar& radar) const {
  radar.known = {};
  radar.collapsed = false;
  if (!radar.active) return;
  ++radar.blocks;
  if (radar.detections >= kMinDetections) {
    const double share = radar.stationary / radar.detections;
    radar.collapsed = radar.usual_share > 0.0 && share < kCollapse * radar.usual_share;
    if (radar.usual_share < 0.0) radar.usual_share = share;
    if (!radar.collapsed) radar.usual_share += (share - radar.usual_share) / kSlowBlocks;
  }
  Eigen::Matrix2d information = radar.information;
  information.diagonal().array() += 1.0 / (kPriorStd_rad * kPriorStd_rad);
  const Eigen::Matrix2d covariance = information.inverse();
  radar.deviation = covariance * radar.score;
  const std::array<double, 2> limit{config_.step_change_pitch_rad, config_.step_change_yaw_rad};
  bool all = true;
  for (std::size_t a = 0; a < 2; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    radar.known[a] = std::sqrt(covariance(axis, axis)) < kMaxStdShare * limit[a] && radar.deviation.allFinite();
    all = all && radar.known[a];
  }
  // In a block whose share collapsed, only the share counts, not the deviation of its few remaining detections.
  if (radar.collapsed) radar.known = {};
  if (all || radar.collapsed || radar.known[1] || radar.blocks >= kMaxJoined) {
    radar.information.setZero();
    radar.score.setZero();
    radar.stationary = radar.detections = 0.0;
    radar.blocks = 0;
  }
}

double StepChangeDetector::common(std::size_t radar, Eigen::Index axis) const {
  std::array<Deviation, kMaxRadars> others;
  std::size_t count = 0;
  for (std::size_t r = 0; r < number_; ++r) {
    if (r != radar && radars_[r].known[static_cast<std::size_t>(axis)]) others[count++] = {radars_[r].deviation(axis)};
  }
  return common_mode({others.data(), count}, radars_[radar].deviation(axis)).value_rad;
}

std::uint32_t StepChangeDetector::judge() {
  std::uint32_t suspicious = 0;
  const std::array<double, 2> limits{config_.step_change_pitch_rad, config_.step_change_yaw_rad};
  for (std::size_t r = 0; r < number_; ++r) {
    Radar& radar = radars_[r];
    if (!radar.active) continue;
    std::size_t others = 0, others_collapsed = 0;
    for (std::size_t q = 0; q < number_; ++q) {
      if (q == r || !radars_[q].active) continue;
      ++others;
      if (radars_[q].collapsed) ++others_collapsed;
    }
    for (std::size_t a = 0; a < 2; ++a) {
      if (!radar.known[a]) continue;
      const auto axis = static_cast<Eigen::Index>(a);
      radar.own(axis) = radar.deviation(axis) - common(r, axis);
      const double limit = others == 0 ? kSingleRadarFactor * limits[a] : limits[a];
      const double d = radar.own(axis) / limit;
      // One block alone is no step change: it counts at most like a deviation of twice the limit.
      double& up = radar.sums[2 * a];
      double& down = radar.sums[2 * a + 1];
      up = std::max(0.0, up + std::min(d - 1.0, 1.0));
      down = std::max(0.0, down + std::min(-d - 1.0, 1.0));
      if (std::abs(d) < 1.0) radar.drift(axis) += (radar.own(axis) - radar.drift(axis)) / kSlowBlocks;
    }
    // A collapse of all radars at once is not a step change of one radar.
    double& collapse = radar.sums[4];
    const bool alone = radar.collapsed && 2 * others_collapsed <= others;
    collapse = std::max(0.0, collapse + (alone ? 1.0 : -1.0));
    if (sum(r) > config_.step_change_sum_blocks) suspicious |= 1u << r;
  }
  return suspicious;
}

}  // namespace boresight::alignment
