// highway_multipath has about the numbers of detections of Le Ba Thanh 2023.
#include <array>
#include <filesystem>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/drive.hpp"

namespace boresight::simulator {
namespace {

TEST(HighwayMultipath, HasThePublishedCountsWithinAFifth) {
  const VehicleConfig vehicle =
      config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/highway_multipath.toml");
  const Scenario highway = scenario("highway_multipath");
  for (const std::uint64_t seed : {1, 2, 3}) {
    Drive drive(highway, vehicle, seed, highway.duration_s);
    std::array<std::size_t, kNumberOfProvenances> counts{};
    std::array<std::size_t, 5> scans{};
    while (const Event* event = drive.next()) {
      if (event->scan == nullptr) continue;
      ++scans.at(event->scan->header.source_id);
      for (const DetectionTruth& truth : *event->truth) ++counts[static_cast<std::size_t>(truth.provenance)];
    }
    EXPECT_EQ(scans, (std::array<std::size_t, 5>{0, 114, 114, 114, 114}));
    const auto expect_near = [&](Provenance kind, double published) {
      EXPECT_NEAR(static_cast<double>(counts[static_cast<std::size_t>(kind)]), published, 0.2 * published)
          << static_cast<int>(kind) << ", seed " << seed;
    };
    expect_near(Provenance::kMoving, 1968.0);
    expect_near(Provenance::kStationary, 27064.0);
    expect_near(Provenance::kGhostType1, 833.0);
    expect_near(Provenance::kGhostType2, 3153.0);
    expect_near(Provenance::kClutter, 130.0);
    EXPECT_EQ(counts[static_cast<std::size_t>(Provenance::kUnknown)], 0u);
  }
}

}  // namespace
}  // namespace boresight::simulator
