#include "services/alignment_estimator/core/batch/batch.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "services/alignment_estimator/core/batch/estimate_values.hpp"
#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/output.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment::batch {

namespace {

std::string rounded(double value) {
  return std::to_string(std::lround(value));
}

using namespace windows;

constexpr std::size_t kMinDetections = 4;
constexpr double kMaxSpeed_mps = 120.0, kMaxYawRate_radps = 4.0;
constexpr double kShortestSegment_s = 2.0;  ///< of level 0

}  // namespace

Batch::Batch(const VehicleConfig& vehicle, const FilterConfig& filter, const WindowsConfig& windows,
             const BatchConfig& config)
    : filter_(filter),
      priors_(windows.priors),
      config_(config),
      clock_(config.block_s),
      solver_(std::min(vehicle.radars.size(), kMaxRadars), windows.priors),
      segments_(solver_.size()),
      solved_(solver_.size()) {
  radars_.reserve(solver_.size());
  for (std::size_t r = 0; r < solver_.size(); ++r) {
    radars_.push_back(
        {vehicle.radars[r], RadarSums(vehicle.radars[r], filter, windows.priors, windows.sums), {}, {}, false, {}});
    radars_[r].start.sensor_to_vehicle = geometry::sensor_to_vehicle(vehicle.radars[r].mounting_pose, 0.0, 0.0, 0.0);
  }
}

bool Batch::usable(const ScanDetections& scan, const EgoSample& ego) const {
  return scan.count >= kMinDetections && ego.valid && !ego.stale && std::abs(ego.speed_mps) >= filter_.min_speed_mps &&
         std::abs(ego.speed_mps) < kMaxSpeed_mps && std::abs(ego.yaw_rate_radps) < kMaxYawRate_radps;
}

void Batch::observe(std::size_t index, const ScanDetections& scan, const EgoSample& ego,
                    const RadarEstimate& estimate) {
  if (index >= radars_.size() || pass_ > 0) return;
  Radar& radar = radars_[index];
  sees_ = sees_ || scan.count > 0;
  drives_ = drives_ || (ego.valid && !ego.stale);
  radar.has_elevation = radar.has_elevation || scan.has_elevation;
  const bool is_used = usable(scan, ego);
  if (is_used) block_ = clock_.block_at(scan.time_ns);
  const std::uint32_t changes = estimate.step_change.count;
  if (changes > radar.start.step_change.count) {
    const auto& turn = estimate.step_change.rotation_vehicle_rad;
    radar.changes.push_back({block_, Eigen::Vector3f(turn[0], turn[1], turn[2]).cast<double>()});
  }
  const auto note = [&](std::uint32_t count, std::vector<std::size_t>& reports) {
    if (count > reports.size()) reports.push_back(block_);
  };
  note(estimate.load_change.count, load_reports_);
  note(estimate.speed_change.count, speed_reports_);
  radar.start = estimate;
}

bool Batch::end_pass() {
  if (pass_ == 0) {
    plan();
    if (!problem_.empty()) return false;
    ++pass_;
    begin_pass();
    return true;
  }
  if (has_block_) close_block();
  if (segments_.size() == 0) {
    problem_ = "the recording gave no scans when it was read again";
    return false;
  }
  const double time_s = clock_.driven_s();
  const auto loads = static_cast<int>(loads_.size());
  const std::vector<RadarEstimate> last = estimates(solver_, time_s, loads);
  if (!loads_found_) find_loads();
  loads_found_ = true;
  solved_ = assembled(Side::kAfter, loads_);
  solve(solver_, solved_, time_s, config_.most_solutions);
  const std::vector<RadarEstimate> now = estimates(solver_, time_s, static_cast<int>(loads_.size()));
  double moved = 0.0;
  for (std::size_t r = 0; r < radars_.size(); ++r) moved = std::max(moved, moved_stds(last[r], now[r]));
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const std::optional<Solver> before = solved_before(r);
    if (!before) continue;
    const RadarSolution& first = before->radar(r);
    const Eigen::Matrix3d turned = radars_[r].turned_back(0);
    radars_[r].first_from_last = first.state.sensor_to_vehicle * solver_.radar(r).state.sensor_to_vehicle.transpose();
    const double yaw_rad = geometry::so3_log(*radars_[r].first_from_last * turned.transpose()).z();
    moved = std::max(moved, std::abs(yaw_rad) / std::sqrt(first.covariance(own::kRotation + 2, own::kRotation + 2)));
  }
  settled_ = moved < config_.moved_stds;
  ++pass_;
  if (settled_ || pass_ >= config_.most_passes) return false;
  begin_pass();
  return true;
}

