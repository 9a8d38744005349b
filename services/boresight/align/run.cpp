#include "services/boresight/align/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "services/alignment_estimator/core/scan_detections.hpp"
#include "services/alignment_estimator/core/write_estimate.hpp"
#include "services/boresight/align/batch_calibration.hpp"
#include "services/boresight/align/samples.hpp"
#include "services/boresight/align/stds.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::align {

namespace {

constexpr std::string_view kBatch = "batch", kBatchCalibration = "batch_calibration";
/// The origin on the estimator's clock. It leaves room for earlier times, because time 0 means "never".
constexpr std::int64_t kOrigin_ns = 10'000'000'000;

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& [name, method] : alignment::kMethodNames) names.emplace_back(name);
  names.emplace_back(kBatch);
  names.emplace_back(kBatchCalibration);
  return names;
}

Run::Run(const VehicleConfig& vehicle, Options options)
    : vehicle_(vehicle),
      options_(std::move(options)),
      detections_(std::make_unique<alignment::ScanDetections>()),
      ego_start_s_(kNaN),
      ego_end_s_(kNaN),
      start_s_(kNaN),
      end_s_(kNaN) {
  for (const auto& [name, method] : alignment::kMethodNames) {
    if (name != options_.method) continue;
    options_.config.method = method;
    estimator_ = std::make_unique<alignment::Estimator>(vehicle_, options_.config);
  }
  if (options_.method == kBatch) {
    // The first pass is that of the recursive estimator of the same model.
    options_.config.method = alignment::Config().method;
    estimator_ = std::make_unique<alignment::Estimator>(vehicle_, options_.config);
    batch_ = std::make_unique<alignment::batch::Batch>(vehicle_, options_.config.filter, options_.config.windows);
  }
  if (estimator_ == nullptr && options_.method != kBatchCalibration) {
    throw std::invalid_argument(options_.method + " is no alignment method");
  }
  for (const RadarConfig& config : vehicle_.radars) {
    radars_.emplace_back(config, geometry::sensor_to_vehicle(config.mounting_pose, 0.0, 0.0, 0.0),
                         TruthWatch(options_.truth, config));
  }
}

std::int64_t Run::to_ns(double time_s) {
  if (std::isnan(options_.origin_s)) options_.origin_s = time_s;
  return kOrigin_ns + std::llround((time_s - options_.origin_s) * 1e9);
}

double Run::to_s(std::int64_t time_ns) const {
  return options_.origin_s + 1e-9 * static_cast<double>(time_ns - kOrigin_ns);
}

void Run::add_ego(EgoMotion& motion, double time_s) {
  motion.header.measurement_time_ns = to_ns(time_s);
  if (passes_ > 0) {
    ego_.add(motion);
    return;
  }
  ++ego_motions_;
  if (std::isnan(ego_start_s_)) ego_start_s_ = time_s;
  ego_end_s_ = time_s;
  ego_.add(motion);
  if (estimator_) estimator_->add_ego_motion(motion);
}

void Run::add_scan(RadarScan& scan, double time_s) {
  const auto found = std::find_if(radars_.begin(), radars_.end(),
                                  [&](const Radar& r) { return r.config.id == scan.header.source_id; });
  if (found == radars_.end()) return;
  const auto index = static_cast<std::size_t>(found - radars_.begin());
  if (passes_ > 0) {
    scan.header.measurement_time_ns = to_ns(time_s);
    alignment::take_detections(scan, found->config, *detections_);
    batch_->process(index, *detections_, ego_.at(scan.header.measurement_time_ns));
    return;
  }
  if (std::isnan(start_s_)) start_s_ = next_sample_s_ = end_s_ = time_s;
  observe_until(time_s);
  end_s_ = std::max(end_s_, time_s);
  scan.header.measurement_time_ns = to_ns(time_s);

  Radar& radar = *found;
  ++radar.scans;
  radar.detections += scan.number_of_valid_detections;
  radar.measures_elevation = radar.measures_elevation || scan.has(scan_field::kElevation);
  const EgoSample ego = ego_.at(scan.header.measurement_time_ns);
  const bool moves = ego.valid && !ego.stale;
  if (!moves) ++radar.scans_without_ego;
  if (moves && std::abs(ego.speed_mps) >= options_.config.min_speed_mps()) {
    alignment::take_detections(scan, radar.config, *detections_);
    radar.residuals.add(*detections_, ego);
  }
  if (!estimator_) return;
  const std::int64_t before_ns = options_.cpu_time_ns ? options_.cpu_time_ns() : 0;
  static_cast<void>(estimator_->add_scan(scan));
  if (options_.cpu_time_ns && moves) {
    const std::int64_t took_ns = options_.cpu_time_ns() - before_ns;
    radar.cpu_ns += took_ns;
    radar.max_cpu_ns = std::max(radar.max_cpu_ns, took_ns);
    ++radar.timed_scans;
  }
  const alignment::RadarEstimate estimate = estimator_->estimate(index);
  if (batch_) {
    alignment::take_detections(scan, radar.config, *detections_);
    batch_->observe(index, *detections_, ego, estimate);
  }
  observe_step_changes(radar, estimate, options_.origin_s);
  observe_vehicle_changes(estimate);
  radar.truth.observe(radar.config, estimate, time_s);
}

