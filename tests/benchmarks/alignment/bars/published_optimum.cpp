// The least-squares optimum of each model, by Gauss–Newton over all detections of a drive. Every method of that model
// ends there at best. The group separates errors of the model from errors of the method.
#include <memory>

#include <Eigen/Cholesky>

#include "services/alignment_estimator/core/batch_calibration/joint.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/published_result.hpp"
#include "tests/benchmarks/common/parallel.hpp"

namespace boresight::bench {

namespace {

using alignment::batch_calibration::Recording;
using alignment::batch_calibration::Solution;

enum class Model : std::uint8_t { kAzimuth, kPlanar, kRotation };

/// Which of Table 1's mounting errors apply, and the model that generates the detections.
struct Truth {
  const char* name;
  bool has_pitch, has_roll;
  simulator::MountingModel model;
  simulator::ElevationKind elevation;
};

using enum simulator::MountingModel;
using enum simulator::ElevationKind;

constexpr Truth kTable1{"planar, Table 1", true, true, kPlanar, kScene};

simulator::AlignmentSpec spec_of(const Truth& truth) {
  simulator::AlignmentSpec spec = simulator::published_setup();
  spec.model = truth.model;
  spec.elevation = truth.elevation;
  for (simulator::AlignmentRadar& radar : spec.radars) {
    if (!truth.has_pitch) radar.truth.pitch_rad = 0.0;
    if (!truth.has_roll) radar.truth.roll_rad = 0.0;
  }
  return spec;
}

/// The detections of every third scan.
std::vector<Recording> recordings_of(const simulator::AlignmentSpec& spec) {
  simulator::AlignmentDrive drive(spec);
  const VehicleConfig vehicle = drive.vehicle();
  std::vector<Recording> radars;
  for (const RadarConfig& radar : vehicle.radars) radars.push_back({radar.mounting_pose, true, {}});
  std::vector<std::size_t> scans(radars.size(), 0);
  const auto scan = std::make_unique<alignment::ScanDetections>();
  EgoHistory ego;
  for (simulator::AlignmentEvent event; drive.next(event);) {
    if (event.ego != nullptr) {
      ego.add(*event.ego);
      continue;
    }
    if (scans[event.radar]++ % 3 != 0) continue;
    alignment::take_detections(*event.scan, vehicle.radars[event.radar], *scan);
    const EgoSample motion = ego.at(event.scan->header.measurement_time_ns);
    for (std::size_t i = 0; i < scan->count; ++i) {
      radars[event.radar].detections.push_back({scan->azimuth_rad[i], scan->elevation_rad[i], scan->range_rate_mps[i],
                                                motion.speed_mps, motion.yaw_rate_radps});
    }
  }
  return radars;
}

/// (k_v, α, β, γ of each radar) of the best rotations.
Solution rotation_optimum(const std::vector<Recording>& radars) {
  const auto size = alignment::batch_calibration::first_angle(radars.size());
  double speed_scale = 1.0, squares = 0.0, count = 0.0;
  bool converged = false;
  std::vector<Eigen::Matrix3d> mounted;
  for (const Recording& radar : radars) mounted.push_back(geometry::sensor_to_vehicle(radar.nominal, 0.0, 0.0, 0.0));
  for (int round = 0; round < 20 && !converged; ++round) {
    squares = count = 0.0;
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t r = 0; r < radars.size(); ++r) {
      Eigen::Matrix4d jtj = Eigen::Matrix4d::Zero();
      Eigen::Vector4d jtr = Eigen::Vector4d::Zero();
      for (const auto& d : radars[r].detections) {
        const Eigen::Vector3d u = mounted[r] * geometry::direction(d.azimuth_rad, d.elevation_rad);
        const Eigen::Vector3d v =
            geometry::sensor_velocity(speed_scale, d.speed_mps, d.yaw_rate_radps, radars[r].nominal.position_m);
        Eigen::Vector4d gradient;
        gradient << -u.x() * d.speed_mps, -u.cross(v);  // R ← Exp(d)·R
        jtj += gradient * gradient.transpose();
        const double residual = geometry::stationary_range_rate(u, v) - d.range_rate_mps;
        jtr += gradient * residual;
        squares += residual * residual;
        count += 1.0;
      }
      const Eigen::Index at = alignment::batch_calibration::first_angle(r);
      information(0, 0) += jtj(0, 0);
      information.block<1, 3>(0, at) = jtj.topRightCorner<1, 3>();
      information.block<3, 1>(at, 0) = jtj.bottomLeftCorner<3, 1>();
      information.block<3, 3>(at, at) = jtj.bottomRightCorner<3, 3>();
      right(0) -= jtr(0);
      right.segment<3>(at) = -jtr.tail<3>();
    }
    const Eigen::VectorXd step = information.ldlt().solve(right);
    speed_scale += step(0);
    for (std::size_t r = 0; r < radars.size(); ++r) {
      mounted[r] = geometry::so3_exp(step.segment<3>(alignment::batch_calibration::first_angle(r))) * mounted[r];
    }
    converged = step.cwiseAbs().maxCoeff() < 1e-9;
  }
  Eigen::VectorXd found(size);
  found(0) = speed_scale;
  for (std::size_t r = 0; r < radars.size(); ++r) {
    const Eigen::Vector3d angles = geometry::euler_angles(mounted[r]);
    const MountingPose& nominal = radars[r].nominal;
    found.segment<3>(alignment::batch_calibration::first_angle(r)) << geometry::wrap_angle(angles(0) - nominal.yaw_rad),
        angles(1) - nominal.pitch_rad, geometry::wrap_angle(angles(2) - nominal.roll_rad);
  }
  return {found, std::sqrt(squares / count), converged};
}

Solution optimum(const std::vector<Recording>& radars, Model model) {
  if (model == Model::kRotation) return rotation_optimum(radars);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(alignment::batch_calibration::first_angle(radars.size()));
  start(0) = 1.0;
  std::vector<Eigen::Index> held;
  for (std::size_t r = 0; model == Model::kAzimuth && r < radars.size(); ++r) {
    for (const Eigen::Index i : {1, 2}) held.push_back(alignment::batch_calibration::first_angle(r) + i);
  }
  return alignment::batch_calibration::solve(radars, start, held);
}

struct Outcome {
  std::array<double, 4> bias{};  ///< mean over seeds and radars of the size of the error of each parameter; 1, degrees
  double rmse_mps = 0.0;         ///< mean over seeds
};

Outcome outcome_of(const Truth& truth, Model model, std::size_t seeds, const Options& options) {
  const std::vector<simulator::AlignmentSpec> specs = of_seeds(spec_of(truth), seeds, options.seconds(600.0));
  std::vector<Solution> found(seeds);
  parallel_for(seeds, options.jobs, [&](std::size_t i) { found[i] = optimum(recordings_of(specs[i]), model); });
  Outcome outcome;
  const auto runs = static_cast<double>(seeds);
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    const auto radars = static_cast<double>(specs[seed].radars.size());
    const Eigen::VectorXd& x = found[seed].parameters;
    outcome.rmse_mps += found[seed].rmse_mps / runs;
    outcome.bias[0] += std::abs(x(0) - specs[seed].speed_scale) / runs;
    for (std::size_t r = 0; r < specs[seed].radars.size(); ++r) {
      const simulator::Misalignment& m = specs[seed].radars[r].truth;
      const Eigen::Vector3d error = x.segment<3>(alignment::batch_calibration::first_angle(r)) -
                                    Eigen::Vector3d(m.yaw_rad, m.pitch_rad, m.roll_rad);
      for (std::size_t p = 1; p < 4; ++p) {
        outcome.bias[p] += std::abs(error(static_cast<Eigen::Index>(p) - 1)) / kRadiansPerDegree / (radars * runs);
      }
    }
  }
  return outcome;
}

}  // namespace

