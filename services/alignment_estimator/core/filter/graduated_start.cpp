#include "services/alignment_estimator/core/filter/graduated_start.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/windows/scan_model.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

constexpr std::size_t kColumns = 11;
/// Interval between passes, so that slow radars start as soon as fast ones.
constexpr double kPassPeriod_s = 0.02;
constexpr double kMinScale_mps = 0.02;
/// A result further from the prior than this many of its stds is rejected.
constexpr double kPlausibleStds = 3.5;

}  // namespace

GraduatedStart::GraduatedStart(const FilterConfig& config) : config_(config), columns_(kColumns * kCapacity) {}

void GraduatedStart::clear() {
  number_of_scans_ = number_of_sightings_ = 0;
  seconds_ = 0.0;
  passes_ = 0;
  passes_due_ = 0.0;
}

void GraduatedStart::store(const Sightings& s, const ScanMotion3d& motion) {
  if (number_of_scans_ == kMaxScans || s.count == 0) return;
  // Every n-th detection of a long scan: sensors sort by range or angle, so the first ones are no fair sample.
  const std::size_t stride = (s.count + kMaxPerScan - 1) / kMaxPerScan;
  const std::size_t count = (s.count + stride - 1) / stride;
  if (number_of_sightings_ + count > kCapacity) return;
  const std::array<const double*, kColumns> from{s.x.data(),
                                                 s.y.data(),
                                                 s.z.data(),
                                                 s.range_rate_mps.data(),
                                                 s.azimuth_variance.data(),
                                                 s.elevation_variance.data(),
                                                 s.range_rate_variance.data(),
                                                 s.azimuth_std_slope.data(),
                                                 s.lowering.data(),
                                                 s.lowering_variance.data(),
                                                 s.mean_sine.data()};
  for (std::size_t c = 0; c < kColumns; ++c) {
    double* const to = columns_.data() + c * kCapacity + number_of_sightings_;
    for (std::size_t i = 0; i < count; ++i) to[i] = from[c][i * stride];
  }
  scans_[number_of_scans_++] = {number_of_sightings_, count, motion, s.ambiguity_mps, s.has_elevation};
  number_of_sightings_ += count;
}

void GraduatedStart::begin(const StartPrior& prior) {
  prior_ = prior;
  point_ = prior.point;
  off_.setZero();
  scale_mps_ = config_.start_scale_mps;
}

GraduatedStart::Verdict GraduatedStart::add(const Sightings& sightings, const std::array<double, 3>& position_m,
                                            const ScanMotion3d& motion, double elapsed_s, const StartPrior& prior,
                                            double angle_scale) {
  store(sightings, motion);
  seconds_ += elapsed_s;
  const bool enough =
      seconds_ >= config_.start_seconds && static_cast<double>(number_of_sightings_) >= config_.start_detections;
  if (!enough && number_of_scans_ < kMaxScans) return Verdict::kSearching;
  if (passes_ == 0) begin(prior);
  passes_due_ = std::min(passes_due_ + std::max(1.0, elapsed_s / kPassPeriod_s), 3.0);
  while (passes_due_ >= 1.0 && passes_ < config_.start_passes) {
    passes_due_ -= 1.0;
    ++passes_;
    pass(position_m, angle_scale, passes_ == config_.start_passes);
  }
  if (passes_ < config_.start_passes) return Verdict::kSearching;
  const Verdict verdict = judge();
  clear();
  return verdict;
}

windows::ScanModel GraduatedStart::model_of(const ScanMotion3d& motion, const std::array<double, 3>& position_m) const {
  return windows::model_scan(point_, position_m,
                             {motion.speed_mps, motion.yaw_rate_radps, motion.acceleration_mps2, 0.0, 0.0, 0.0});
}