void Batch::plan() {
  blocks_ = clock_.blocks();
  const double driven_s = clock_.driven_s();
  if (!sees_) {
    problem_ = "there is no detection in the drive";
  } else if (!drives_) {
    problem_ = "no scan has a speed and a yaw rate near its time";
  } else if (blocks_ == 0) {
    problem_ = "the vehicle never drives at " + rounded(filter_.min_speed_mps) + " m/s or more with detections";
  } else if (driven_s < config_.least_drive_s) {
    problem_ = rounded(driven_s) + " s of driving at " + rounded(filter_.min_speed_mps) +
               " m/s or more are too few for the batch method: it needs " + rounded(config_.least_drive_s) + " s";
  } else if (std::none_of(radars_.begin(), radars_.end(), [](const Radar& r) { return r.start.scans_used > 0; })) {
    problem_ = "no mounting within the prior explains the range rates of any radar";
  }
  if (!problem_.empty()) return;
  windows_ = std::clamp<std::size_t>(static_cast<std::size_t>(driven_s / config_.window_s), 1, kMaxSegments);
  SharedState& shared = solver_.shared();
  double most_certain = 0.0;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    Radar& radar = radars_[r];
    solver_.set_prior(r, geometry::sensor_to_vehicle(radar.config.mounting_pose, 0.0, 0.0, 0.0), radar.has_elevation,
                      radar.sums.knots().step_rad);
    if (radar.start.scans_used == 0) continue;
    const RadarEstimate& e = radar.start;
    const AlignmentNuisance& n = e.nuisance;
    OwnState& own = solver_.radar(r).state;
    own.sensor_to_vehicle = e.sensor_to_vehicle;
    own.rate_scale = static_cast<double>(n.range_rate_scale.value);
    own.position_error_m = {static_cast<double>(n.position_x_m.value), static_cast<double>(n.position_y_m.value)};
    for (std::size_t k = 0; k < kAzimuthCurveKnots; ++k) {
      own.curve_rad(static_cast<int>(k)) = static_cast<double>(n.azimuth_curve_rad[k]);
    }
    own.stamp_s = static_cast<double>(n.time_offset_s.value);
    radar.sums.set_noise_scales(static_cast<double>(n.range_rate_noise_scale), e.angle_noise_scale);
    const double certain = 1.0 / std::max(e.covariance(0, 0), 1e-18);
    if (certain <= most_certain) continue;
    most_certain = certain;
    shared.speed_scale = e.speed_scale / (1.0 + own.rate_scale);
    shared.yaw_rate_bias_radps = e.yaw_rate_bias_radps;
    shared.slip_radps2pm = e.slip_coefficient_radps2pm;
    shared.yaw_rate_gain = static_cast<double>(n.yaw_rate_gain.value);
    shared.pitch_per_acceleration_radps2pm = static_cast<double>(n.pitch_per_acceleration_radps2pm.value);
  }
}

void Batch::begin_pass() {
  clock_ = DrivingClock(config_.block_s);
  trend_ = {};
  segments_.clear();
  window_.clear();
  phase_.clear();
  has_block_ = false;
  for (Radar& radar : radars_) radar.totals = {};
}

