// The static calibrations offline: tables in, results out, and what is refused.
#include <array>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include "services/alignment_estimator/core/memory/codec.hpp"
#include "services/alignment_estimator/store/memory_file.hpp"
#include "services/boresight/calibrate/plate_csv.hpp"
#include "services/boresight/calibrate/plate_feed.hpp"
#include "services/boresight/calibrate/plate_report.hpp"
#include "services/boresight/calibrate/reflectors_csv.hpp"
#include "services/boresight/calibrate/reflectors_report.hpp"
#include "services/boresight/calibrate/state_file.hpp"
#include "services/boresight/input/play.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/unit/calibrate/files.hpp"

namespace boresight::calibrate {
namespace {

namespace plate = alignment::plate;
namespace reflectors = alignment::reflectors;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kVehicle = std::string(BORESIGHT_SOURCE_DIR) + "/config/vehicle/demo.toml";

class Calibrate : public ::testing::Test {
 protected:
  plate::Measurements plate_of(const std::string& table) {
    recording::ByteSource source(folder_.write("plate.csv", table));
    return read_plate(source, problems_);
  }
  ReflectorTable reflectors_of(const std::string& table) {
    recording::ByteSource source(folder_.write("reflectors.csv", table));
    return read_reflectors(source, problems_);
  }

  struct Outcome {
    int exit_code;
    std::string output;  ///< standard output and error
  };
  static Outcome run(const std::string& arguments) {
    const std::string command = std::string(BORESIGHT_BINARY_DIR) + "/boresight calibrate " + arguments + " 2>&1";
    std::FILE* const pipe = popen(command.c_str(), "re");
    if (pipe == nullptr) return {-1, "popen failed"};
    Outcome outcome{0, {}};
    std::array<char, 4096> buffer;
    for (std::size_t got; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      outcome.output.append(buffer.data(), got);
    }
    outcome.exit_code = WEXITSTATUS(pclose(pipe));
    return outcome;
  }

