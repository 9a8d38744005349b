// The Cramér–Rao bound agrees with a dense computation by finite differences and with the bound that another program
// wrote beside a recorded drive. General properties of the bound hold on any road.
#include "services/simulator/alignment/bound.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::simulator {
namespace {

CramerRaoBound bound_of(const AlignmentSpec& spec, AlignmentDrive& drive, const BoundPriors& priors = {}) {
  CramerRaoBound bound(spec, drive, priors);
  AlignmentEvent event;
  while (drive.next(event)) bound.add(event);
  return bound;
}

/// The inputs of a detection's range rate as functions of one long vector: the parameters, then the errors of speed and
/// yaw rate for each ego motion, then the body pitch at each instant of a scan.
struct Model {
  struct Detection {
    Eigen::Vector3d sight;  // sensor axes
    Eigen::Matrix3d rotation;
    std::array<double, 3> position_m;
    Eigen::Index radar, ego, pitch;
    double signalled_speed, signalled_yaw_rate, pitch_rad, variance;
  };
  double speed_scale, slip;
  [[nodiscard]] double range_rate(const Detection& d, const Eigen::VectorXd& x) const {
    const Eigen::Vector3d u = geometry::so3_exp(x.segment<3>(3 + 3 * d.radar)) * (d.rotation * d.sight);
    const double v = (speed_scale + x(0)) * (d.signalled_speed + x(d.ego));
    const double w = d.signalled_yaw_rate - x(1) + x(d.ego + 1);
    const double lateral = -(slip + x(2)) * v * v * w;
    return -(u.x() * (v - w * d.position_m[1]) + u.y() * (lateral + w * d.position_m[0]) +
             u.z() * v * (d.pitch_rad + x(d.pitch)));
  }
};

TEST(CramerRaoBound, IsTheDenseInformationOfAllUnknowns) {
  AlignmentSpec spec = four_corner_radars();
  spec.radars.resize(2);
  spec.radars[0].config.mounting_pose.pitch_rad = 5.0 * kRadiansPerDegree;
  spec.radars[1].config.mounting_pose.roll_rad = M_PI;
  spec.radars[1].first_scan_s = 0.02;  // shares ego motions with the other radar, but not instants
  spec.radars[1].noise_scale = 1.5;
  spec.duration_s = 2.0;
  spec.road = RoadKind::kCity;
  spec.seed = 3;
  spec.slip_coefficient_radps2pm = 0.003;
  spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  for (AlignmentRadar& radar : spec.radars) radar.mean_detections = 15.0;
  const BoundPriors priors{0.02, 3.0 * kRadiansPerDegree, 0.003, 0.005};

  AlignmentDrive drive(spec);
  CramerRaoBound bound(spec, drive, priors);
  std::vector<Model::Detection> detections;
  std::vector<double> pitch_times;
  Eigen::Index egos = 0;
  AlignmentEvent event;
  while (drive.next(event)) {
    bound.add(event);
    if (event.ego != nullptr) {
      ++egos;
      continue;
    }
    if (pitch_times.empty() || pitch_times.back() != event.time_s) pitch_times.push_back(event.time_s);
    const AlignmentRadar& radar = spec.radars[event.radar];
    for (const AlignmentDetectionTruth& t : *event.truth) {
      if (!t.stationary) continue;
      Model::Detection d;
      d.sight = geometry::direction(t.azimuth_rad, t.elevation_rad);
      d.rotation = drive.sensor_to_vehicle(event.radar, event.time_s);
      d.position_m = radar.config.mounting_pose.position_m;
      d.radar = static_cast<Eigen::Index>(event.radar);
      d.ego = egos - 1;  // counted here; converted to positions below
      d.pitch = static_cast<Eigen::Index>(pitch_times.size()) - 1;
      d.signalled_speed = event.speed_mps / spec.speed_scale;
      d.signalled_yaw_rate = event.yaw_rate_radps;
      d.pitch_rad = event.vertical_speed_mps / event.speed_mps;
      // Variance by finite differences over the angles.
      const Eigen::Vector3d velocity(event.speed_mps - event.yaw_rate_radps * d.position_m[1],
                                     event.lateral_speed_mps + event.yaw_rate_radps * d.position_m[0],
                                     event.vertical_speed_mps);
      const auto rate = [&](double azimuth, double elevation) {
        return -(d.rotation * geometry::direction(azimuth, elevation)).dot(velocity);
      };
      constexpr double h = 1e-5;
      const double da = (rate(t.azimuth_rad + h, t.elevation_rad) - rate(t.azimuth_rad - h, t.elevation_rad)) / 2 / h;
      const double de = (rate(t.azimuth_rad, t.elevation_rad + h) - rate(t.azimuth_rad, t.elevation_rad - h)) / 2 / h;
      const SensorNoise& noise = radar.config.noise;
      const double sa = radar.noise_scale * noise.azimuth_std_rad / std::max(std::cos(t.azimuth_rad), 0.35);
      const double se = radar.noise_scale * noise.elevation_std_rad;
      d.variance = std::pow(noise.range_rate_std_mps, 2) + std::pow(da * sa, 2) + std::pow(de * se, 2);
      detections.push_back(d);
    }
  }

  constexpr Eigen::Index kParameters = 3 + 2 * 3;
  const auto instants = static_cast<Eigen::Index>(pitch_times.size());
  const Eigen::Index size = kParameters + 2 * egos + instants;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  const double p2 = std::pow(spec.body_pitch_std_rad, -2);
  information.diagonal() << std::pow(0.02, -2), std::pow(0.003, -2), std::pow(0.005, -2),
      Eigen::VectorXd::Constant(6, std::pow(3.0 * kRadiansPerDegree, -2)), Eigen::VectorXd::Zero(2 * egos + instants);
  for (Eigen::Index i = 0; i < egos; ++i) {
    information(kParameters + 2 * i, kParameters + 2 * i) = std::pow(spec.speed_std_mps, -2);
    information(kParameters + 2 * i + 1, kParameters + 2 * i + 1) = std::pow(spec.yaw_rate_std_radps, -2);
  }
  Eigen::MatrixXd pitch(instants, instants);  // covariance of the process at the instants
  for (Eigen::Index i = 0; i < instants; ++i) {
    for (Eigen::Index k = 0; k < instants; ++k) {
      const double apart_s =
          std::abs(pitch_times[static_cast<std::size_t>(i)] - pitch_times[static_cast<std::size_t>(k)]);
      pitch(i, k) = std::exp(-apart_s / spec.body_pitch_correlation_s) / p2;
    }
  }
  information.bottomRightCorner(instants, instants) += pitch.inverse();

  const Model model{spec.speed_scale, spec.slip_coefficient_radps2pm};
  for (Model::Detection d : detections) {
    d.ego = kParameters + 2 * d.ego;
    d.pitch = kParameters + 2 * egos + d.pitch;
    const std::array<Eigen::Index, 9> place{0,     1,         2,      3 + 3 * d.radar, 4 + 3 * d.radar, 5 + 3 * d.radar,
                                            d.ego, d.ego + 1, d.pitch};
    Eigen::Matrix<double, 9, 1> gradient;
    for (std::size_t i = 0; i < place.size(); ++i) {
      constexpr double h = 1e-5;
      Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
      x(place[i]) = h;
      const double above = model.range_rate(d, x);
      x(place[i]) = -h;
      gradient(static_cast<Eigen::Index>(i)) = (above - model.range_rate(d, x)) / (2.0 * h);
    }
    for (std::size_t i = 0; i < place.size(); ++i) {
      for (std::size_t k = 0; k < place.size(); ++k) {
        information(place[i], place[k]) +=
            gradient(static_cast<Eigen::Index>(i)) * gradient(static_cast<Eigen::Index>(k)) / d.variance;
      }
    }
  }
  const Eigen::MatrixXd dense = information.inverse().topLeftCorner(kParameters, kParameters);
  const Eigen::MatrixXd ours = bound.covariance();
  for (Eigen::Index i = 0; i < kParameters; ++i) {
    for (Eigen::Index k = 0; k < kParameters; ++k) {
      EXPECT_NEAR(ours(i, k) / std::sqrt(dense(i, i) * dense(k, k)), dense(i, k) / std::sqrt(dense(i, i) * dense(k, k)),
                  1e-4)
          << i << "," << k;
    }
  }
}

TEST(CramerRaoBound, OfADriveLikeTheRecordedOneIsAsPublishedWithIt) {
  AlignmentSpec spec = four_corner_radars();
  spec.seed = 2;
  AlignmentDrive drive(spec);
  const CramerRaoBound bound = bound_of(spec, drive);
  EXPECT_NEAR(bound.speed_scale_std(), 1.89e-5, 0.19e-5);
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Vector3d std = bound.rotation_std_rad(r) / kRadiansPerDegree;
    EXPECT_NEAR(std.x(), r < 2 ? 0.179 : 0.723, r < 2 ? 0.018 : 0.072);
    EXPECT_NEAR(std.y(), 0.0087, 0.00087);
    EXPECT_NEAR(std.z(), 0.0012, 0.00012);
  }
}

