// The files of an alignment drive, read back by independent readers.
#include "services/simulator/alignment/csv_writer.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <unistd.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/alignment/bound.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/alignment/vehicle_toml.hpp"

namespace boresight::simulator {
namespace {

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("boresight_drive_" + std::to_string(getpid()))) {}
  ~Folder() { std::filesystem::remove_all(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> found;
  std::string cell;
  std::istringstream in(line);
  while (std::getline(in, cell, ',')) found.push_back(cell);
  if (!line.empty() && line.back() == ',') found.emplace_back();
  return found;
}

AlignmentSpec small_drive() {
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 3.0;
  spec.road = RoadKind::kCity;
  for (AlignmentRadar& radar : spec.radars) radar.states_stds = false;
  return spec;
}

const auto kNobodyListens = [](double) {};

TEST(AlignmentCsv, IsTheDriveRowByRow) {
  const Folder folder;
  AlignmentSpec spec = small_drive();
  spec.radars[1].measures_elevation = false;
  const AlignmentFiles files = write_alignment_drive(spec, folder.path(), kNobodyListens);
  std::ifstream detections(files.drive), egos(files.ego);
  std::string line;
  ASSERT_TRUE(std::getline(detections, line));
  EXPECT_EQ(line, "t,radar,range,az,el,vr,is_stationary");
  ASSERT_TRUE(std::getline(egos, line));
  EXPECT_EQ(line, "t,v,yaw_rate");

  AlignmentDrive drive(spec);
  AlignmentEvent event;
  std::uint64_t rows = 0, scans = 0;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      ASSERT_TRUE(std::getline(egos, line));
      const auto cell = cells(line);
      ASSERT_EQ(cell.size(), 3U);
      EXPECT_NEAR(std::stod(cell[0]), event.time_s - 1.0, 1e-9);
      EXPECT_NEAR(std::stod(cell[1]), event.ego->speed_mps, 1e-5);
      EXPECT_NEAR(std::stod(cell[2]), event.ego->yaw_rate_radps, 1e-6);
      continue;
    }
    ++scans;
    for (std::size_t i = 0; i < event.truth->size(); ++i, ++rows) {
      ASSERT_TRUE(std::getline(detections, line));
      const auto cell = cells(line);
      ASSERT_EQ(cell.size(), 7U);
      ASSERT_NEAR(std::stod(cell[0]), event.time_s - 1.0, 1e-9);
      ASSERT_EQ(std::stoul(cell[1]), event.radar + 1);
      ASSERT_NEAR(std::stod(cell[2]), event.scan->range_m[i], 0.006);
      ASSERT_NEAR(std::stod(cell[3]), event.scan->azimuth_rad[i], 1e-6);
      if (event.radar == 1) {
        ASSERT_EQ(cell[4], "");
      } else {
        ASSERT_NEAR(std::stod(cell[4]), event.scan->elevation_rad[i], 1e-6);
      }
      ASSERT_NEAR(std::stod(cell[5]), event.scan->range_rate_mps[i], 1e-4);
      ASSERT_EQ(cell[6] == "1", (*event.truth)[i].stationary);
    }
  }
  EXPECT_FALSE(std::getline(detections, line));
  EXPECT_FALSE(std::getline(egos, line));
  EXPECT_EQ(files.detections, rows);
  EXPECT_EQ(files.scans, scans);
  EXPECT_EQ(scans, 240U);
}

TEST(AlignmentCsv, StatedStdsAndAmbiguityHaveTheirColumns) {
  const Folder folder;
  AlignmentSpec spec = small_drive();
  spec.duration_s = 1.0;
  spec.radars[0].states_stds = true;
  spec.radars[1].ambiguity_mps = 20.0;
  std::ifstream in(write_alignment_drive(spec, folder.path(), kNobodyListens).drive);
  std::string line;
  ASSERT_TRUE(std::getline(in, line));
  EXPECT_EQ(line, "t,radar,range,az,el,vr,is_stationary,az_std,el_std,vr_std,vr_min,vr_max");
  while (std::getline(in, line)) {
    const auto cell = cells(line);
    ASSERT_EQ(cell.size(), 12U) << line;
    ASSERT_EQ(cell[7].empty(), cell[1] != "1");
    ASSERT_EQ(cell[10].empty(), cell[1] != "2");
    if (cell[1] == "1") {
      ASSERT_NEAR(std::stod(cell[9]), 0.03, 1e-9);
    }
    if (cell[1] == "2") {
      ASSERT_NEAR(std::stod(cell[11]) - std::stod(cell[10]), 20.0, 1e-9);
    }
  }
}

