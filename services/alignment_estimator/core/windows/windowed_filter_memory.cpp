// Memory from one drive to the next, and the start from a static calibration.
#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/small_maths.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::alignment {

namespace {

using namespace windows;

constexpr int kRemembered = static_cast<int>(Memory::kOwn);
using RememberedMatrix = Eigen::Matrix<double, kRemembered, kRemembered, Eigen::RowMajor>;
using SharedRows = Eigen::Matrix<double, shared::kConstants, shared::kConstants, Eigen::RowMajor>;
using RememberedVector = Eigen::Matrix<double, kRemembered, 1>;
using SharedVector = Eigen::Matrix<double, shared::kConstants, 1>;

/// Standard deviations before any data; 0: not estimated.
RememberedVector own_prior_stds(const Priors& priors, bool has_elevation) {
  RememberedVector std;
  std(own::kRateScale) = priors.rate_scale_std;
  const double tilt = has_elevation ? priors.rotation_std_rad : 0.0;
  std.segment<3>(own::kRotation) << tilt, tilt, priors.rotation_std_rad;
  std(own::kStamp) = priors.stamp_std_s;
  std.segment<2>(own::kPosition).setConstant(priors.position_std_m);
  std.segment<kKnots>(own::kCurve).setConstant(priors.curve_std_rad);
  std(own::kAbove) = has_elevation ? priors.height_excess_std : 0.0;
  std(own::kMirror) = has_elevation ? priors.mirror_share_std : 0.0;
  return std;
}

SharedVector shared_prior_stds(const Priors& priors) {
  SharedVector std;
  std << priors.speed_scale_std, priors.yaw_rate_bias_std_radps, priors.yaw_rate_gain_std, priors.slip_std_radps2pm,
      priors.pitch_per_acceleration_std_radps2pm, priors.common_stamp_std_s;
  return std;
}

/// No parameter is known worse than before any data; one that is not estimated has no variance.
template <typename Matrix, typename Vector>
void cap(const Vector& prior_stds, Matrix& covariance) {
  Vector factor = Vector::Ones();
  for (Eigen::Index i = 0; i < factor.size(); ++i) {
    if (!(prior_stds(i) > 0.0)) factor(i) = 0.0;
    if (covariance(i, i) > square(prior_stds(i))) factor(i) = prior_stds(i) / std::sqrt(covariance(i, i));
  }
  if constexpr (Vector::RowsAtCompileTime == kRemembered) {
    // As a whole, so that its mean stays zero. Its ends are known worse than its middle, also before any data.
    const double mean = covariance.diagonal().template segment<kKnots>(own::kCurve).mean();
    const double std = prior_stds(own::kCurve);
    factor.template segment<kKnots>(own::kCurve).setConstant(mean > square(std) ? std / std::sqrt(mean) : 1.0);
    if (!(std > 0.0)) factor.template segment<kKnots>(own::kCurve).setZero();
  }
  covariance = (factor.asDiagonal() * covariance * factor.asDiagonal()).eval();
}

/// Adds variances, but none beyond the prior's.
template <typename Matrix, typename Vector>
void doubt(const Vector& prior_stds, const Vector& variances, Matrix& covariance) {
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    covariance(i, i) += std::max(0.0, std::min(variances(i), square(prior_stds(i)) - covariance(i, i)));
  }
}

}  // namespace

