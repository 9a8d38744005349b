// What changes in the drive: load, and mountings by sudden misalignment.
#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/batch/batch.hpp"
#include "services/alignment_estimator/core/windows/output.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::batch {

using namespace windows;

std::optional<std::size_t> Batch::Radar::phase_of(std::size_t block, std::size_t delay_blocks) const {
  std::size_t phase = 0;
  for (const Change& change : changes) {
    if (block > change.block) {
      ++phase;
    } else if (block + delay_blocks > change.block) {
      return std::nullopt;
    }
  }
  return phase;
}

Eigen::Matrix3d Batch::Radar::turned_back(std::size_t phase) const {
  if (phase == 0 && first_from_last) return *first_from_last;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (std::size_t i = changes.size(); i > phase; --i) {
    turn = geometry::so3_exp(-changes[i - 1].turn_vehicle_rad) * turn;
  }
  return turn;
}

Segments Batch::assembled(Side side, const std::vector<std::size_t>& loads) const {
  Segments segments = segments_;
  const std::size_t speed_change = speed_reports_.empty() ? 0 : window_of(speed_reports_.back());
  for (int i = 0; i < segments.size(); ++i) {
    const std::size_t window = window_[static_cast<std::size_t>(i)];
    segments.segment(i).load = loads_before(loads, window);
    const bool load_changes = std::find(loads.begin(), loads.end(), window) != loads.end();
    const bool has_old_speed = !speed_reports_.empty() && window <= speed_change;
    for (std::size_t r = 0; r < radars_.size(); ++r) {
      Share& share = segments.share(i, r);
      if (load_changes) windows::forget(share, local::kRotation + 1, 1);
      if (has_old_speed) windows::forget(share, local::kSpeedScale, 1);
      const std::size_t wanted = side == Side::kBefore ? 0 : radars_[r].changes.size();
      if (phase_[static_cast<std::size_t>(i)][r] != wanted) windows::forget(share, local::kRotation, 3);
    }
  }
  return segments;
}

void Batch::find_loads() {
  constexpr int kTrialSolutions = 8;
  constexpr double kLeastStds = 2.0;
  const double time_s = clock_.driven_s();
  const auto delay = static_cast<std::size_t>(config_.load_delay_s / config_.block_s);
  for (const std::size_t report : load_reports_) {
    if (loads_.size() == static_cast<std::size_t>(shared::kLoads)) return;
    double best = kLeastStds;
    std::optional<std::size_t> place;
    for (const std::size_t window : window_) {
      const bool is_near = first_block(window) <= report && first_block(window + 1) + delay > report;
      const bool is_taken = std::find(loads_.begin(), loads_.end(), window) != loads_.end();
      if (!is_near || is_taken || window == 0 || window + 1 >= windows_) continue;
      std::vector<std::size_t> trial = loads_;
      const auto step = std::lower_bound(trial.begin(), trial.end(), window) - trial.begin();
      trial.insert(trial.begin() + step, window);
      Solver solver = solver_;
      Segments segments = assembled(Side::kAfter, trial);
      for (int i = 0; i < kTrialSolutions; ++i) solver.solve(segments, time_s);
      const auto k = static_cast<std::size_t>(step);
      const double stds = std::abs(solver.shared().load_rad[k]) /
                          std::sqrt(std::max(solver.load_variance(static_cast<int>(step)), 1e-18));
      if (stds <= best) continue;
      best = stds;
      place = window;
    }
    if (place) loads_.insert(std::lower_bound(loads_.begin(), loads_.end(), *place), *place);
  }
}

double Batch::first_change_s(std::size_t radar) const {
  return config_.block_s * static_cast<double>(radars_[radar].changes.front().block);
}

std::optional<Solver> Batch::solved_before(std::size_t index) const {
  constexpr double kLeast_s = 10.0;
  if (radars_[index].changes.empty()) return std::nullopt;
  double seen_s = 0.0;
  for (int i = 0; i < segments_.size(); ++i) {
    if (phase_[static_cast<std::size_t>(i)][index] == 0) seen_s += segments_.share(i, index).seconds;
  }
  if (seen_s < kLeast_s) return std::nullopt;
  std::optional<Solver> solver = solver_;
  solver->radar(index).state.sensor_to_vehicle =
      radars_[index].turned_back(0) * solver->radar(index).state.sensor_to_vehicle;
  Segments segments = assembled(Side::kBefore, loads_);
  solve(*solver, segments, first_change_s(index), config_.most_solutions);
  return solver;
}

void Batch::write_before(Result& result) const {
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const std::optional<Solver> solver = solved_before(r);
    if (!solver) continue;
    const int loads = loads_before(loads_, window_of(radars_[r].changes.front().block));
    write_solution(*solver, r, first_change_s(r), loads, radars_[r].sums.knots(), radars_[r].sums.linearised(), {},
                   result.before[r].emplace());
  }
}

}  // namespace boresight::alignment::batch