TEST(AlignmentCsv, TheServicesReadTheVehicleFile) {
  const Folder folder;
  AlignmentSpec spec = small_drive();
  spec.duration_s = 0.2;
  spec.radars[0].config.name = R"(a "named\" one)";
  spec.radars[2].config.mounting_pose.pitch_rad = -3.0 * kRadiansPerDegree;
  spec.radars[3].config.mounting_pose.roll_rad = M_PI;
  const VehicleConfig read =
      config::read_vehicle_file(write_alignment_drive(spec, folder.path(), kNobodyListens).vehicle);
  const VehicleConfig expected = AlignmentDrive(spec).vehicle();
  EXPECT_EQ(read.name, expected.name);
  EXPECT_DOUBLE_EQ(read.ego.speed_std_mps, 0.02);
  EXPECT_DOUBLE_EQ(read.ego.yaw_rate_std_radps, 0.001);
  ASSERT_EQ(read.radars.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const RadarConfig &a = read.radars[i], &b = expected.radars[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.mounting_pose.position_m, b.mounting_pose.position_m);
    EXPECT_NEAR(a.mounting_pose.yaw_rad, b.mounting_pose.yaw_rad, 1e-12);
    EXPECT_NEAR(a.mounting_pose.pitch_rad, b.mounting_pose.pitch_rad, 1e-12);
    EXPECT_NEAR(a.mounting_pose.roll_rad, b.mounting_pose.roll_rad, 1e-11);
    EXPECT_NEAR(a.field_of_view.azimuth_max_rad, b.field_of_view.azimuth_max_rad, 1e-12);
    EXPECT_NEAR(a.field_of_view.elevation_min_rad, b.field_of_view.elevation_min_rad, 1e-12);
    EXPECT_NEAR(a.noise.azimuth_std_rad, b.noise.azimuth_std_rad, 1e-12);
    EXPECT_DOUBLE_EQ(a.noise.range_rate_std_mps, b.noise.range_rate_std_mps);
    EXPECT_DOUBLE_EQ(a.cycle_time_s, b.cycle_time_s);
  }
}

/// The pairs "name value" of the line that begins with `kind`.
std::map<std::string, double> truth_line(const std::filesystem::path& file, const std::string& kind) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(kind, 0) != 0) continue;
    std::map<std::string, double> values;
    std::istringstream words(line);
    std::string key, word;
    for (; words >> word; key = word) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (end != word.c_str() && *end == '\0') values[key] = value;
    }
    return values;
  }
  return {};
}