/// The correlations of a radar with what all radars share, and by way of it with the other radars, are lost. With
/// C + B·S·Bᵀ for the covariance of each of n radars and S for that of the shared parameters, the covariances
/// C + (n + 1)·B·S·Bᵀ and (n + 1)·S without correlations claim nothing that the joint covariance does not:
/// (n + 1)·(x₀² + … + x_n²) ≥ (x₀ + … + x_n)².
void WindowedFilter::save_present(Memory& memory) const {
  memory = {};
  memory.number_of_radars = radars_.size();
  // A load change that is not decided yet does not count.
  const int load = load_since_s_ < 0.0 ? load_ : load_ - 1;
  const SharedState& constants = solver_.shared();
  memory.speed_scale = constants.speed_scale;
  memory.yaw_rate_bias_radps = constants.yaw_rate_bias_radps;
  memory.yaw_rate_gain = constants.yaw_rate_gain;
  memory.slip_coefficient_radps2pm = constants.slip_radps2pm;
  memory.pitch_per_acceleration_radps2pm = constants.pitch_per_acceleration_radps2pm;
  memory.time_offset_s = constants.stamp_s;
  memory.load_pitch_rad = solver_.load_rad(load);
  memory.fluctuation_variance = solver_.common().variance;
  for (std::size_t k = 0; k < kFluctuations; ++k) memory.correlation_s[k] = solver_.correlation_s(k);
  double parts = 1.0;
  for (std::size_t r = 0; r < radars_.size(); ++r) parts += solver_.radar(r).with_shared.isZero(0.0) ? 0.0 : 1.0;
  const SharedVector shared_stds = shared_prior_stds(priors_);
  SharedRows of_vehicle = parts * solver_.shared_covariance();
  cap(shared_stds, of_vehicle);
  Eigen::Map<SharedRows>(memory.covariance.data()) = of_vehicle;
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    const Radar& radar = radars_[r];
    const RadarSolution& solution = solver_.radar(r);
    const OwnState& state = solution.state;
    Memory::Radar& known = memory.radars[r];
    known.id = radar.config.id;
    known.has_elevation = solution.has_elevation;
    const Eigen::Matrix3d now = solver_.point(r, driven_s_, load).sensor_to_vehicle;
    const Eigen::Vector3d turn =
        geometry::so3_log(geometry::so3_exp({0.0, -memory.load_pitch_rad, 0.0}) * now * radar.nominal.transpose());
    known.rotation_vehicle_rad = {turn.x(), turn.y(), turn.z()};
    known.range_rate_scale = state.rate_scale;
    known.time_offset_s = state.stamp_s;
    known.position_error_m = {state.position_error_m.x(), state.position_error_m.y()};
    for (int k = 0; k < kKnots; ++k) known.azimuth_curve_rad[static_cast<std::size_t>(k)] = state.curve_rad(k);
    known.height_excess = state.height_excess;
    known.mirror_share = state.mirror_share;
    known.angle_noise_scale = radar.sums.angle_noise_scale();
    known.range_rate_noise_scale = radar.sums.range_rate_noise_scale();
    known.seconds_of_drive = radar.seconds_of_drive;
    known.fluctuation_variance = solution.fluctuation.variance;
    RememberedMatrix own = solution.covariance.topLeftCorner<kRemembered, kRemembered>();
    own += (parts - 1.0) * (solution.covariance - solution.conditional).topLeftCorner<kRemembered, kRemembered>();
    own(own::kRotation + 1, own::kRotation + 1) += lasting_pitch_variance(priors_, solution);
    cap(own_prior_stds(priors_, solution.has_elevation), own);
    Eigen::Map<RememberedMatrix>(known.covariance.data()) = own;
  }
}

bool WindowedFilter::keeps_restored(std::size_t index, const Memory::Radar& present) const {
  const Radar& radar = radars_[index];
  if (index >= restored_.number_of_radars || !radar.remembered || radar.step_change.count > 0) return false;
  if (radar.contradicted && radar.state == AlignmentState::kConverged) return false;
  const Memory::Radar& before = restored_.radars[index];
  const auto is_worse = [&](std::size_t axis) {
    return present.rotation_variance(axis, axis) > before.rotation_variance(axis, axis);
  };
  return is_worse(1) || is_worse(2);
}

bool WindowedFilter::keeps_restored_vehicle(const Memory& present) const {
  if (restored_.number_of_radars == 0 || load_change_.count + speed_change_.count > 0) return false;
  double gained = 0.0;
  for (std::size_t i = 0; i < Memory::kShared; ++i) {
    const double before = restored_.variance(i, i), now = present.variance(i, i);
    if (before > 0.0 && now > 0.0) gained += std::log(before / now);
  }
  return gained < 0.0;
}

