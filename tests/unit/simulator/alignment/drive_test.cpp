// A statistical alignment drive has the stated truth, and each effect changes only the quantities that it concerns.
#include "services/simulator/alignment/drive.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/so3.hpp"

namespace boresight::simulator {
namespace {

/// The messages of a drive, as numbers.
struct Heard {
  struct Scan {
    double time_s;
    std::size_t radar;
    double speed_mps, yaw_rate_radps, lateral_speed_mps, vertical_speed_mps;
    std::vector<float> azimuth, elevation, range_rate, range, azimuth_std;
    std::vector<AlignmentDetectionTruth> truth;
    std::uint32_t fields;
  };
  struct Ego {
    double time_s, speed_mps, yaw_rate_radps;
    float signalled_speed_mps, signalled_yaw_rate_radps;
  };
  std::vector<Scan> scans;
  std::vector<Ego> egos;
};

Heard hear(const AlignmentSpec& spec) {
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  Heard heard;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      heard.egos.push_back(
          {event.time_s, event.speed_mps, event.yaw_rate_radps, event.ego->speed_mps, event.ego->yaw_rate_radps});
      continue;
    }
    const RadarScan& scan = *event.scan;
    const std::size_t n = scan.number_of_valid_detections;
    const auto copy = [n](const DetectionColumn<float>& column) {
      return std::vector<float>(column.data(), column.data() + n);
    };
    heard.scans.push_back({event.time_s, event.radar, event.speed_mps, event.yaw_rate_radps, event.lateral_speed_mps,
                           event.vertical_speed_mps, copy(scan.azimuth_rad), copy(scan.elevation_rad),
                           copy(scan.range_rate_mps), copy(scan.range_m), copy(scan.azimuth_std_rad), *event.truth,
                           scan.fields});
  }
  return heard;
}

AlignmentSpec short_drive(double duration_s = 10.0) {
  AlignmentSpec spec = four_corner_radars();
  spec.road = RoadKind::kCity;
  spec.seed = 3;
  spec.duration_s = duration_s;
  return spec;
}

AlignmentSpec without_noise(AlignmentSpec spec) {
  spec.outlier_share = 0.0;
  spec.speed_std_mps = spec.yaw_rate_std_radps = 0.0;
  for (AlignmentRadar& radar : spec.radars) {
    radar.noise_scale = 0.0;
    radar.config.noise.range_rate_std_mps = 0.0;
  }
  return spec;
}

TEST(AlignmentDrive, SameSeedSameDriveAnotherSeedAnother) {
  const Heard a = hear(short_drive()), b = hear(short_drive());
  AlignmentSpec other = short_drive();
  other.seed = 4;
  const Heard c = hear(other);
  ASSERT_EQ(a.scans.size(), b.scans.size());
  bool all_equal_to_other = a.scans.size() == c.scans.size();
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    EXPECT_EQ(a.scans[i].azimuth, b.scans[i].azimuth);
    EXPECT_EQ(a.scans[i].range_rate, b.scans[i].range_rate);
    if (all_equal_to_other) all_equal_to_other = a.scans[i].azimuth == c.scans[i].azimuth;
  }
  EXPECT_FALSE(all_equal_to_other);
}

