#include "services/alignment_estimator/core/batch_calibration/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "services/alignment_estimator/core/batch_calibration/joint.hpp"
#include "services/alignment_estimator/core/published/draw.hpp"

namespace boresight::alignment::batch_calibration {

namespace {

std::vector<Recording> thinned(std::span<const Recording> radars, std::size_t most) {
  std::vector<Recording> thin;
  for (const Recording& radar : radars) {
    Recording& own = thin.emplace_back(Recording{radar.nominal, radar.has_elevation, {}});
    const std::size_t stride = std::max<std::size_t>(1, radar.detections.size() / std::max<std::size_t>(most, 1));
    for (std::size_t i = 0; i < radar.detections.size(); i += stride) own.detections.push_back(radar.detections[i]);
  }
  return thin;
}

std::size_t count(std::span<const Recording> radars) {
  std::size_t sum = 0;
  for (const Recording& radar : radars) sum += radar.detections.size();
  return sum;
}

}  // namespace

void fill_in(Recording& radar, const Config& config, std::uint64_t seed, const Alternative& alternative) {
  if (radar.has_elevation || radar.detections.empty()) return;
  double middle = 0.0;
  for (const Detection& d : radar.detections) middle += d.azimuth_rad;
  middle /= static_cast<double>(radar.detections.size());
  const double mean = 0.5 * (config.elevation_low_rad + config.elevation_high_rad) + alternative.shift_rad;
  const double half = 0.5 * (config.elevation_high_rad - config.elevation_low_rad) * alternative.width;
  published::Draw draw(seed);
  for (Detection& d : radar.detections)
    d.elevation_rad = draw.uniform(mean - half, mean + half) + alternative.tilt * (d.azimuth_rad - middle);
}

std::vector<Parameter> judge(std::span<const Recording> radars, const Eigen::VectorXd& found, const Config& config,
                             const std::function<void(double)>& progress) {
  std::vector<Recording> thin = thinned(radars, config.judgement_detections);
  std::vector<Eigen::Index> empty, empty_and_rolls;
  Eigen::VectorXd roll = Eigen::VectorXd::Zero(found.size());
  for (std::size_t r = 0; r < thin.size(); ++r) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const bool is_empty = thin[r].detections.empty();
      if (is_empty) empty.push_back(first_angle(r) + i);
      if (is_empty || (i == 2 && !thin[r].has_elevation)) empty_and_rolls.push_back(first_angle(r) + i);
    }
    if (!thin[r].has_elevation) roll(first_angle(r) + 2) = config.judgement_roll_rad;
  }
  const std::size_t draws = std::max<std::size_t>(config.judgement_draws, 2);
  const std::size_t problems = draws + 8;  // shift and tilt in both directions, two widths, two rolls
  std::size_t solved_problems = 0;
  const auto solve_next = [&](const Eigen::VectorXd& start, std::span<const Eigen::Index> held) {
    if (progress) progress(static_cast<double>(solved_problems++) / static_cast<double>(problems));
    return solve(thin, start, held);
  };
  const auto solved = [&](std::uint64_t seed, const Alternative& alternative) {
    for (std::size_t r = 0; r < thin.size(); ++r) fill_in(thin[r], config, seed * 1000 + r, alternative);
    return solve_next(found, empty);
  };

  Eigen::VectorXd mean = Eigen::VectorXd::Zero(found.size()), square = mean;
  for (std::size_t i = 0; i < draws; ++i) {
    const Eigen::VectorXd x = solved(config.seed + 1 + i, {}).parameters;
    mean += x / static_cast<double>(draws);
    square += (x - found).cwiseAbs2();
  }
  const auto n = static_cast<double>(draws);
  const Eigen::VectorXd spread = ((square - n * (mean - found).cwiseAbs2()) / (n - 1.0)).cwiseMax(0.0).cwiseSqrt();

  const double d = config.judgement_shift_rad;
  const Eigen::VectorXd by_shift =
      0.5 * (solved(config.seed, {.shift_rad = d}).parameters - solved(config.seed, {.shift_rad = -d}).parameters);
  // With zero width: drawn elevations make a roll look like noise and hide that it is minus the tilt.
  const Eigen::VectorXd by_tilt = 0.5 * (solved(config.seed, {.tilt = d, .width = 0.0}).parameters -
                                         solved(config.seed, {.tilt = -d, .width = 0.0}).parameters);
  const Solution wide = solved(config.seed, {.width = config.judgement_width});
  const Solution usual = solved(config.seed, {});
  const Eigen::VectorXd by_width = wide.parameters - usual.parameters;
  // Another roll acts only together with another pitch: their product changes yaw.
  Eigen::VectorXd by_roll = Eigen::VectorXd::Zero(found.size());
  for (std::size_t r = 0; r < thin.size(); ++r) fill_in(thin[r], config, config.seed * 1000 + r, {.shift_rad = d});
  for (const double side : {-1.0, 1.0})
    by_roll += side * 0.5 * solve_next(found + side * roll, empty_and_rolls).parameters;

  for (std::size_t r = 0; r < thin.size(); ++r) fill_in(thin[r], config, config.seed, {.width = 0.0});
  const std::size_t all = count(radars);
  // All detections contain more information than the selected ones.
  const double more = count(thin) > 0 ? static_cast<double>(all) / static_cast<double>(count(thin)) : 1.0;
  const Eigen::VectorXd std = stds(thin, found, empty, usual.rmse_mps / std::sqrt(more), config.prior_angle_std_rad);

  std::vector<Parameter> judged(static_cast<std::size_t>(found.size()));
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    Parameter& p = judged[static_cast<std::size_t>(i)];
    p.value = found(i);
    if (all == 0 || std::find(empty.begin(), empty.end(), i) != empty.end()) continue;
    p.std = std(i);
    p.spread = spread(i);
    p.response = (std::abs(by_shift(i)) >= std::abs(by_tilt(i)) ? by_shift(i) : by_tilt(i)) / d;
    // A shifted roll changes itself by the shift only.
    const double other_roll = roll(i) > 0.0 ? 0.0 : by_roll(i);
    p.made_up = Eigen::Vector4d(by_shift(i), by_tilt(i), by_width(i), other_roll).norm();
    const double limit = i == 0 ? config.supported_speed_scale : config.supported_angle_rad;
    if (!(p.made_up < limit)) {
      p.support = Support::kFollowsFillIn;
    } else if (!(p.spread < limit)) {
      p.support = Support::kSpreads;
    } else if (!(p.std < limit)) {
      p.support = Support::kUncertain;
    } else {
      p.support = Support::kSupported;
    }
  }
  return judged;
}

}  // namespace boresight::alignment::batch_calibration