void Run::add_rejected_scan(RadarScan& scan, double time_s) {
  if (!estimator_) return;
  scan.header.measurement_time_ns = to_ns(time_s);
  estimator_->add_rejected_scan(scan);
}

void Run::observe_step_changes(Radar& radar, const alignment::RadarEstimate& estimate, double origin_s) {
  if (estimate.step_change.count == radar.step_changes_seen) return;
  radar.step_changes_seen = estimate.step_change.count;
  // The new mounting does not explain earlier measurements.
  radar.residuals = {};
  const auto& turn = estimate.step_change.rotation_vehicle_rad;
  radar.step_changes.push_back(
      {origin_s + 1e-9 * static_cast<double>(estimate.step_change.time_ns - kOrigin_ns), {turn[2], -turn[1], turn[0]}});
}

void Run::observe_vehicle_changes(const alignment::RadarEstimate& estimate) {
  const auto observe = [&](const AlignmentVehicleChange& change, std::vector<VehicleChangeEvent>& events) {
    if (change.count > events.size()) events.push_back({to_s(change.time_ns), static_cast<double>(change.size)});
  };
  observe(estimate.load_change, load_changes_);
  observe(estimate.speed_change, speed_changes_);
}

bool Run::needs_another_pass() {
  if (batch_ == nullptr || !batch_->end_pass()) return false;
  ++passes_;
  ego_ = EgoHistory();
  return true;
}

void Run::observe_until(double time_s) {
  constexpr double kInterval_s = 1.0, kLongestGap_s = 10.0;
  if (!estimator_) return;
  // Without input the estimates do not change.
  if (time_s > next_sample_s_ + kLongestGap_s) next_sample_s_ = time_s - kLongestGap_s;
  for (; next_sample_s_ <= time_s; next_sample_s_ += kInterval_s) series_.push_back(sample(next_sample_s_));
}

Sample Run::sample(double time_s) {
  std::vector<alignment::RadarEstimate> estimates;
  for (std::size_t i = 0; i < radars_.size(); ++i) estimates.push_back(estimator_->estimate(i));
  return sample_of(vehicle_, time_s, estimates);
}