/// Lines of a table without its header; decompressed by `xz` if needed.
std::vector<std::vector<double>> read_table(const std::filesystem::path& file, std::size_t columns) {
  const std::string command = (file.extension() == ".xz" ? "xz -dc '" : "cat '") + file.string() + "'";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::vector<std::vector<double>> rows;
  std::array<char, 256> line{};
  while (pipe && std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) {
    std::vector<double> row;
    const char* at = line.data();
    for (std::size_t i = 0; i < columns; ++i) {
      char* end = nullptr;
      row.push_back(std::strtod(at, &end));
      if (end == at) break;
      at = end + 1;
    }
    if (row.size() == columns) rows.push_back(std::move(row));
  }
  return rows;
}

TEST(CramerRaoBound, OfTheRecordedDriveIsThatOfItsTruthFile) {
  const std::filesystem::path folder = std::filesystem::path(BORESIGHT_SHARED_DATA) / "alignment_drive";
  if (!std::filesystem::exists(folder / "drive_1.csv.xz")) GTEST_SKIP() << "skipped: no shared data";
  const auto rows = read_table(folder / "drive_1.csv.xz", 7), egos = read_table(folder / "ego_1.csv", 3);
  if (rows.empty()) GTEST_SKIP() << "skipped: no xz to decompress the recording";
  ASSERT_GT(rows.size(), 800'000U);
  const AlignmentSpec spec = four_corner_radars();
  const AlignmentDrive drive(spec);
  CramerRaoBound bound(spec, drive);
  std::vector<AlignmentDetectionTruth> detections;
  const RadarScan scan{};
  const EgoMotion ego{};
  std::size_t next = 0;
  for (const std::vector<double>& motion : egos) {
    AlignmentEvent event;
    event.time_s = motion[0];
    event.ego = &ego;
    bound.add(event);
    event.ego = nullptr;
    event.scan = &scan;
    event.speed_mps = 1.01 * motion[1];
    event.yaw_rate_radps = motion[2];
    event.truth = &detections;
    while (next < rows.size() && std::abs(rows[next][0] - motion[0]) < 0.01) {
      const double radar = rows[next][1];
      detections.clear();
      for (; next < rows.size() && rows[next][1] == radar && std::abs(rows[next][0] - motion[0]) < 0.01; ++next) {
        detections.push_back({rows[next][6] > 0.5, rows[next][3], rows[next][4]});
      }
      event.radar = static_cast<std::size_t>(radar) - 1;
      bound.add(event);
    }
  }
  ASSERT_EQ(next, rows.size());
  EXPECT_NEAR(bound.speed_scale_std() / 1.89e-5, 1.0, 0.05);
  const std::array<double, 4> roll_deg{0.1817, 0.1760, 0.7255, 0.7202};
  for (std::size_t r = 0; r < 4; ++r) {
    const Eigen::Vector3d std = bound.rotation_std_rad(r) / kRadiansPerDegree;
    EXPECT_NEAR(std.x() / roll_deg[r], 1.0, 0.05);
    EXPECT_NEAR(std.y() / 0.0087, 1.0, 0.05);
    EXPECT_NEAR(std.z() / 0.0012, 1.0, 0.05);  // the file has two digits
  }
}

TEST(CramerRaoBound, InformationGrowsAlongTheDrive) {
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 60.0;
  spec.road = RoadKind::kCity;
  AlignmentDrive drive(spec);
  CramerRaoBound bound(spec, drive, {0.02, 3.0 * kRadiansPerDegree, 0.003, 0.005});
  AlignmentEvent event;
  Eigen::MatrixXd before = bound.covariance();
  EXPECT_NEAR(std::sqrt(before(1, 1)), 0.003, 1e-12);
  double next_s = 5.0;
  while (drive.next(event)) {
    bound.add(event);
    if (event.time_s < next_s) continue;
    next_s += 5.0;
    const Eigen::MatrixXd now = bound.covariance();
    const Eigen::VectorXd scale = before.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd gain = scale.asDiagonal() * (before - now) * scale.asDiagonal();
    const Eigen::MatrixXd shifted = gain + 1e-9 * Eigen::MatrixXd::Identity(gain.rows(), gain.cols());
    EXPECT_EQ(shifted.llt().info(), Eigen::Success) << "no parameter becomes less certain, at " << event.time_s << " s";
    before = now;
  }
  EXPECT_LT(bound.rotation_std_rad(0).z(), 0.005 * kRadiansPerDegree);
}

TEST(CramerRaoBound, RollIsUnobservableOnAStraightRoad) {
  AlignmentSpec spec = four_corner_radars();
  spec.road = RoadKind::kStraight;
  spec.duration_s = 30.0;
  AlignmentDrive drive(spec);
  const CramerRaoBound bound = bound_of(spec, drive);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_NEAR(bound.rotation_std_rad(r).x(), 3.0 * kRadiansPerDegree, 1e-6);
    EXPECT_LT(bound.rotation_std_rad(r).z(), 0.01 * kRadiansPerDegree);
  }
}