TEST(AlignmentDrive, NoEffectChangesTheDrawsOfAnother) {
  const Heard plain = hear(short_drive());
  const auto with = [](const std::function<void(AlignmentSpec&)>& change) {
    AlignmentSpec spec = short_drive();
    change(spec);
    return hear(spec);
  };
  const std::vector<std::pair<const char*, Heard>> motions = {
      {"slip", with([](AlignmentSpec& s) { s.slip_coefficient_radps2pm = 0.003; })},
      {"body pitch", with([](AlignmentSpec& s) { s.body_pitch_std_rad = 0.3 * kRadiansPerDegree; })},
      {"brake pitch", with([](AlignmentSpec& s) { s.body_pitch_per_acceleration_radps2pm = 0.005; })},
  };
  for (const auto& [name, heard] : motions) {
    SCOPED_TRACE(name);
    ASSERT_EQ(heard.scans.size(), plain.scans.size());
    std::size_t changed = 0;
    for (std::size_t i = 0; i < plain.scans.size(); ++i) {
      ASSERT_EQ(heard.scans[i].azimuth, plain.scans[i].azimuth);
      ASSERT_EQ(heard.scans[i].elevation, plain.scans[i].elevation);
      ASSERT_EQ(heard.scans[i].range, plain.scans[i].range);
      if (heard.scans[i].range_rate != plain.scans[i].range_rate) ++changed;
    }
    EXPECT_GT(changed, plain.scans.size() / 4);
    for (std::size_t i = 0; i < plain.egos.size(); ++i) {
      ASSERT_EQ(heard.egos[i].signalled_speed_mps, plain.egos[i].signalled_speed_mps);
      ASSERT_EQ(heard.egos[i].signalled_yaw_rate_radps, plain.egos[i].signalled_yaw_rate_radps);
    }
  }
  const Heard biased = with([](AlignmentSpec& s) { s.yaw_rate_bias_radps = 0.002; });
  for (std::size_t i = 0; i < plain.egos.size(); ++i) {
    EXPECT_NEAR(biased.egos[i].signalled_yaw_rate_radps - plain.egos[i].signalled_yaw_rate_radps, 0.002, 1e-7);
  }
  for (std::size_t i = 0; i < plain.scans.size(); ++i) {
    ASSERT_EQ(biased.scans[i].range_rate, plain.scans[i].range_rate);
  }
  const Heard clean = with([](AlignmentSpec& s) { s.outlier_share = 0.0; });
  for (std::size_t i = 0; i < plain.scans.size(); ++i) {
    for (std::size_t k = 0; k < plain.scans[i].truth.size(); ++k) {
      if (!plain.scans[i].truth[k].stationary) continue;
      ASSERT_EQ(plain.scans[i].azimuth[k], clean.scans[i].azimuth[k]);
      ASSERT_EQ(plain.scans[i].range_rate[k], clean.scans[i].range_rate[k]);
    }
  }
}

/// The range rate by elementary rotations, written independently of the simulator. The sensor's roll, pitch and yaw
/// rotate the line of sight in this order; the sensor's motion is projected on it.
double expected_range_rate(const MountingPose& nominal, const Misalignment& m, double azimuth, double elevation,
                           const Heard::Scan& scan) {
  double x = std::cos(elevation) * std::cos(azimuth), y = std::cos(elevation) * std::sin(azimuth),
         z = std::sin(elevation);
  const auto turn = [](double& a, double& b, double angle) {
    const double turned = std::cos(angle) * a - std::sin(angle) * b;
    b = std::sin(angle) * a + std::cos(angle) * b;
    a = turned;
  };
  turn(y, z, nominal.roll_rad + m.roll_rad);
  turn(x, z, nominal.pitch_rad + m.pitch_rad);  // lifts the boresight
  turn(x, y, nominal.yaw_rad + m.yaw_rad);
  const double vx = scan.speed_mps - scan.yaw_rate_radps * nominal.position_m[1];
  const double vy = scan.lateral_speed_mps + scan.yaw_rate_radps * nominal.position_m[0];
  return -(x * vx + y * vy + z * scan.vertical_speed_mps);
}

TEST(AlignmentDrive, StationaryRangeRatesFollowAnyMounting) {
  AlignmentSpec spec = without_noise(short_drive());
  spec.radars[0].config.mounting_pose.pitch_rad = 6.0 * kRadiansPerDegree;
  spec.radars[1].config.mounting_pose.roll_rad = M_PI;
  spec.radars[2].config.mounting_pose.pitch_rad = -4.0 * kRadiansPerDegree;
  spec.radars[2].config.mounting_pose.roll_rad = M_PI;
  spec.radars[3].config.mounting_pose.roll_rad = 20.0 * kRadiansPerDegree;
  spec.slip_coefficient_radps2pm = 0.003;
  spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  spec.outlier_share = 0.2;
  double largest_yaw_rate = 0.0;
  for (const Heard::Scan& scan : hear(spec).scans) {
    const AlignmentRadar& radar = spec.radars[scan.radar];
    largest_yaw_rate = std::max(largest_yaw_rate, std::abs(scan.yaw_rate_radps));
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      if (!scan.truth[i].stationary) continue;
      const double expected = expected_range_rate(radar.config.mounting_pose, radar.truth, scan.truth[i].azimuth_rad,
                                                  scan.truth[i].elevation_rad, scan);
      ASSERT_NEAR(scan.range_rate[i], expected, 2e-5) << "radar " << scan.radar;
      ASSERT_NEAR(scan.azimuth[i], scan.truth[i].azimuth_rad, 1e-6);
      ASSERT_NEAR(scan.elevation[i], scan.truth[i].elevation_rad, 1e-6);
    }
  }
  EXPECT_GT(largest_yaw_rate, 0.02) << "the test needs a drive with bends";
}