  Folder folder_;
  std::vector<std::string> reported_;
  input::Problems problems_{[this](const std::string& text) { reported_.push_back(text); }};
};

simulator::PlateSpec misaligned() {
  simulator::PlateSpec spec;
  spec.pitch_rad = -0.8 / kDegreesPerRadian;
  spec.yaw_rad = 1.1 / kDegreesPerRadian;
  return spec;
}

TEST_F(Calibrate, a_plates_table_is_read_as_it_was_measured) {
  const plate::Measurements run = plate_of(testing::plate_table(misaligned(), 3));
  std::mt19937_64 random(3);
  const plate::Measurements expected = simulator::simulate_plate(misaligned(), random);
  EXPECT_EQ(problems_.bad_lines(), 0u);
  ASSERT_EQ(run.number_of_tilts, 11u);
  for (std::size_t i = 0; i < 11; ++i) {
    ASSERT_EQ(run.tilts[i].scans, 30u);
    EXPECT_NEAR(run.tilts[i].tilt_rad, expected.tilts[i].tilt_rad, 1e-12);
    EXPECT_NEAR(run.tilts[i].amplitude.mean(), expected.tilts[i].amplitude.mean(), 1e-9);
    EXPECT_NEAR(run.tilts[i].azimuth.mean(), expected.tilts[i].azimuth.mean(), 1e-12);
  }
}

TEST_F(Calibrate, a_plates_bad_rows_are_reported_with_line_value_and_what_is_allowed) {
  std::string table = "azimuth_deg,tilt_deg,amplitude_db\n0,-1,20\n0,25,20\n0,-1,x\n95,-1,20\n0,-1\n0,-1,nan\n";
  EXPECT_EQ(plate_of(table).tilts[0].scans, 1u);
  ASSERT_EQ(reported_.size(), 5u);
  EXPECT_THAT(reported_[0], HasSubstr("plate.csv:3:"));
  EXPECT_THAT(reported_[0], HasSubstr("tilt_deg: read \"25\", allowed is a number -20 … 20 deg"));
  EXPECT_THAT(reported_[1], HasSubstr("plate.csv:4:"));
  EXPECT_THAT(reported_[2], HasSubstr("azimuth_deg"));
  EXPECT_THAT(reported_[3], HasSubstr("columns"));
  reported_.clear();
  table = "tilt_deg,amplitude_db,azimuth_deg\n";
  for (int i = 0; i < 51; ++i) table += "1,20,0\n";
  for (int i = 0; i < 11; ++i) table += fmt::format("{},20,0\n", 2 + i);
  EXPECT_EQ(plate_of(table).number_of_tilts, 11u);
  ASSERT_EQ(reported_.size(), 2u);
  EXPECT_THAT(reported_[0], HasSubstr("more than 50 scans at a tilt of 1 deg"));
  EXPECT_THAT(reported_[1], HasSubstr("12 deg is tilt number 12"));
  EXPECT_THROW(static_cast<void>(plate_of("tilt_deg,azimuth_deg\n1,0\n")), input::TableError);
}

TEST_F(Calibrate, the_command_reports_a_plates_run) {
  simulator::PlateSpec spec = misaligned();
  spec.bad_tilts = 1;
  const std::string csv = folder_.write("run.csv", testing::plate_table(spec, 4));
  const Outcome outcome =
      run("plate --table " + csv + " --json " + folder_.path("r.json") + " --plot " + folder_.path("r.svg"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("not used"));
  EXPECT_THAT(outcome.output, HasSubstr("pitch -0."));
  EXPECT_THAT(outcome.output, HasSubstr("yaw   +1."));
  EXPECT_THAT(outcome.output, HasSubstr("the run is good"));
  const std::string json = folder_.read("r.json");
  EXPECT_THAT(json, HasSubstr("\"ok\":true"));
  EXPECT_THAT(json, Not(HasSubstr("\"seed\"")));
  const std::string svg = folder_.read("r.svg");
  EXPECT_THAT(svg, HasSubstr("tilt rejected by the fit"));
  EXPECT_THAT(svg, HasSubstr("</svg>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(run("plate --method published --json - --table " + csv).output, HasSubstr("{\"tool\""));
}

TEST_F(Calibrate, a_plates_recording_is_what_the_radar_saw_at_the_tilts) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle);
  const std::string pcap = folder_.path("plate.pcap");
  const std::string tilts = testing::record_plate(misaligned(), vehicle, 2, pcap, 3);
  recording::ByteSource source(folder_.write("tilts.csv", tilts));
  PlateFeed feed(2, read_tilts(source, problems_), {});
  ingest::Gateway gateway(vehicle, feed);
  input::play({pcap}, gateway, problems_, [](const auto&) {});
  EXPECT_EQ(problems_.bad_lines(), 0u);
  EXPECT_EQ(feed.rejected() + feed.doubtful() + feed.without_plate(), 0u);
  EXPECT_EQ(feed.within(), 330u);
  EXPECT_EQ(feed.scans(), 330u + 110u);
  std::mt19937_64 random(3);
  const plate::Measurements expected = simulator::simulate_plate(misaligned(), random);
  const plate::Measurements& run = feed.measurements();
  ASSERT_EQ(run.number_of_tilts, 11u);
  for (std::size_t i = 0; i < 11; ++i) {
    ASSERT_EQ(run.tilts[i].scans, 30u);
    EXPECT_NEAR(run.tilts[i].tilt_rad, expected.tilts[i].tilt_rad, 1e-12);
    for (std::size_t k = 0; k < 30; ++k) {
      EXPECT_NEAR(run.tilts[i].azimuth_rad[k], expected.tilts[i].azimuth_rad[k], 1e-6);
      EXPECT_NEAR(run.tilts[i].amplitude_db[k], expected.tilts[i].amplitude_db[k], 0.51) << "it is sent in whole dB";
    }
  }
}

TEST_F(Calibrate, the_command_calibrates_from_a_recording) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle);
  const std::string pcap = folder_.path("plate.pcap"), state = folder_.path("state");
  const std::string text = testing::record_plate(misaligned(), vehicle, 2, pcap, 4);
  const std::string of_radar = " --vehicle " + kVehicle + " --radar 2";
  const std::string recording = "plate --recording " + pcap, tilts = " --tilts " + folder_.write("tilts.csv", text);
  Outcome outcome = run(recording + tilts + of_radar + " --state " + state);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("the run is good"));
  const alignment::LoadedMemory loaded = alignment::load_memory(state, identity_of(vehicle));
  ASSERT_EQ(loaded.kind, alignment::LoadedMemory::Kind::kTaken) << loaded.reason;
  EXPECT_NEAR(loaded.memory.radars[1].rotation_vehicle_rad[2] * kDegreesPerRadian, 1.1, 0.1);
  EXPECT_NEAR(loaded.memory.radars[1].rotation_vehicle_rad[0] * kDegreesPerRadian, 0.8 * std::sqrt(0.5), 0.25);

  outcome = run(recording + tilts + of_radar + " --range-max 3.5");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("330 of 330 scans at the tilts do not show the plate"));
  EXPECT_THAT(outcome.output, HasSubstr("the run failed"));
  outcome = run(recording + tilts + " --radar 4 --vehicle " + kVehicle);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.output, HasSubstr("radar 4 rear_right has no scan in the recording"));
  outcome = run(recording + of_radar + " --tilts " +
                folder_.write("early.csv", "tilt_deg,begin_s,end_s\n-1,10,20\n0,20,30\n1,30,40\n"));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.output, HasSubstr("those of radar 2 front_right are from 1700000000."));
  EXPECT_EQ(run("plate --recording " + folder_.path("absent.pcap") + tilts + of_radar).exit_code, 3);

  EXPECT_EQ(run(recording + of_radar).exit_code, 2);
  EXPECT_EQ(run(recording + tilts).exit_code, 2);
  EXPECT_EQ(run("plate" + tilts + of_radar).exit_code, 2);
  EXPECT_EQ(run(recording + tilts + of_radar + " --table " + folder_.write("x.csv", "")).exit_code, 2);
}