void GraduatedStart::pass(const std::array<double, 3>& position_m, double angle_scale, bool last) {
  Judgement judgement;
  judgement.gate = config_.outlier_gate_sigma;
  judgement.min_std_mps = last ? 0.0 : scale_mps_;
  judgement.angle_scale = angle_scale;
  judgement.velocity_variance.setZero();
  scale_mps_ = std::max(scale_mps_ * config_.start_shrink, kMinScale_mps);
  std::array<Eigen::Matrix3d, kMaxScans> information;
  std::array<Eigen::Vector3d, kMaxScans> score;
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero(), from_noise = Eigen::Matrix3d::Zero();
  inliers_ = near_ = stationary_ = counted_ = 0.0;
  bool has_elevation = false;
  for (std::size_t k = 0; k < number_of_scans_; ++k) {
    const Scan& scan = scans_[k];
    const double* const c = columns_.data() + scan.first;
    const SightingRun run{c,
                          c + kCapacity,
                          c + 2 * kCapacity,
                          c + 3 * kCapacity,
                          c + 4 * kCapacity,
                          c + 5 * kCapacity,
                          c + 6 * kCapacity,
                          c + 7 * kCapacity,
                          c + 8 * kCapacity,
                          c + 9 * kCapacity,
                          c + 10 * kCapacity,
                          scan.count,
                          scan.ambiguity_mps};
    const ScanSums sums = sum_scan(run, model_of(scan.motion, position_m).g, judgement);
    information[k] = sums.information;
    score[k] = sums.score;
    all += sums.information;
    from_noise += sums.from_noise;
    inliers_ += sums.inliers;
    near_ += sums.near;
    stationary_ += sums.stationary;
    counted_ += static_cast<double>(scan.count);
    has_elevation = has_elevation || scan.has_elevation;
  }
  Spread spread;
  spread.add(all, from_noise, inliers_, 0.0);
  const Support support = spread.support(has_elevation, prior_.log_angle_noise_std);
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  normal(0, 0) = 1.0 / prior_.speed_scale_variance;
  normal.bottomRightCorner<3, 3>().diagonal().setConstant(1.0 / prior_.rotation_variance);
  // The information is reduced throughout, so that a poorly known parameter does not follow the noise.
  const double counts = 1.0 / config_.start_inflation;
  Eigen::Vector4d right = -normal * off_;
  for (std::size_t k = 0; k < number_of_scans_; ++k) {
    const windows::ScanModel model = model_of(scans_[k].motion, position_m);
    Eigen::Matrix<double, 4, 3> gradient;
    gradient << model.by_parameter.row(windows::local::kSpeedScale), Eigen::RowVector3d::Zero(),
        model.by_parameter.middleRows<2>(windows::local::kRotation + 1);
    // Reflectors in one plane do not determine its tilt: it would come from the estimate, not from the radar.
    if (support.directions < 3) gradient.row(2).setZero();
    const Eigen::Matrix<double, 4, 3> supported = gradient * support.share;
    normal.noalias() += supported * (counts * information[k]) * supported.transpose();
    right.noalias() += supported * (counts * score[k]);
  }
  const Eigen::LLT<Eigen::Matrix4d> solver(normal);
  Eigen::Vector4d step = solver.solve(right);
  if (solver.info() != Eigen::Success || !step.allFinite()) step.setZero();
  const double length = step.tail<3>().norm();
  if (length > 0.3) step *= 0.3 / length;
  point_.speed_scale += step(0);
  point_.sensor_to_vehicle = geometry::so3_exp(step.tail<3>()) * point_.sensor_to_vehicle;
  off_ += step;
  if (!last) return;
  result_.speed_scale = point_.speed_scale;
  result_.sensor_to_vehicle = point_.sensor_to_vehicle;
  result_.covariance = solver.solve(Eigen::Matrix4d::Identity());
  result_.searched = {false, support.directions == 3, true};
  result_.spread = spread;
  result_.inlier_ratio = counted_ > 0.0 ? stationary_ / counted_ : 0.0;
}

GraduatedStart::Verdict GraduatedStart::judge() const {
  // The neighbourhood of the gate is twice as wide and shows the density of the background. The gate must hold more
  // detections than this background by five stds of the counts, and by more than half of its detections.
  const double excess = inliers_ - 0.5 * near_;
  const bool stands_out = excess > 0.5 * inliers_ && excess * excess > 25.0 * (inliers_ + 0.25 * near_);
  const double rotation_limit = kPlausibleStds * std::sqrt(prior_.rotation_variance);
  const bool plausible = std::abs(off_(0)) < kPlausibleStds * std::sqrt(prior_.speed_scale_variance) &&
                         off_.tail<3>().cwiseAbs().maxCoeff() < rotation_limit && result_.covariance.allFinite();
  return stands_out && plausible ? Verdict::kFound : Verdict::kNothing;
}

}  // namespace boresight::alignment