TEST(AlignmentDrive, NoiseIsWhatIsStated) {
  AlignmentSpec spec = short_drive(60.0);
  spec.radars[1].noise_scale = 2.0;
  std::vector<double> sum(4), rate_sum(4);
  std::vector<std::size_t> count(4);
  for (const Heard::Scan& scan : hear(spec).scans) {
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      const double z = (scan.azimuth[i] - scan.truth[i].azimuth_rad) / scan.azimuth_std[i];
      sum[scan.radar] += z * z;
      if (!scan.truth[i].stationary) continue;
      const AlignmentRadar& radar = spec.radars[scan.radar];
      const double e =
          scan.range_rate[i] - expected_range_rate(radar.config.mounting_pose, radar.truth, scan.truth[i].azimuth_rad,
                                                   scan.truth[i].elevation_rad, scan);
      rate_sum[scan.radar] += e * e;
      ++count[scan.radar];
    }
  }
  const double all = 60.0 * 20.0 * 60.0;
  EXPECT_NEAR(std::sqrt(sum[0] / all), 1.0, 0.03);
  EXPECT_NEAR(std::sqrt(sum[1] / all), 2.0, 0.06);
  EXPECT_NEAR(std::sqrt(rate_sum[0] / static_cast<double>(count[0])), 0.03, 0.001);
  EXPECT_NEAR(static_cast<double>(count[0]) / all, 0.75, 0.02) << "share of outliers";
}

TEST(AlignmentDrive, NoisesAreIndependent) {
  const AlignmentSpec spec = short_drive(60.0);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double n = 0.0;
  for (const Heard::Scan& scan : hear(spec).scans) {
    const AlignmentRadar& radar = spec.radars[scan.radar];
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      const AlignmentDetectionTruth& t = scan.truth[i];
      if (!t.stationary) continue;
      const double rate =
          expected_range_rate(radar.config.mounting_pose, radar.truth, t.azimuth_rad, t.elevation_rad, scan);
      const Eigen::Vector3d z((scan.azimuth[i] - t.azimuth_rad) / scan.azimuth_std[i],
                              (scan.elevation[i] - t.elevation_rad) / (0.6 * kRadiansPerDegree),
                              (scan.range_rate[i] - rate) / 0.03);
      sum += z * z.transpose();
      n += 1.0;
    }
  }
  EXPECT_LT((sum / n - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.02) << sum / n;
}

TEST(AlignmentDrive, TheNoseGoesDownWhenBraking) {
  AlignmentSpec spec = short_drive(120.0);
  spec.body_pitch_per_acceleration_radps2pm = 0.004;
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  double last_speed = 0.0, last_vertical = 0.0;
  std::size_t braking = 0, gathering = 0;
  while (drive.next(event)) {
    if (event.ego == nullptr) continue;
    const double acceleration = (event.speed_mps - last_speed) * spec.ego_rate_hz;
    // Velocity in body axes: with the nose down the car moves towards its own roof. Changes of pitch are excluded.
    if (acceleration < -1.0 && last_vertical != 0.0 && std::abs(event.vertical_speed_mps / last_vertical - 1.0) < 0.1) {
      ++braking;
      EXPECT_NEAR(event.vertical_speed_mps / event.speed_mps, -0.004 * acceleration, 0.001);
    }
    if (acceleration > 1.0 && acceleration < 3.0 && event.vertical_speed_mps < 0.0) ++gathering;
    last_speed = event.speed_mps;
    last_vertical = event.vertical_speed_mps;
  }
  EXPECT_GT(braking, 20U);
  EXPECT_GT(gathering, 20U);
}