/// The factor n + 1 is paid once a drive, not at every restart: what the drive began with is passed on until the
/// present state tells more in spite of it. It is as true as it was, because nothing has contradicted it.
void WindowedFilter::save(Memory& memory) const {
  save_present(memory);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (!keeps_restored(r, memory.radars[r])) continue;
    memory.radars[r] = restored_.radars[r];
    memory.radars[r].seconds_of_drive = radars_[r].seconds_of_drive;
  }
  if (keeps_restored_vehicle(memory)) {
    memory.speed_scale = restored_.speed_scale;
    memory.yaw_rate_bias_radps = restored_.yaw_rate_bias_radps;
    memory.yaw_rate_gain = restored_.yaw_rate_gain;
    memory.slip_coefficient_radps2pm = restored_.slip_coefficient_radps2pm;
    memory.pitch_per_acceleration_radps2pm = restored_.pitch_per_acceleration_radps2pm;
    memory.time_offset_s = restored_.time_offset_s;
    memory.covariance = restored_.covariance;
  }
}

void WindowedFilter::restore(const Memory& memory, double away_s) {
  const SharedVector shared_stds = shared_prior_stds(priors_);
  const RestoreConfig& doubts = restore_config_;
  const double doubted = 1.0 - std::exp(-std::max(away_s, 0.0) / doubts.doubt_s);
  // Constants of the vehicle. What the method did not estimate, or does not any more, keeps its nominal value.
  SharedState constants;
  SharedRows of_vehicle = Eigen::Map<const SharedRows>(memory.covariance.data());
  const std::array<double, shared::kConstants> values{memory.speed_scale,
                                                      memory.yaw_rate_bias_radps,
                                                      memory.yaw_rate_gain,
                                                      memory.slip_coefficient_radps2pm,
                                                      memory.pitch_per_acceleration_radps2pm,
                                                      memory.time_offset_s};
  const std::array<double*, shared::kConstants> places{&constants.speed_scale,
                                                       &constants.yaw_rate_bias_radps,
                                                       &constants.yaw_rate_gain,
                                                       &constants.slip_radps2pm,
                                                       &constants.pitch_per_acceleration_radps2pm,
                                                       &constants.stamp_s};
  for (int i = 0; i < shared::kConstants; ++i) {
    const double value = values[static_cast<std::size_t>(i)];
    const bool known = shared_stds(i) > 0.0 && of_vehicle(i, i) > 0.0 && std::isfinite(value);
    if (known) *places[static_cast<std::size_t>(i)] = value;
    if (known) continue;
    of_vehicle.row(i).setZero();
    of_vehicle.col(i).setZero();
    of_vehicle(i, i) = square(shared_stds(i));
  }
  SharedVector more = (doubts.vehicle_share * shared_stds).cwiseAbs2();
  more(shared::kSpeedScale) = square(doubts.speed_scale_std);
  more *= doubted;
  doubt(shared_stds, more, of_vehicle);
  constants.first_load_rad = std::isfinite(memory.load_pitch_rad) ? memory.load_pitch_rad : 0.0;
  Fluctuation common = solver_.common();
  std::array<double, kFluctuations> correlation_s{};
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    if (common.variance[k] > 0.0 && memory.fluctuation_variance[k] > 0.0) {
      common.variance[k] = memory.fluctuation_variance[k];
    }
    correlation_s[k] = memory.correlation_s[k] > 0.0 ? memory.correlation_s[k] : solver_.correlation_s(k);
  }
  solver_.restore(constants, of_vehicle, common, correlation_s);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    Radar& radar = radars_[r];
    const auto last = memory.radars.begin() + static_cast<std::ptrdiff_t>(memory.number_of_radars);
    const auto known =
        std::find_if(memory.radars.begin(), last, [&](const Memory::Radar& m) { return m.id == radar.config.id; });
    if (known == last) continue;
    const Eigen::Vector3d turn(known->rotation_vehicle_rad.data());
    RememberedMatrix own = Eigen::Map<const RememberedMatrix>(known->covariance.data());
    if (!turn.allFinite() || turn.norm() > 1.0 || !own.allFinite()) continue;
    const bool has_elevation = known->has_elevation;
    solver_.set_prior(r, radar.nominal, has_elevation, radar.sums.knots().step_rad);
    const RadarSolution& fresh = solver_.radar(r);
    const RememberedVector stds = own_prior_stds(priors_, has_elevation);
    OwnState state;
    state.sensor_to_vehicle = geometry::so3_exp(turn) * radar.nominal;
    state.rate_scale = known->range_rate_scale;
    state.stamp_s = known->time_offset_s;
    state.position_error_m = {known->position_error_m[0], known->position_error_m[1]};
    for (int k = 0; k < kKnots; ++k) state.curve_rad(k) = known->azimuth_curve_rad[static_cast<std::size_t>(k)];
    state.height_excess = known->height_excess;
    state.mirror_share = known->mirror_share;
    // Blocks of parameters that are not known, or are not estimated any more.
    const auto begin_again = [&](int first, int count) {
      bool all = true;
      for (int i = first; i < first + count; ++i) all = all && stds(i) > 0.0 && own(i, i) > 0.0;
      if (all) return false;
      own.middleRows(first, count).setZero();
      own.middleCols(first, count).setZero();
      for (int i = first; i < first + count; ++i) own(i, i) = square(stds(i));
      return true;
    };
    if (begin_again(own::kRateScale, 1)) state.rate_scale = 0.0;
    for (int axis = 0; axis < 3; ++axis) static_cast<void>(begin_again(own::kRotation + axis, 1));
    if (begin_again(own::kStamp, 1)) state.stamp_s = 0.0;
    if (begin_again(own::kPosition, 2)) state.position_error_m.setZero();
    if (begin_again(own::kAbove, 1)) state.height_excess = 0.0;
    if (begin_again(own::kMirror, 1)) state.mirror_share = 0.0;
    if (begin_again(own::kCurve, kKnots)) {
      state.curve_rad.setZero();
      if (priors_.curve_std_rad > 0.0) {
        own.block<kKnots, kKnots>(own::kCurve, own::kCurve) =
            fresh.prior.block<kKnots, kKnots>(own::kCurve, own::kCurve).inverse();
      }
    }
    Fluctuation fluctuation = fresh.fluctuation;
    for (std::size_t k = 0; k < kFluctuations; ++k) {
      if (fluctuation.variance[k] > 0.0 && known->fluctuation_variance[k] > 0.0) {
        fluctuation.variance[k] = known->fluctuation_variance[k];
      }
    }
    RememberedVector changes = RememberedVector::Zero();
    changes.segment<3>(own::kRotation).setConstant(doubted * square(doubts.rotation_std_rad));
    changes(own::kRateScale) = doubted * square(doubts.rate_scale_std);
    doubt(stds, changes, own);
    OwnMatrix covariance = OwnMatrix::Zero();
    covariance.topLeftCorner<kRemembered, kRemembered>() = own;
    solver_.restore(r, state, covariance, fluctuation);
    radar.sums.set_noise_scales(known->range_rate_noise_scale, known->angle_noise_scale);
    radar.seconds_of_drive = known->seconds_of_drive;
    radar.running = false;
    radar.remembered = true;
    radar.start.clear();
  }
  // The load may have changed meanwhile; decide_load() removes the change if there was none.
  if (away_s >= doubts.stop_s) {
    load_ = 1;
    load_since_s_ = 0.0;
  }
  save_present(restored_);
  for (std::size_t r = 0; r < radars_.size(); ++r) {
    if (radars_[r].remembered) allow_fluctuations(r);
  }
}