TEST(CramerRaoBound, DisturbancesAndMissingElevationRaiseIt) {
  const auto yaw_of = [](const AlignmentSpec& spec, const BoundPriors& priors) {
    AlignmentDrive drive(spec);
    return bound_of(spec, drive, priors).rotation_std_rad(0);
  };
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 30.0;
  spec.road = RoadKind::kCity;
  const Eigen::Vector3d plain = yaw_of(spec, {});
  const Eigen::Vector3d unknown = yaw_of(spec, {0.02, 3.0 * kRadiansPerDegree, 0.003, 0.005});
  EXPECT_GT(unknown.z(), 1.02 * plain.z());
  AlignmentSpec noisy = spec;
  noisy.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  EXPECT_GT(yaw_of(noisy, {}).y(), 1.1 * plain.y());
  AlignmentSpec flat = spec;
  flat.radars[0].measures_elevation = false;
  const Eigen::Vector3d blind = yaw_of(flat, {});
  EXPECT_NEAR(blind.x(), 3.0 * kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(blind.y(), 3.0 * kRadiansPerDegree, 1e-9);
  EXPECT_LT(blind.z(), 0.02 * kRadiansPerDegree);
}

TEST(CramerRaoBound, SlowScansCountOnlyAboveTheMinimumSpeed) {
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 20.0;
  spec.road = RoadKind::kCity;
  BoundPriors priors;
  AlignmentDrive drive(spec);
  CramerRaoBound all(spec, drive, priors), by_hand(spec, drive, priors);
  priors.min_speed_mps = 9.0;
  CramerRaoBound fast(spec, drive, priors);
  AlignmentEvent event;
  double signalled_mps = 0.0;
  std::size_t scans = 0, slow = 0;
  while (drive.next(event)) {
    if (event.ego != nullptr) signalled_mps = static_cast<double>(event.ego->speed_mps);
    const bool is_slow = event.scan != nullptr && signalled_mps < priors.min_speed_mps;
    scans += event.scan != nullptr ? 1 : 0;
    slow += is_slow ? 1 : 0;
    fast.add(event);
    all.add(event);
    if (!is_slow) by_hand.add(event);
  }
  ASSERT_GT(slow, scans / 10);
  ASSERT_LT(slow, scans);
  EXPECT_EQ(fast.covariance(), by_hand.covariance());
  EXPECT_GT(fast.rotation_std_rad(0).x(), 1.05 * all.rotation_std_rad(0).x());
}

TEST(CramerRaoBound, RefusesThePlanarModel) {
  const AlignmentSpec spec = published_setup();
  const AlignmentDrive drive(spec);
  EXPECT_THROW(CramerRaoBound(spec, drive), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::simulator
