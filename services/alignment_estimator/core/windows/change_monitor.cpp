#include "services/alignment_estimator/core/windows/change_monitor.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/filter/common_mode.hpp"

namespace boresight::alignment::windows {

Deviation2 deviation_of(const Block& block, double scale_variance, double roll_variance, double rotation_variance,
                        bool has_elevation, double common_scale, const ChangeConfig& config) {
  Deviation2 out;
  if (block.scans == 0 || block.stationary < config.least_detections) return out;
  Eigen::Matrix4d information = block.wide_information;
  const double known = 1e12;
  information.diagonal() += Eigen::Vector4d(1.0 / std::max(scale_variance, 1e-12),
                                            has_elevation ? 1.0 / std::max(roll_variance, 1e-12) : known,
                                            has_elevation ? 1.0 / rotation_variance : known, 1.0 / rotation_variance);
  const Eigen::Matrix4d covariance = information.inverse();
  const Eigen::Vector4d turn = covariance * (block.wide_score - common_scale * block.wide_information.col(0));
  out.value = turn.tail<2>();
  out.std = (covariance.diagonal().tail<2>().cwiseMax(0.0) + Eigen::Vector2d(0.0, block.turn_variance)).cwiseSqrt();
  out.valid = out.value.allFinite() && out.std(1) < 0.5 * config.yaw_rad;
  return out;
}

ScaleDeviation scale_deviation_of(const Block& block, const Eigen::Vector3d& rotation_variances, double scale_variance,
                                  bool has_elevation, const ChangeConfig& config) {
  if (block.scans == 0 || block.stationary < config.least_detections) return {};
  Eigen::Matrix4d information = block.wide_information;
  const double known = 1e12;
  information(0, 0) += 1.0 / scale_variance;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_known = axis < 2 && !has_elevation;
    information(axis + 1, axis + 1) += is_known ? known : 1.0 / std::max(rotation_variances(axis), 1e-12);
  }
  const Eigen::Matrix4d covariance = information.inverse();
  const double value = covariance.row(0).dot(block.wide_score), variance = covariance(0, 0);
  if (!std::isfinite(value) || !(variance > 0.0)) return {};
  return {value, std::sqrt(variance)};
}

double ChangeMonitor::scatter(const History& history, std::size_t size, int axis) const {
  const double prior = axis == 0 ? config_.pitch_scatter_rad : config_.yaw_scatter_rad;
  if (size == 0) return prior;
  History sorted = history;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(size / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(size));
  const double windows = static_cast<double>(size);
  return (*middle / 0.6745 * windows + config_.prior_blocks * prior) / (windows + config_.prior_blocks);
}

void ChangeMonitor::restart(std::size_t index) {
  Radar& radar = radars_[index];
  radar.size = radar.next = 0;
}

void ChangeMonitor::judge(const std::vector<Deviation2>& deviations, std::vector<ChangeVerdict>& verdicts) {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    verdicts[r] = {};
    if (!deviations[r].valid) continue;
    Radar& radar = radars_[r];
    const Eigen::Vector2d value = deviations[r].value;
    Eigen::Vector2d common = Eigen::Vector2d::Zero();
    for (int axis = 0; axis < 2; ++axis) {
      std::array<Deviation, kMaxRadars> others;
      std::size_t count = 0;
      for (std::size_t o = 0; o < radars_.size(); ++o) {
        if (o == r || !deviations[o].valid) continue;
        others[count++] = {deviations[o].value(axis), deviations[o].std(axis) * deviations[o].std(axis)};
      }
      common(axis) = common_mode({others.data(), count}, value(axis)).value_rad;
    }
    radar.value[radar.next] = value;
    radar.own[radar.next] = value - common;
    radar.std[radar.next] = deviations[r].std;
    radar.next = (radar.next + 1) % kBlocks;
    radar.size = std::min(radar.size + 1, kBlocks);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero(), own_mean = mean;
    for (std::size_t i = 0; i < radar.size; ++i) {
      mean += radar.value[i] / static_cast<double>(radar.size);
      own_mean += radar.own[i] / static_cast<double>(radar.size);
    }
    for (int axis = 0; axis < 2; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double least = axis == 0 ? config_.pitch_rad : config_.yaw_rad;
      const double beyond = std::max(least, config_.common_factor * deviations[r].estimate_std(axis));
      const double limit =
          std::max(beyond, config_.scatter_factor * scatter(radar.own_history[a], radar.history_size, axis));
      const double all_limit =
          std::max(beyond, config_.common_factor * scatter(radar.history[a], radar.history_size, axis));
      const double own = value(axis) - common(axis);
      verdicts[r].suspect |= std::abs(value(axis)) > all_limit && std::abs(own) > 0.7 * limit;
      if (radar.size < kBlocks || !(deviations[r].std(axis) < 0.5 * least)) continue;
      bool same_sign = true;
      std::size_t large = 0;
      for (const Eigen::Vector2d& one : radar.value) {
        same_sign &= one(axis) * mean(axis) > 0.0;
        large += std::abs(one(axis)) > 0.5 * limit ? 1 : 0;
      }
      verdicts[r].changed |=
          std::abs(mean(axis)) > all_limit && std::abs(own_mean(axis)) > limit && same_sign && large + 1 >= kBlocks;
    }
    if (verdicts[r].changed) {
      // The first of the blocks may be from before the change.
      for (std::size_t back = 1; back <= 3; ++back) {
        verdicts[r].turn_rad += radar.value[(radar.next + kBlocks - back) % kBlocks] / 3.0;
      }
    } else if (radar.size == kBlocks) {
      for (std::size_t a = 0; a < 2; ++a) {
        radar.history[a][radar.history_next] = std::abs(mean(static_cast<int>(a)));
        radar.own_history[a][radar.history_next] = std::abs(own_mean(static_cast<int>(a)));
      }
      radar.history_next = (radar.history_next + 1) % kHistory;
      radar.history_size = std::min(radar.history_size + 1, kHistory);
    }
  }
}

}  // namespace boresight::alignment::windows
