// Detects a sudden change of one radar's mounting, as distinct from noise, drift and effects common to all radars.
// Equations: docs/algorithms/alignment.md (A24).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "interfaces/messages/header.hpp"
#include "services/alignment_estimator/core/filter/config.hpp"

namespace boresight::alignment {

/// Cumulative sums over short blocks of each radar's own deviation from its estimate, in yaw and pitch about the
/// vehicle's axes. The median deviation of the other radars is subtracted, since an error of speed, yaw rate or body
/// moves all radars. After a very large step change the detections fall outside the gate; the share of stationary
/// detections then collapses for this radar only.
class StepChangeDetector {
 public:
  StepChangeDetector(std::size_t radars, const FilterConfig& config);

  /// Adds one scan of a running radar: information and score about the vehicle's y and z axes at the present estimate,
  /// and the number of stationary detections. At the end of a block, returns the set of radars (bit by index) whose
  /// sums exceed the limit.
  [[nodiscard]] std::uint32_t add(std::size_t radar, std::int64_t time_ns, const Eigen::Matrix2d& information,
                                  const Eigen::Vector2d& score, double stationary, double detections);
  /// Clears a radar's sums (new estimate).
  void clear(std::size_t radar);

  /// Largest of the radar's sums, in units of blocks; above FilterConfig::step_change_sum_blocks it is a suspicion.
  [[nodiscard]] double sum(std::size_t radar) const;
  /// Own deviation of the radar in its last block, (pitch axis, yaw axis) in rad; and its slow mean, which shows a
  /// drift.
  [[nodiscard]] const Eigen::Vector2d& deviation(std::size_t radar) const { return radars_[radar].own; }
  [[nodiscard]] const Eigen::Vector2d& drift(std::size_t radar) const { return radars_[radar].drift; }
  /// Whether the share of stationary detections is far below the radar's usual one.
  [[nodiscard]] bool collapsed(std::size_t radar) const { return radars_[radar].collapsed; }

 private:
  struct Radar {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d score = Eigen::Vector2d::Zero();
    double stationary = 0.0, detections = 0.0;
    int blocks = 0;
    // Of the last block.
    Eigen::Vector2d deviation = Eigen::Vector2d::Zero(), own = Eigen::Vector2d::Zero();
    std::array<bool, 2> known{};
    bool collapsed = false;
    // Over blocks.
    std::array<double, 5> sums{};  // pitch +, −, yaw +, −, collapse
    Eigen::Vector2d drift = Eigen::Vector2d::Zero();
    double usual_share = -1.0;
    bool active = false;
  };
  void close(Radar& radar) const;
  [[nodiscard]] double common(std::size_t radar, Eigen::Index axis) const;
  [[nodiscard]] std::uint32_t judge();

  FilterConfig config_;
  std::size_t number_;
  std::int64_t block_ = 0;
  std::array<Radar, kMaxRadars> radars_;
};

}  // namespace boresight::alignment