void published_optimum(const Options& options, Report& report) {
  const std::size_t seeds = options.seeds(3);
  Table table{"published_optimum",
              "least-squares optimum of each model over all detections of a drive: mean |error| over " +
                  std::to_string(seeds) + " seeds of " + fixed(options.seconds(600.0), 0) + " s × 4 radars",
              {"model", "truth", "k_v", "α °", "β °", "γ °", "RMSE m/s"},
              {}};
  const auto add = [&](const char* name, Model model, const Truth& truth) {
    const Outcome outcome = outcome_of(truth, model, seeds, options);
    std::vector<std::string> row = {name, truth.name, number(outcome.bias[0])};
    for (std::size_t p = 1; p < 4; ++p)
      row.push_back(model == Model::kAzimuth && p > 1 ? "—" : fixed(outcome.bias[p], 4));
    row.push_back(fixed(outcome.rmse_mps, 4));
    table.rows.push_back(std::move(row));
  };
  add("planar: k_v, α, β, γ", Model::kPlanar, kTable1);
  add("rotation: k_v, α, β, γ", Model::kRotation, kTable1);
  constexpr const char* kReference = "1-D: k_v, α";
  add(kReference, Model::kAzimuth, kTable1);
  for (const Truth& truth : {Truth{"planar, Table 1 without β", false, true, kPlanar, kScene},
                             Truth{"planar, Table 1 without γ", true, false, kPlanar, kScene},
                             Truth{"planar, Table 1 without β and γ", false, false, kPlanar, kScene},
                             Truth{"planar, Table 1, elevations −0.02 … 0.06 rad", true, true, kPlanar, kUniform},
                             Truth{"a rotation, Table 1", true, true, kExact, kScene},
                             Truth{"a rotation, Table 1, elevations −0.02 … 0.06 rad", true, true, kExact, kUniform}}) {
    add(kReference, Model::kAzimuth, truth);
  }
  table.rows.push_back({"*published:* 1-D reference", "", "6.63e-06", "0.0184", "—", "—", "0.0275"});
  report.add(std::move(table));
}

}  // namespace boresight::bench