TEST(AlignmentDrive, RoadsAreOfTheirKind) {
  struct Seen {
    double slowest = 1e9, fastest = 0.0, turning = 0.0, lateral = 0.0, longitudinal = 0.0;
  };
  const auto see = [](RoadKind road) {
    AlignmentSpec spec;
    spec.duration_s = 600.0;
    spec.road = road;
    Seen seen;
    double last = 0.0, n = 0.0;
    for (const Heard::Ego& ego : hear(spec).egos) {
      seen.slowest = std::min(seen.slowest, ego.speed_mps);
      seen.fastest = std::max(seen.fastest, ego.speed_mps);
      seen.lateral = std::max(seen.lateral, std::abs(ego.speed_mps * ego.yaw_rate_radps));
      if (n > 0.0) seen.longitudinal = std::max(seen.longitudinal, std::abs(ego.speed_mps - last) * spec.ego_rate_hz);
      last = ego.speed_mps;
      n += 1.0;
      seen.turning += std::abs(ego.yaw_rate_radps);
    }
    seen.turning /= n;
    return seen;
  };
  const Seen city = see(RoadKind::kCity), motorway = see(RoadKind::kMotorway), straight = see(RoadKind::kStraight),
             slow = see(RoadKind::kSlow), mixed = see(RoadKind::kMixed);
  for (const Seen& seen : {city, motorway, straight, slow, mixed}) {
    EXPECT_GE(seen.slowest, 5.0 - 1e-9);
    EXPECT_LE(seen.lateral, 3.2 + 1e-9);
    EXPECT_LE(seen.longitudinal, 3.0 + 1e-6);
  }
  EXPECT_EQ(straight.turning, 0.0);
  EXPECT_GT(straight.fastest, straight.slowest + 5.0);
  EXPECT_GT(motorway.slowest, 23.9);
  EXPECT_LT(city.fastest, 15.1);
  EXPECT_LT(slow.fastest, 11.6);
  EXPECT_GT(city.turning, 3.0 * motorway.turning);
  EXPECT_GT(mixed.fastest, 25.0);
  EXPECT_GT(mixed.turning, 2.0 * motorway.turning);
}

TEST(AlignmentDrive, RangeRatesAreFoldedIntoTheUnambiguousInterval) {
  const Heard plain = hear(short_drive());
  AlignmentSpec spec = short_drive();
  spec.radars[0].ambiguity_mps = 12.0;
  const Heard folded = hear(spec);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < plain.scans.size(); ++i) {
    const bool has = (folded.scans[i].fields & scan_field::kAmbiguity) != 0;
    EXPECT_EQ(has, folded.scans[i].radar == 0);
    for (std::size_t k = 0; k < plain.scans[i].range_rate.size(); ++k) {
      const double a = plain.scans[i].range_rate[k], b = folded.scans[i].range_rate[k];
      if (folded.scans[i].radar != 0) {
        ASSERT_EQ(a, b);
        continue;
      }
      ASSERT_LE(std::abs(b), 6.0 + 1e-6);
      ASSERT_NEAR(std::remainder(a - b, 12.0), 0.0, 1e-5);
      if (std::abs(a - b) > 1.0) ++differ;
    }
  }
  EXPECT_GT(differ, 100U);
}

TEST(AlignmentDrive, AStepChangeTurnsOneRadarAtOneInstant) {
  AlignmentSpec spec = without_noise(short_drive());
  const Eigen::Vector3d turn(0.0, 0.02, 0.03);
  spec.step_changes.push_back({5.0, 2, turn});
  const AlignmentDrive drive(spec);
  const Eigen::Matrix3d before = drive.sensor_to_vehicle(2, 4.999), after = drive.sensor_to_vehicle(2, 5.0);
  EXPECT_LT((geometry::so3_log(after * before.transpose()) - turn).norm(), 1e-12);
  EXPECT_EQ(drive.sensor_to_vehicle(1, 4.0), drive.sensor_to_vehicle(1, 6.0));
  AlignmentSpec without = spec;
  without.step_changes.clear();
  const Heard a = hear(spec), b = hear(without);
  for (std::size_t i = 0; i < a.scans.size(); ++i) {
    const bool step_changed = a.scans[i].radar == 2 && a.scans[i].time_s >= 5.0;
    EXPECT_EQ(a.scans[i].azimuth != b.scans[i].azimuth, step_changed);
    EXPECT_EQ(a.scans[i].range_rate, b.scans[i].range_rate) << "range rates do not change";
  }
}

TEST(AlignmentDrive, RadarsKeepTheirOwnTime) {
  AlignmentSpec spec = short_drive();
  spec.radars[1].first_scan_s = 0.017;
  spec.radars[2].config.cycle_time_s = 0.07;
  AlignmentDrive drive(spec);
  AlignmentEvent event;
  double last_s = 0.0;
  bool last_was_scan = false;
  std::vector<std::vector<double>> times(4);
  while (drive.next(event)) {
    EXPECT_GE(event.time_s, std::max(last_s, 1.0));
    EXPECT_NE(event.ego == nullptr, event.scan == nullptr);
    if (event.ego != nullptr && last_was_scan) {
      EXPECT_GT(event.time_s, last_s) << "ego motion precedes scans";
    }
    last_s = event.time_s;
    last_was_scan = event.scan != nullptr;
    if (event.scan == nullptr) continue;
    EXPECT_EQ(event.scan->header.measurement_time_ns, std::llround(event.time_s * 1e9));
    EXPECT_EQ(event.scan->header.source_id, spec.radars[event.radar].config.id);
    EXPECT_EQ(event.scan->header.source_sequence, times[event.radar].size() + 1);
    times[event.radar].push_back(event.time_s);
  }
  EXPECT_EQ(times[0].size(), 200U);
  EXPECT_NEAR(times[1][3], 1.167, 1e-9);
  EXPECT_NEAR(times[2][3], 1.21, 1e-9);
  EXPECT_NEAR(last_s, 11.0, 0.1);
}