void Batch::process(std::size_t index, const ScanDetections& scan, const EgoSample& ego) {
  if (index >= radars_.size() || pass_ == 0 || !usable(scan, ego)) return;
  const ScanMotion3d motion = trend_.at(scan.time_ns, ego);
  // A recording that has grown since the first pass has no windows for the rest.
  const std::size_t block = std::min(clock_.block_at(scan.time_ns), blocks_ - 1);
  if (!has_block_ || block != block_) {
    if (has_block_) close_block();
    open_block(block);
  }
  if (radars_[index].start.scans_used == 0) return;
  Radar& radar = radars_[index];
  const double elapsed_s = radar.sums.elapsed_s(scan.time_ns);
  if (!radar.sums.take(scan, sightings_)) return;
  const RadarSums::Counts counts = radar.sums.add(sightings_, motion, ego, elapsed_s);
  radar.totals.detections += counts.detections;
  radar.totals.stationary += counts.stationary;
  radar.totals.inliers += counts.inliers;
  radar.totals.seconds += elapsed_s;
  ++radar.totals.scans;
}

void Batch::open_block(std::size_t block) {
  block_ = block;
  has_block_ = true;
  const std::size_t window = window_of(block);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Radar& radar = radars_[r];
    const std::size_t phase = radar.phase_of(block, delay_blocks()).value_or(radar.changes.size());
    windows::Point point = solver_.point(r, middle_s(window), loads_before(loads_, window));
    point.sensor_to_vehicle = radar.turned_back(phase) * point.sensor_to_vehicle;
    radars_[r].sums.begin_block(point, point, solver_.block_covariance(r), false);
  }
}

double Batch::middle_s(std::size_t window) const {
  return 0.5 * config_.block_s * static_cast<double>(first_block(window) + first_block(window + 1));
}

int Batch::loads_before(const std::vector<std::size_t>& loads, std::size_t window) {
  return static_cast<int>(std::count_if(loads.begin(), loads.end(), [&](std::size_t load) { return load <= window; }));
}

void Batch::close_block() {
  has_block_ = false;
  const std::size_t window = window_of(block_);
  const MergeNoise noise = solver_.merge_noise();
  if (window_.empty() || window_.back() != window) {
    segments_.begin(0, noise);
    window_.push_back(window);
    phase_.emplace_back(radars_.size(), 0);
    Segment& segment = segments_.segment(segments_.size() - 1);
    const double length_s = config_.block_s * static_cast<double>(first_block(window + 1) - first_block(window));
    segment.middle_s = middle_s(window);
    segment.level = std::max(0, static_cast<int>(std::lround(std::log2(length_s / kShortestSegment_s))));
  }
  segments_.segment(segments_.size() - 1).seconds += config_.block_s;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (radars_[r].sums.block().scans > 0) add_block(r, block_, noise);
  }
}

void Batch::add_block(std::size_t index, std::size_t block, const MergeNoise& noise) {
  const std::optional<std::size_t> phase = radars_[index].phase_of(block, delay_blocks());
  if (!phase) return;
  const int latest = segments_.size() - 1;
  std::size_t& of_share = phase_.back()[index];
  Share& share = segments_.share(latest, index);
  if (share.seconds > 0.0 && of_share != *phase) share = Share();
  of_share = *phase;
  const double length_s =
      config_.block_s * static_cast<double>(first_block(window_.back() + 1) - first_block(window_.back()));
  segments_.add(index, radars_[index].sums.block(), length_s, noise);
}

std::vector<RadarEstimate> Batch::estimates(const Solver& solver, double time_s, int loads) const {
  std::vector<RadarEstimate> all(radars_.size());
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    write_solution(solver, r, time_s, loads, radars_[r].sums.knots(), radars_[r].sums.linearised(),
                   radars_[r].sums.unmeasured(), all[r]);
  }
  return all;
}

int Batch::solve(Solver& solver, Segments& segments, double time_s, int most) const {
  const auto loads = static_cast<int>(loads_.size());
  for (int i = 1; i <= most; ++i) {
    const std::vector<RadarEstimate> last = estimates(solver, time_s, loads);
    solver.solve(segments, time_s);
    const std::vector<RadarEstimate> now = estimates(solver, time_s, loads);
    double moved = 0.0;
    for (std::size_t r = 0; r < radars_.size(); ++r) moved = std::max(moved, moved_stds(last[r], now[r]));
    if (moved < config_.solved_stds) return i;
  }
  return most;
}

}  // namespace boresight::alignment::batch