TEST_F(Calibrate, impossible_tilts_are_reported) {
  recording::ByteSource source(folder_.write(
      "tilts.csv", "tilt_deg,begin_s,end_s\n-1,10,20\n0,19,30\n1,30,30\n25,40,50\n2,30,40\n3,40.5,nan\n"));
  const std::vector<TiltInterval> intervals = read_tilts(source, problems_);
  ASSERT_EQ(intervals.size(), 2u);
  EXPECT_NEAR(intervals[1].tilt_rad * kDegreesPerRadian, 2.0, 1e-12);
  ASSERT_EQ(reported_.size(), 4u);
  EXPECT_THAT(reported_[0], HasSubstr("tilts.csv:3:"));
  EXPECT_THAT(reported_[0], HasSubstr("begins at 19.000 s, before the tilt above it ends"));
  EXPECT_THAT(reported_[1], HasSubstr("the end, 30.000 s, is not after the begin, 30.000 s"));
  EXPECT_THAT(reported_[2], HasSubstr("tilt_deg: read \"25\""));
  EXPECT_THAT(reported_[3], HasSubstr("end_s"));
  std::string many = "tilt_deg,begin_s,end_s\n";
  for (int i = 0; i < 12; ++i) many += fmt::format("{},{},{}\n", i, 10 * i, 10 * i + 5);
  recording::ByteSource too_many(folder_.write("many.csv", many));
  EXPECT_EQ(read_tilts(too_many, problems_).size(), 11u);
  EXPECT_THAT(reported_.back(), HasSubstr("at most 11 tilts"));
}

TEST_F(Calibrate, a_run_without_a_maximum_says_so_and_exits_with_one) {
  std::string table = "tilt_deg,amplitude_db,azimuth_deg\n";
  for (int tilt = -5; tilt <= 5; ++tilt) {
    for (int k = 0; k < 10; ++k) table += fmt::format("{},{},0\n", tilt, 10.0 + 0.2 * tilt * tilt + 0.1 * (k % 3));
  }
  const std::string csv = folder_.write("bowl.csv", table);
  for (const char* method : {"robust", "published"}) {
    const Outcome outcome = run("plate --table " + csv + " --plot " + folder_.path("bowl.svg") + " --json " +
                                folder_.path("bowl.json") + " --method " + method);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("the amplitude has no maximum over the tilt"));
    EXPECT_THAT(folder_.read("bowl.json"), HasSubstr("\"pitch_deg\":null"));
    EXPECT_THAT(folder_.read("bowl.svg"), HasSubstr("failed: "));
  }
}

TEST_F(Calibrate, a_limit_that_the_bumper_misses_fails_the_run) {
  const std::string csv = folder_.write("run.csv", testing::plate_table(misaligned()));
  const Outcome outcome = run("plate --min-amplitude 30 --table " + csv);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("bumper"));
  const Outcome unwritable = run("plate --json /no/such/folder/x --table " + csv);
  EXPECT_EQ(unwritable.exit_code, 3);
  EXPECT_THAT(unwritable.output, HasSubstr("/no/such/folder/x: cannot be written: No such file or directory"));
}