TEST(AlignmentDrive, ARadarWithoutElevationLacksTheField) {
  AlignmentSpec spec = short_drive(2.0);
  spec.radars[3].measures_elevation = false;
  const Heard plain = hear(short_drive(2.0)), heard = hear(spec);
  for (std::size_t i = 0; i < plain.scans.size(); ++i) {
    const Heard::Scan& scan = heard.scans[i];
    EXPECT_EQ((scan.fields & scan_field::kElevation) == 0, scan.radar == 3);
    if (scan.radar != 3) continue;
    EXPECT_EQ(scan.azimuth, plain.scans[i].azimuth);
    EXPECT_EQ(scan.range_rate, plain.scans[i].range_rate);
    for (const float elevation : scan.elevation) EXPECT_EQ(elevation, 0.0F);
  }
}

TEST(AlignmentDrive, StatesStdsOnlyWhereAsked) {
  AlignmentSpec spec = short_drive(1.0);
  spec.radars[0].states_stds = false;
  for (const Heard::Scan& scan : hear(spec).scans) {
    EXPECT_EQ((scan.fields & scan_field::kStds) == 0, scan.radar == 0);
    for (std::size_t i = 0; i < scan.truth.size(); ++i) {
      const double expected =
          scan.radar == 0 ? 0.0 : 0.3 * kRadiansPerDegree / std::max(std::cos(scan.truth[i].azimuth_rad), 0.35);
      ASSERT_NEAR(scan.azimuth_std[i], expected, 1e-8);
    }
  }
}

TEST(AlignmentDrive, EgoSignalsAreScaledAndNoisy) {
  double sum = 0.0, square = 0.0;
  const Heard heard = hear(short_drive(60.0));
  for (const Heard::Ego& ego : heard.egos) {
    const double e = ego.signalled_speed_mps - ego.speed_mps / 1.01;
    sum += e;
    square += e * e;
    EXPECT_LT(std::abs(ego.signalled_yaw_rate_radps - ego.yaw_rate_radps), 0.006);
  }
  const double n = static_cast<double>(heard.egos.size());
  EXPECT_EQ(heard.egos.size(), 1200U);
  EXPECT_NEAR(sum / n, 0.0, 0.003);
  EXPECT_NEAR(std::sqrt(square / n), 0.02, 0.002);
}

/// Moving detections of a scan: azimuth, and range rate without the part of the sensor's own motion.
std::vector<std::pair<double, double>> movers(const AlignmentRadar& radar, const Heard::Scan& scan) {
  std::vector<std::pair<double, double>> found;
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    const AlignmentDetectionTruth& t = scan.truth[i];
    if (t.stationary) continue;
    found.emplace_back(t.azimuth_rad, scan.range_rate[i] - expected_range_rate(radar.config.mounting_pose, radar.truth,
                                                                               t.azimuth_rad, t.elevation_rad, scan));
  }
  return found;
}

TEST(AlignmentDrive, MoversLastFromScanToScan) {
  AlignmentSpec spec = without_noise(short_drive(60.0));
  spec.outlier_share = 0.3;
  std::vector<std::vector<std::pair<double, double>>> scans;
  for (const Heard::Scan& scan : hear(spec).scans) {
    if (scan.radar == 0) scans.push_back(movers(spec.radars[0], scan));
  }
  // Share of moving detections with a detection of the same direction and speed `back` scans earlier.
  const auto known = [&scans](std::size_t back) {
    double matched = 0.0, all = 0.0;
    for (std::size_t k = back; k < scans.size(); ++k) {
      for (const auto& [azimuth, rate] : scans[k]) {
        const auto same = [&, a = azimuth, r = rate](const std::pair<double, double>& other) {
          return std::abs(other.first - a) < 6.0 * kRadiansPerDegree && std::abs(other.second - r) < 1.0;
        };
        all += 1.0;
        if (std::any_of(scans[k - back].begin(), scans[k - back].end(), same)) matched += 1.0;
      }
    }
    return matched / all;
  };
  EXPECT_GT(known(1), 0.6);
  EXPECT_LT(known(400), 0.35);
}

}  // namespace
}  // namespace boresight::simulator