TEST(AlignmentCsv, TruthIsThatOfTheDrive) {
  const Folder folder;
  AlignmentSpec spec = four_corner_radars();
  spec.duration_s = 20.0;
  spec.yaw_rate_bias_radps = 0.001;
  spec.slip_coefficient_radps2pm = 0.003;
  spec.body_pitch_std_rad = 0.3 * kRadiansPerDegree;
  const Eigen::Vector3d turn(0.0, 0.0, 1.0 * kRadiansPerDegree);
  spec.step_changes.push_back({11.0, 1, turn});
  const auto file = write_alignment_drive(spec, folder.path(), kNobodyListens).truth;
  EXPECT_NEAR(truth_line(file, "k_v")["k_v"], 1.01, 1e-9);
  const auto radar = truth_line(file, "radar 3");
  EXPECT_NEAR(radar.at("alpha_deg"), 1.0, 1e-9);
  EXPECT_NEAR(radar.at("beta_deg"), 2.0, 1e-9);
  EXPECT_NEAR(radar.at("gamma_deg"), -1.0, 1e-9);
  EXPECT_NEAR(radar.at("mount_az_deg"), 135.0, 1e-9);
  EXPECT_NEAR(radar.at("y"), 0.7, 1e-9);
  const auto disturbance = truth_line(file, "disturbance");
  EXPECT_NEAR(disturbance.at("yaw_rate_bias"), 0.001, 1e-9);
  EXPECT_NEAR(disturbance.at("rear_slip_coeff"), 0.003, 1e-9);
  EXPECT_NEAR(disturbance.at("pitch_std"), 0.3, 1e-9);
  const auto step_change = truth_line(file, "step_change");
  EXPECT_NEAR(step_change.at("t"), 10.0, 1e-9);
  EXPECT_NEAR(step_change.at("radar"), 2.0, 1e-9);
  EXPECT_NEAR(step_change.at("turn_z_deg"), 1.0, 1e-9);
  EXPECT_NEAR(step_change.at("alpha_deg"), 3.0, 1e-4) << "a rotation about the vehicle's z axis is a change of yaw";
  EXPECT_NEAR(step_change.at("beta_deg"), -1.0, 1e-4);
  AlignmentDrive drive(spec);
  CramerRaoBound bound(spec, drive, {0.02, 3.0 * kRadiansPerDegree, 0.003, 0.005});
  AlignmentEvent event;
  while (drive.next(event)) bound.add(event);
  EXPECT_NEAR(truth_line(file, "crlb_sd").at("kv") / bound.speed_scale_std(), 1.0, 0.01);
}

TEST(AlignmentCsv, ResidualsAreLikeThoseOfTheRecordedDrive) {
  const Folder folder;
  AlignmentSpec spec = small_drive();
  spec.duration_s = 120.0;
  spec.road = RoadKind::kMixed;
  const auto residual = truth_line(write_alignment_drive(spec, folder.path(), kNobodyListens).truth, "stationary");
  EXPECT_NEAR(residual.at("rmse_uncorrected"), 0.45, 0.08);  // the recorded drive has 0.4504 → 0.0989
  EXPECT_NEAR(residual.at("at_truth"), 0.099, 0.015);
}

TEST(AlignmentCsv, UnwritableFolderIsAnError) {
  EXPECT_THROW(write_alignment_drive(small_drive(), "/proc/nowhere", kNobodyListens), std::exception);
}

TEST(AlignmentSpec, RadarsOfAVehicleKeepTheirMountingAndARandomTruthIsWithinBounds) {
  VehicleConfig vehicle = AlignmentDrive(four_corner_radars()).vehicle();
  vehicle.radars.push_back(vehicle.radars.front());
  vehicle.radars.back().id = 7;
  vehicle.radars.back().mounting_pose.roll_rad = M_PI;
  vehicle.ego.speed_std_mps = 0.07;
  AlignmentSpec spec = radars_of(vehicle);
  ASSERT_EQ(spec.radars.size(), 5U);
  EXPECT_EQ(spec.radars[4].config.mounting_pose.roll_rad, M_PI);
  EXPECT_EQ(spec.radars[4].config.source.sender, "10.13.1.119");
  EXPECT_NEAR(spec.radars[4].truth.yaw_rad, -1.0 * kRadiansPerDegree, 1e-12);
  EXPECT_EQ(spec.speed_std_mps, 0.07);
  draw_truth(spec);
  const double first = spec.radars[0].truth.yaw_rad;
  for (const AlignmentRadar& radar : spec.radars) {
    for (const double angle : {radar.truth.yaw_rad, radar.truth.pitch_rad, radar.truth.roll_rad}) {
      EXPECT_LE(std::abs(angle), 3.0 * kRadiansPerDegree);
    }
  }
  EXPECT_NEAR(spec.speed_scale, 1.0, 0.03);
  spec.seed = 99;
  draw_truth(spec);
  EXPECT_NE(spec.radars[0].truth.yaw_rad, first);
}

}  // namespace
}  // namespace boresight::simulator