Result Run::finish() {
  Result result;
  result.method = options_.method;
  result.vehicle = vehicle_.name;
  result.start_s = start_s_;
  result.end_s = end_s_;
  result.ego_start_s = ego_start_s_;
  result.ego_end_s = ego_end_s_;
  result.ego_motions = ego_motions_;
  for (const Radar& radar : radars_) {
    RadarResult& r = result.radars.emplace_back();
    r.id = radar.config.id;
    r.name = radar.config.name;
    r.measures_elevation = radar.measures_elevation;
    r.scans = radar.scans;
    r.scans_without_ego = radar.scans_without_ego;
    r.detections = radar.detections;
    const double timed = static_cast<double>(radar.timed_scans);
    r.cpu_us_per_scan = radar.timed_scans > 0 ? 1e-3 * static_cast<double>(radar.cpu_ns) / timed : kNaN;
    r.max_cpu_us_per_scan = radar.timed_scans > 0 ? 1e-3 * static_cast<double>(radar.max_cpu_ns) : kNaN;
    r.step_changes = radar.step_changes;
    result.scans += radar.scans;
    result.detections += radar.detections;
  }
  if (batch_) {
    finish_estimator(result);
    finish_batch(result);
  } else if (estimator_) {
    finish_estimator(result);
  } else {
    std::vector<const ResidualSample*> samples;
    for (const Radar& radar : radars_) samples.push_back(&radar.residuals);
    solve_batch_calibration(vehicle_, samples, options_.batch_calibration, options_.batch_calibration_progress, result);
  }
  result.load_changes = load_changes_;
  result.speed_changes = speed_changes_;
  describe(result);
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    RadarResult& r = result.radars[i];
    r.stds = stds_of(alignment::vehicle_form(radars_[i].config, r.estimate));
    r.residuals = radars_[i].residuals.judge(r.estimate, radars_[i].config, radars_[i].nominal);
    if (radars_[i].truth.is_known()) r.truth = radars_[i].truth.compare(radars_[i].config, r);
  }
  if (options_.truth) {
    result.true_speed_scale = true_speed_scale(*options_.truth, result);
    result.true_yaw_rate_bias_radps = options_.truth->yaw_rate_bias_radps;
    result.true_slip_coefficient_radps2pm = options_.truth->slip_coefficient_radps2pm;
  }
  return result;
}

void Run::finish_estimator(Result& result) {
  const Sample last = sample(end_s_);
  if (!std::isnan(end_s_)) series_.push_back(last);
  result.series = std::move(series_);
  result.speed_scale = last.speed_scale;
  result.speed_scale_std = last.speed_scale_std;
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    RadarResult& r = result.radars[i];
    r.estimate = estimator_->estimate(i);
    static_cast<void>(estimator_->write(r.id, r.message));
    if ((r.estimate.observable & alignment_axis::kSpeedScale) != 0) result.speed_scale_observable = true;
  }
}

void Run::finish_batch(Result& result) {
  const alignment::batch::Result found = batch_->result();
  result.problem = found.problem;
  if (!found.problem.empty()) return;
  result.batch = Result::Batch{found.driven_s, found.windows, found.passes, found.settled};
  const Sample last = sample_of(vehicle_, end_s_, found.radars);
  result.series.push_back(last);
  result.speed_scale = last.speed_scale;
  result.speed_scale_std = last.speed_scale_std;
  result.speed_scale_observable = false;
  for (std::size_t i = 0; i < radars_.size(); ++i) {
    RadarResult& r = result.radars[i];
    r.estimate = found.radars[i];
    if (found.before[i]) {
      const alignment::VehicleForm before = alignment::vehicle_form(radars_[i].config, *found.before[i]);
      r.before_change = {to_array(before.values), stds_of(before)};
    }
    // Key figures and a wrong input are those of the first pass.
    const AlignmentEstimate first = r.message;
    alignment::write_estimate(radars_[i].config, r.estimate, options_.config.prior_angle_std_rad(), r.message);
    if (first.finding != AlignmentFinding::kNone) {
      r.message.state = first.state;
      r.message.reason = first.reason;
      r.message.finding = first.finding;
      r.message.finding_value = first.finding_value;
      r.message.finding_radar = first.finding_radar;
    }
    if ((r.estimate.observable & alignment_axis::kSpeedScale) != 0) result.speed_scale_observable = true;
  }
}

void Run::describe(Result& result) const {
  float least_std = std::numeric_limits<float>::infinity();
  for (const RadarResult& r : result.radars) {
    const float std = r.message.nuisance.pitch_per_acceleration_radps2pm.std;
    if (!(std > 0.0F) || std >= least_std) continue;
    least_std = std;
    result.vehicle_nuisance = r.message.nuisance;
  }
  for (RadarResult& r : result.radars) {
    r.finding = alignment_words::sentence_of(alignment_words::finding_of(r.message), r.id, vehicle_);
    r.reason = r.finding.empty() ? std::string(alignment_words::words_of(r.message.reason)) : r.finding;
    r.drift_since_s = r.message.drift.since_ns == 0 ? kNaN : to_s(r.message.drift.since_ns);
  }
}

}  // namespace boresight::align