TEST_F(Calibrate, tables_with_faults_are_not_calibrated_from) {
  std::string table = testing::plate_table(misaligned());
  table += "5,0,none,0\n";
  const std::string csv = folder_.write("run.csv", table);
  Outcome outcome = run("plate --table " + csv);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.output, HasSubstr("run.csv:333:"));
  EXPECT_THAT(outcome.output, HasSubstr("1 of 331 lines cannot be used"));
  outcome = run("plate --table " + folder_.write("none.csv", "tilt_deg,amplitude_db,azimuth_deg\n"));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.output, HasSubstr("no measurement"));
  EXPECT_EQ(run("plate --table " + folder_.path("absent.csv")).exit_code, 3);
}

TEST_F(Calibrate, wrong_command_lines_exit_with_two) {
  const std::string csv = folder_.write("run.csv", testing::plate_table(misaligned()));
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("plate").exit_code, 2);
  EXPECT_EQ(run("plate --table " + csv + " --method guess").exit_code, 2);
  EXPECT_EQ(run("plate --table " + csv + " --min-tilts 2").exit_code, 2);
  EXPECT_EQ(run("plate --table " + csv + " --json - --plot -").exit_code, 2);
  EXPECT_EQ(run("plate --table " + csv + " --state x").exit_code, 2);
  EXPECT_EQ(run("plate --table " + csv + " --vehicle " + kVehicle).exit_code, 2);
  const Outcome unknown = run("plate --table " + csv + " --radar 9 --vehicle " + kVehicle);
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.output, HasSubstr("has the radars 1, 2, 3, 4"));
  EXPECT_EQ(run("reflectors --table " + csv).exit_code, 2);
  const Outcome renamed = run("plate --csv " + csv);
  EXPECT_EQ(renamed.exit_code, 2);
  EXPECT_THAT(renamed.output, HasSubstr("is called --table now"));
}

TEST_F(Calibrate, a_plates_result_gets_into_the_estimators_memory) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle, config::VehicleUse::kOffline);
  const std::string csv = folder_.write("run.csv", testing::plate_table(misaligned())), state = folder_.path("state");
  const Outcome outcome = run("plate --table " + csv + " --state " + state + " --radar 2 --vehicle " + kVehicle);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  const alignment::LoadedMemory loaded = alignment::load_memory(state, identity_of(vehicle));
  ASSERT_EQ(loaded.kind, alignment::LoadedMemory::Kind::kTaken) << loaded.reason;
  ASSERT_EQ(loaded.memory.number_of_radars, 4u);
  EXPECT_EQ(loaded.memory.radars[1].id, 2u);
  // A radar at −45°: yaw is about z; looking down by 0.8° is a turn about its own level axis (sin 45°, cos 45°, 0).
  const auto& turn = loaded.memory.radars[1].rotation_vehicle_rad;
  EXPECT_NEAR(turn[2] * kDegreesPerRadian, 1.1, 0.1);
  EXPECT_NEAR(turn[0] * kDegreesPerRadian, 0.8 * std::sqrt(0.5), 0.25);
  EXPECT_NEAR(turn[1] * kDegreesPerRadian, 0.8 * std::sqrt(0.5), 0.25);
  EXPECT_EQ(loaded.memory.radars[0].rotation_vehicle_rad, (std::array<double, 3>{}));

  // A second radar's leaves the first one's as it was.
  ASSERT_EQ(run("plate --table " + csv + " --state " + state + " --radar 1 --vehicle " + kVehicle).exit_code, 0);
  const alignment::LoadedMemory both = alignment::load_memory(state, identity_of(vehicle));
  EXPECT_EQ(both.memory.radars[1].rotation_vehicle_rad, turn);
  EXPECT_NEAR(both.memory.radars[0].rotation_vehicle_rad[2] * kDegreesPerRadian, 1.1, 0.1);
}

TEST_F(Calibrate, a_damaged_memory_is_kept_as_rejected_and_begun_anew) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle, config::VehicleUse::kOffline);
  const std::string state = folder_.write("state", "rubbish");
  alignment::RotationSeed seed;
  seed.radar_id = 1;
  seed.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  EXPECT_THAT(seed_state_file(state, vehicle, seed), HasSubstr("kept as .rejected"));
  EXPECT_EQ(folder_.read("state.rejected"), "rubbish");
  EXPECT_EQ(alignment::load_memory(state, identity_of(vehicle)).kind, alignment::LoadedMemory::Kind::kTaken);
  seed.radar_id = 9;
  EXPECT_THROW(static_cast<void>(seed_state_file(state, vehicle, seed)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(seed_state_file("/no/such/folder/state", vehicle, seed)), std::runtime_error);
}