/// A slow fluctuation goes on as it was before, where the equations take a new one: what it does from now on is no
/// news. So the memory counts with its variance; one of all radars is as large for each of them, and counts n-fold
/// where it is taken as independent.
void WindowedFilter::allow_fluctuations(std::size_t index) {
  constexpr std::array<int, kFluctuations> kOwnFluctuating{own::kRotation + 2, own::kRotation + 1, own::kRateScale};
  const RadarSolution& solution = solver_.radar(index);
  const auto number = static_cast<double>(radars_.size());
  RememberedVector more = RememberedVector::Zero();
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    more(kOwnFluctuating[k]) = solution.fluctuation.variance[k] + number * solver_.common().variance[k];
  }
  RememberedMatrix own = solution.covariance.topLeftCorner<kRemembered, kRemembered>();
  doubt(own_prior_stds(priors_, solution.has_elevation), more, own);
  OwnMatrix covariance = OwnMatrix::Zero();
  covariance.topLeftCorner<kRemembered, kRemembered>() = own;
  const OwnState state = solution.state;
  const Fluctuation fluctuation = solution.fluctuation;
  solver_.restore(index, state, covariance, fluctuation);
}

bool WindowedFilter::seed(std::size_t index, const Eigen::Vector3d& rotation_vehicle_rad,
                          const Eigen::Matrix3d& covariance) {
  const bool usable = index < radars_.size() && rotation_vehicle_rad.allFinite() &&
                      rotation_vehicle_rad.norm() <= 1.0 && covariance.allFinite() &&
                      (covariance.diagonal().array() > 0.0).all() &&
                      Eigen::LLT<Eigen::Matrix3d>(covariance).info() == Eigen::Success;
  if (!usable) return false;
  Radar& radar = radars_[index];
  segments_.forget(index, local::kRotation, 3);
  solver_.seed(index, geometry::so3_exp(rotation_vehicle_rad) * radar.nominal, covariance);
  restored_.number_of_radars = 0;
  changes_.restart(index);
  load_watch_.restart();
  speed_watch_.restart();
  radar.reference_scale = 0.0;
  radar.seconds_of_drive = 0.0;
  radar.running = false;
  radar.remembered = true;
  radar.start.clear();
  return true;
}

