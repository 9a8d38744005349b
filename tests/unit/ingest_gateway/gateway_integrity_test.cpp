// The gateway's integrity bits on a drive at wire level: quantised, interleaved, with the ego signals of a bus.
#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/simulator/drive_writer.hpp"

namespace boresight::ingest {
namespace {

namespace fs = std::filesystem;
using namespace scan_integrity;

/// Counts integrity bits by radar and bit.
class Verdicts : public Sink {
 public:
  RadarScan* begin_scan() override { return scan_.get(); }
  void publish_scan(std::uint32_t radar_id, const MeasurementTime& time) override {
    ++scans[radar_id];
    for (std::size_t bit = 0; bit < kNumberOfBits; ++bit) by_bit[radar_id][bit] += scan_->integrity >> bit & 1u;
    synchronised += time.source == TimeSource::kSensorSynchronised;
  }
  void discard_scan() override {}
  EgoMotion* begin_ego() override { return &ego_; }
  void publish_ego(const MeasurementTime&) override { ++egos; }
  void fault(Fault, std::string_view what, std::uint32_t) override { faults.emplace_back(what); }
  SourceStatistics& statistics(std::uint32_t radar_id) override { return source_statistics[radar_id]; }

  std::map<std::uint32_t, std::size_t> scans;
  std::map<std::uint32_t, std::array<std::size_t, kNumberOfBits>> by_bit;
  std::size_t synchronised = 0, egos = 0;
  std::vector<std::string> faults;
  std::array<SourceStatistics, kMaxRadars + 1> source_statistics{};

 private:
  std::unique_ptr<RadarScan> scan_ = std::make_unique<RadarScan>();
  EgoMotion ego_{};
};

class GatewayIntegrity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    vehicle_ = config::read_vehicle_file(fs::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
    files_ = simulator::write_drive(simulator::scenario("demo_drive"), vehicle_, 9, 20.0, folder(), [](double) {});
  }
  static void TearDownTestSuite() { fs::remove_all(folder()); }
  static fs::path folder() { return fs::temp_directory_path() / ("boresight-integrity-" + std::to_string(::getpid())); }

  /// The drive through a gateway; the n-th detection list arrives `copies(n)` times.
  template <typename Copies>
  static std::unique_ptr<Verdicts> drive(const Copies& copies) {
    auto verdicts = std::make_unique<Verdicts>();
    Gateway gateway(vehicle_, *verdicts);
    const auto reader = recording::open_recordings({files_.ego, files_.radars},
                                                   [](const std::string& problem) { ADD_FAILURE() << problem; });
    recording::Frame frame;
    int lists = 0;
    while (reader->next(frame)) {
      // The radars' status messages are UDP as well, and short.
      const bool is_list = frame.kind == recording::FrameKind::kUdp && frame.payload.size() > 1000;
      const int times = is_list ? copies(lists++) : 1;
      for (int i = 0; i < times; ++i) {
        // A copy arrives 20 ms later, not in one burst with the original.
        gateway.take(frame, {frame.stamp_ns + i * 20'000'000, 0, TimeSource::kLinkArrival});
      }
    }
    gateway.finish();
    return verdicts;
  }

  static inline VehicleConfig vehicle_;
  static inline simulator::DriveFiles files_;
};

TEST_F(GatewayIntegrity, AValidDriveHasNoIntegrityFaults) {
  const auto verdicts = drive([](int) { return 1; });
  ASSERT_EQ(verdicts->scans.size(), 4u);
  EXPECT_TRUE(verdicts->faults.empty()) << verdicts->faults.front();
  EXPECT_GT(verdicts->egos, 1500u);
  std::size_t scans = 0;
  for (const auto& [id, bits] : verdicts->by_bit) {
    scans += verdicts->scans[id];
    EXPECT_GE(verdicts->scans[id], 399u);
    for (std::size_t bit = 0; bit < kNumberOfBits; ++bit) EXPECT_EQ(bits[bit], 0u) << "radar " << id << " bit " << bit;
    EXPECT_EQ(verdicts->source_statistics[id].lost, 0u);
    EXPECT_EQ(verdicts->source_statistics[id].suspect, 0u);
  }
  EXPECT_EQ(verdicts->synchronised, scans);
}

TEST_F(GatewayIntegrity, LostAndRepeatedScansAreReportedForTheirRadarOnly) {
  // These radars have no counter, like the real one: stamps show gaps and repetitions.
  const auto verdicts = drive([](int n) { return n == 401 ? 0 : n == 802 ? 2 : 1; });
  std::size_t gaps = 0, repetitions = 0, others = 0;
  for (const auto& [id, bits] : verdicts->by_bit) {
    gaps += bits[0];
    repetitions += bits[1];
    EXPECT_EQ(bits[1], bits[3]) << "a stamp that has not advanced is stale as well";
    for (const std::size_t bit : {2u, 4u, 5u, 6u, 7u}) others += bits[bit];
  }
  EXPECT_EQ(gaps, 1u);
  EXPECT_EQ(repetitions, 1u);
  EXPECT_EQ(others, 0u);
}

}  // namespace
}  // namespace boresight::ingest