TEST_F(Calibrate, reflectors_seen_in_several_scans_are_their_medians) {
  const ReflectorTable table = reflectors_of(
      "x_m,y_m,z_m,range_m,azimuth_deg,elevation_deg\n"
      "10,1,0.6,9,1,0.1\n20,1,0.6,19,2,0.2\n10,1,0.6,9.4,5,0.3\n10,1,0.6,9.1,2,0.2\n");
  ASSERT_EQ(table.positions.size(), 2u);
  EXPECT_TRUE(table.has_elevation);
  EXPECT_EQ(table.positions[0].scans, 3u);
  EXPECT_DOUBLE_EQ(table.positions[0].range_m, 9.1);
  EXPECT_DOUBLE_EQ(table.positions[0].azimuth_rad, 2.0 / kDegreesPerRadian);
  EXPECT_DOUBLE_EQ(table.positions[0].elevation_rad, 0.2 / kDegreesPerRadian);
  EXPECT_EQ(table.lines, (std::vector<std::uint64_t>{2, 3}));
  EXPECT_FALSE(reflectors_of("x_m,y_m,z_m,range_m,azimuth_deg,elevation_deg\n10,1,0.6,9,1,\n").has_elevation);
  EXPECT_FALSE(reflectors_of("x_m,y_m,z_m,range_m,azimuth_deg\n10,1,0.6,9,1\n").has_elevation);
}

TEST_F(Calibrate, the_command_finds_a_corner_radars_error_from_reflectors) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle, config::VehicleUse::kOffline);
  const std::string csv =
      folder_.write("field.csv", testing::reflector_table(vehicle.radars[0].mounting_pose, 1.3, -0.6, 8.0));
  const Outcome outcome = run("reflectors --table " + csv + " --radar 1 --vehicle " + kVehicle + " --json " +
                              folder_.path("r.json") + " --state " + folder_.path("state"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("yaw   +1.300 ± "));
  EXPECT_THAT(outcome.output, HasSubstr("pitch -0.60 ± "));
  EXPECT_THAT(outcome.output, HasSubstr("published line (along the driving direction)"));
  EXPECT_THAT(folder_.read("r.json"), HasSubstr("\"seed\":{\"radar\":1"));
  const alignment::LoadedMemory loaded = alignment::load_memory(folder_.path("state"), identity_of(vehicle));
  ASSERT_EQ(loaded.kind, alignment::LoadedMemory::Kind::kTaken);
  EXPECT_NEAR(loaded.memory.radars[0].rotation_vehicle_rad[2] * kDegreesPerRadian, 1.3, 0.02);
}

TEST_F(Calibrate, the_command_does_without_elevation) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle, config::VehicleUse::kOffline);
  const std::string csv =
      folder_.write("field.csv", testing::reflector_table(vehicle.radars[0].mounting_pose, 1.3, 0.0, 8.0, false));
  const Outcome outcome = run("reflectors --table " + csv + " --radar 1 --vehicle " + kVehicle);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("pitch not observable"));
}

TEST_F(Calibrate, reflectors_out_of_range_or_too_few_are_named) {
  const VehicleConfig vehicle = config::read_vehicle_file(kVehicle, config::VehicleUse::kOffline);
  const std::string table = testing::reflector_table(vehicle.radars[0].mounting_pose, 1.3, 0.0, 8.0);
  Outcome outcome = run("reflectors --radar 1 --vehicle " + kVehicle + " --table " +
                        folder_.write("far.csv", table + "70,8,0.6,66,-35,0\n"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("far.csv:14: a reflector is nearer or farther than allowed: (70, 8, 0.6) m"));
  EXPECT_THAT(outcome.output, HasSubstr("allowed are 5 … 50 m"));
  std::string few = table;
  for (int i = 0; i < 3; ++i) few.resize(few.rfind('\n', few.size() - 2) + 1);
  outcome = run("reflectors --radar 1 --vehicle " + kVehicle + " --table " + folder_.write("few.csv", few));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.output, HasSubstr("too few reflector positions: 9 given, allowed are 10 or more"));
}

}  // namespace
}  // namespace boresight::calibrate