void WindowedFilter::set_has_elevation(std::size_t index, bool has_elevation) {
  Radar& radar = radars_[index];
  const Eigen::Matrix3d turned = solver_.radar(index).state.sensor_to_vehicle;
  const Eigen::Vector2d tilt_variance = solver_.radar(index).tilt_variance;
  const double yaw_variance = solver_.radar(index).covariance(own::kRotation + 2, own::kRotation + 2);
  solver_.set_prior(index, radar.nominal, has_elevation, radar.sums.knots().step_rad);
  if (!radar.remembered) return;
  restored_.number_of_radars = 0;
  const Eigen::Vector3d variances(tilt_variance.x(), tilt_variance.y(), std::max(yaw_variance, 1e-12));
  solver_.seed(index, turned, variances.asDiagonal());
}

bool WindowedFilter::contradicts_memory(std::size_t index, const StartResult& found, const ScanMotion3d& motion) const {
  constexpr double kStds = 3.0, kLoadStds = 3.0;
  const Point point = solver_.point(index, driven_s_, load_);
  const Eigen::Vector3d off = geometry::so3_log(found.sensor_to_vehicle * point.sensor_to_vehicle.transpose());
  // What the memory leaves open about pitch and yaw, as half a second shows them: with the fluctuations, and with the
  // vehicle's constants, of which slip and time offset act like a yaw in a turn.
  const Motion signalled{.speed_mps = motion.speed_mps,
                         .yaw_rate_radps = motion.yaw_rate_radps,
                         .acceleration_mps2 = motion.acceleration_mps2,
                         .clear_acceleration_mps2 = motion.acceleration_mps2,
                         .clear_yaw_acceleration_radps2 = motion.yaw_acceleration_radps2,
                         .yaw_rate_std_radps = 0.0};
  const ScanModel model = model_scan(point, radars_[index].config.mounting_pose.position_m, signalled);
  const Eigen::Matrix<double, 3, local::kCurve> by_parameter =
      point.sensor_to_vehicle * model.by_parameter.transpose() / std::max(std::abs(motion.speed_mps), 1.0);
  const Eigen::Matrix<double, local::kCurve, local::kCurve> covariance =
      solver_.block_covariance(index).topLeftCorner<local::kCurve, local::kCurve>();
  const auto limit = [&](int axis, double least_rad) {
    // About y the vertical component of the velocity shows it, about z the lateral one.
    const Eigen::Matrix<double, local::kCurve, 1> by = by_parameter.row(axis == 1 ? 2 : 1).transpose();
    return least_rad + kStds * std::sqrt(std::max(found.covariance(axis + 1, axis + 1), 0.0) + by.dot(covariance * by));
  };
  const bool pitched = found.searched[1] && solver_.radar(index).has_elevation &&
                       std::abs(off.y()) > limit(1, change_config_.pitch_rad + kLoadStds * priors_.load_std_rad);
  return pitched || std::abs(off.z()) > limit(2, change_config_.yaw_rad);
}

}  // namespace boresight::alignment
