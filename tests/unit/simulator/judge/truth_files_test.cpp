// The judge reads the tables as the simulator wrote them.
#include "services/simulator/judge/truth_files.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "services/simulator/truth_tables.hpp"

namespace boresight::judge {
namespace {

TEST(TruthFiles, DetectionsAreReadAsTheDriveHadThem) {
  VehicleConfig vehicle;
  for (const std::uint32_t id : {1u, 2u}) {
    RadarConfig radar;
    radar.id = id;
    radar.mounting_pose = {{3.6, id == 1 ? 0.7 : -0.7, 0.5}, id == 1 ? 0.8 : -0.8, 0.0, 0.0};
    vehicle.radars.push_back(radar);
  }
  const auto folder = std::filesystem::path(testing::TempDir()) / "truth_files_test";
  std::filesystem::create_directories(folder);
  const simulator::Scenario scenario = simulator::scenario("truck_overtaking");
  simulator::Drive drive(scenario, vehicle, 3, 0.6);
  simulator::TruthTables tables(folder, scenario, vehicle, 3);
  TrueScans expected;
  while (const simulator::Event* event = drive.next()) {
    if (event->scan == nullptr) continue;
    tables.add_scan(drive, *event);
    if (!event->truth->empty()) expected[event->scan->header.source_id].push_back({event->t_s, *event->truth});
  }
  tables.finish();
  std::ifstream file(folder / "truth_detections.csv");
  const TrueScans read = read_true_scans(file);
  ASSERT_EQ(read.size(), 2u);
  std::size_t ghosts = 0;
  for (const auto& [radar, scans] : expected) {
    ASSERT_EQ(read.at(radar).size(), scans.size());
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const TrueScan& scan = read.at(radar)[k];
      EXPECT_NEAR(scan.t_s, scans[k].t_s, 1e-6);
      ASSERT_EQ(scan.detections.size(), scans[k].detections.size());
      for (std::size_t i = 0; i < scan.detections.size(); ++i) {
        EXPECT_EQ(scan.detections[i].provenance, scans[k].detections[i].provenance);
        EXPECT_EQ(scan.detections[i].object_id, scans[k].detections[i].object_id);
        EXPECT_EQ(scan.detections[i].bounces, scans[k].detections[i].bounces);
        EXPECT_EQ(scan.detections[i].mirror_body, scans[k].detections[i].mirror_body);
        ghosts += scan.detections[i].bounces > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(ghosts, 0u) << "no detection with mirror reflections was compared";
  std::filesystem::remove_all(folder);
}

TEST(TruthFiles, InvalidLineIsNamed) {
  const std::string header = "t_s,radar,scan,index,provenance,object,bounces,mirror,source\n";
  for (const char* line : {"0.1,1,1,0,mowing,1,0,0,body", "0.1,1,1,0,moving,1,0", "0.1,1,1,5,moving,1,0,0,body", ""}) {
    std::istringstream table(header + "0.1,1,1,0,moving,1,0,0,body\n" + line + "\n");
    try {
      static_cast<void>(read_true_scans(table));
      ADD_FAILURE() << "accepted: " << line;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("truth_detections.csv:3: "));
    }
  }
}

TEST(TruthFiles, ObjectsAreInterpolatedAndParkedOnesOmitted) {
  std::istringstream table(
      "t_s,object,x_vehicle_m,y_vehicle_m,heading_rad,vx_over_ground_mps,vy_over_ground_mps,length_m,width_m,"
      "height_m,kind,parked\n"
      "0.0,1,10,2,3.1,5,0,4.5,1.8,1.5,car,0\n0.0,2,10,5,0,0,0,4.5,1.8,1.5,car,1\n0.0,3,50,0,0,5,0,4.5,1.8,1.5,car,0\n"
      "0.1,1,12,2,-3.1,7,0,4.5,1.8,1.5,car,0\n0.1,2,10,5,0,0,0,4.5,1.8,1.5,car,1\n");
  const TrueObjects objects(table);
  ASSERT_EQ(objects.at(0.05).size(), 1u) << "the third is gone, the second is parked";
  const Object o = objects.at(0.05).front();
  EXPECT_NEAR(o.position_m.x(), 11.0, 1e-9);
  EXPECT_NEAR(o.velocity_mps.x(), 6.0, 1e-9);
  EXPECT_NEAR(std::abs(std::remainder(o.heading_rad, 2.0 * M_PI)), M_PI, 1e-6) << "interpolated over the smaller angle";
  EXPECT_EQ(objects.at(0.0).size(), 2u);
  EXPECT_EQ(objects.at(9.0).size(), 1u);
  EXPECT_TRUE(TrueObjects().at(1.0).empty());
}

}  // namespace
}  // namespace boresight::judge
