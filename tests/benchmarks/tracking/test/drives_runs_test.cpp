// Reading of run folders, and the folders of drives.
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/benchmarks/tracking/drives/runs/drive_folder.hpp"
#include "tests/benchmarks/tracking/drives/runs/process.hpp"
#include "tests/benchmarks/tracking/drives/runs/run_reader.hpp"

namespace boresight::bench::tracking {
namespace {

namespace fs = std::filesystem;

fs::path empty_folder(const char* name) {
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

TEST(DrivesRunReader, ReadsScoresBesideTracksAndPassesOverListsWithoutTruth) {
  const fs::path run = empty_folder("drives_run"), truth = empty_folder("drives_truth");
  std::ofstream(run / "scans.csv") << "t_s,time_ns,radar,scan,detections,tracks\n"
                                      "0,1700000000000000000,1,1,0,2\n"
                                      "0.1,1700000000100000000,1,2,0,1\n"
                                      "9,1700000009000000000,1,3,0,1\n";
  std::ofstream(run / "tracks.csv")
      << "t_s,time_ns,radar,scan,id,status,movement,existence,x_vehicle_m,y_vehicle_m,vx_over_ground_mps,"
         "vy_over_ground_mps,heading_rad,length_m,width_m,cov_x_x,cov_x_y,cov_y_y\n"
         "0,1700000000000000000,1,1,7,confirmed,moving,0.75,20,1,9,0,0,4.5,1.8,1,0.5,2\n"
         "0,1700000000000000000,1,1,8,tentative,stopped,0.25,30,1,9,0,0,4.5,1.8,1,0.5,2\n"
         "0.1,1700000000100000000,1,2,8,tentative,moving,0.5,30,1,9,0,0,4.5,1.8,1,0.5,2\n"
         "9,1700000009000000000,1,3,8,tentative,moving,0.5,30,1,9,0,0,4.5,1.8,1,0.5,2\n";
  std::ofstream(truth / "truth_objects.csv")
      << "t_s,object,x_vehicle_m,y_vehicle_m,heading_rad,vx_over_ground_mps,vy_over_ground_mps,length_m,width_m,kind\n"
         "0,4,20,0,0,9,0,4.5,1.8,car\n0.2,4,20,0,0,9,0,4.5,1.8,car\n";
  RunReader reader(run, truth, kExistenceColumn);
  Scene scene;
  ASSERT_TRUE(reader.next(scene));
  ASSERT_EQ(scene.tracks.size(), 2u);
  EXPECT_DOUBLE_EQ(scene.tracks[0].score, 0.75);
  EXPECT_TRUE(scene.tracks[0].confirmed);
  EXPECT_DOUBLE_EQ(scene.tracks[0].position_covariance_m2(0, 1), 0.5);
  EXPECT_TRUE(scene.tracks[1].says_it_stands());
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].box.id, 4u);
  ASSERT_TRUE(reader.next(scene));
  EXPECT_NEAR(scene.t_s, 0.1, 1e-9);
  EXPECT_DOUBLE_EQ(scene.tracks.at(0).score, 0.5);
  EXPECT_FALSE(reader.next(scene)) << "the truth ends before the last list";
  EXPECT_THROW(RunReader(run, truth, kHitsColumn), score::InputError);
}

TEST(DrivesFolder, TheConfigurationWithoutAFilterDiffersInOneValue) {
  const fs::path config = empty_folder("drives_config"), copy = empty_folder("drives_config_copy");
  fs::create_directories(config / "services");
  std::ofstream(config / "services/tracker.toml") << "[clutter]\norigin_weight = 1.5   # a choice\norigin_limit = 10\n";
  write_unfiltered_config(config, copy);
  std::ifstream in(copy / "services/tracker.toml");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}),
            "[clutter]\norigin_weight = 0.0   # a choice\norigin_limit = 10\n");
  std::ofstream(config / "services/tracker.toml") << "[clutter]\n";
  EXPECT_THROW(write_unfiltered_config(config, copy), std::runtime_error);
}

TEST(DrivesFolder, FindsTheSeedsOfDrivesThatAreThere) {
  DriveSetup setup;
  setup.place = empty_folder("drives_place");
  DriveSpec drive{"series_77ghz", "junction", 42, 0.0};
  EXPECT_TRUE(seeds_there(setup, drive).empty());
  for (const char* const name : {"junction_42", "junction_7", "junction_9_10s", "junction_x", "tunnel_3"}) {
    fs::create_directories(setup.place / "series_77ghz" / name);
  }
  EXPECT_EQ(seeds_there(setup, drive), (std::vector<std::uint64_t>{7, 42}));
  drive.longest_s = 10.0;
  drive.seed = 9;
  EXPECT_EQ(seeds_there(setup, drive), (std::vector<std::uint64_t>{9}));
  EXPECT_EQ(folder_of(setup, drive).filename(), "junction_9_10s");
  drive.scenario = "somewhere/junction.toml";
  EXPECT_EQ(folder_of(setup, drive).filename(), "junction_9_10s");
}

TEST(DrivesProcess, ReturnsTheExitCodeAndKeepsTheOutput) {
  const fs::path log = empty_folder("drives_process") / "log.txt";
  EXPECT_EQ(run_program({"sh", "-c", "echo out; echo err >&2; exit 3"}, log), 3);
  try {
    run_program({"sh", "-c", "echo again; exit 4"}, log, {0, 1});
    FAIL() << "4 is not allowed";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("out\nerr\nagain"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace boresight::bench::tracking
