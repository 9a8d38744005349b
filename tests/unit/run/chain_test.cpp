// The chain on a simulated drive: determinism, counts, order of the stages.
#include <gmock/gmock.h>

#include "services/boresight/run/rows.hpp"
#include "services/boresight/run/summary.hpp"
#include "tests/unit/run/drive_in_memory.hpp"

namespace boresight::run {
namespace {

using ::testing::HasSubstr;

struct DemoRun {
  testing::TextFiles files;
  VehicleConfig vehicle = testing::demo_vehicle();
  std::unique_ptr<Chain> chain = std::make_unique<Chain>(vehicle, Settings{}, files.listeners());
  GatewayFeed feed{*chain};

  DemoRun() {
    testing::play({testing::demo_drive().ego, testing::demo_drive().radars}, vehicle, *chain, feed);
    files.writer.flush();
  }
};

const DemoRun& demo_run() {
  static const DemoRun run;
  return run;
}

TEST(RunChain, GivesTheSameBytesTwice) {
  const DemoRun again;
  for (std::size_t i = 0; i < kFileNames.size(); ++i) {
    EXPECT_GT(again.files.texts[i].size(), 200u) << kFileNames[i];
    EXPECT_TRUE(again.files.texts[i] == demo_run().files.texts[i]) << kFileNames[i];
  }
}

TEST(RunChain, CountsAddUpAndAreThoseOfTheRows) {
  const Counts& counts = demo_run().chain->counts();
  std::uint64_t scans = 0, detections = 0, estimates = 0;
  for (const RadarConfig& radar : demo_run().vehicle.radars) {
    const RadarCounts& c = counts.radars[radar.id];
    EXPECT_GT(c.scans, 70u) << radar.name;
    std::uint64_t sum = 0;
    for (const std::uint64_t n : c.rejections) sum += n;
    for (const std::uint64_t n : c.origins) sum += n;
    EXPECT_EQ(sum, c.detections) << radar.name;
    scans += c.scans;
    detections += c.detections;
    estimates += c.estimates;
  }
  const testing::TextFiles& files = demo_run().files;
  const testing::Table scan_rows = testing::table_of(files.of(File::kScans));
  EXPECT_EQ(scan_rows.size(), scans);
  EXPECT_EQ(scans, testing::demo_drive().scans);
  EXPECT_EQ(detections, testing::demo_drive().number_of_detections);
  EXPECT_EQ(testing::table_of(files.of(File::kDetections)).size(), detections);
  EXPECT_EQ(testing::table_of(files.of(File::kTracks)).size(), counts.tracks);
  EXPECT_EQ(testing::table_of(files.of(File::kAlignment)).size(), estimates);
  std::uint64_t stated_detections = 0, stated_tracks = 0;
  for (const auto& row : scan_rows) {
    stated_detections += std::stoull(row.at("detections"));
    stated_tracks += std::stoull(row.at("tracks"));
  }
  EXPECT_EQ(stated_detections, detections);
  EXPECT_EQ(stated_tracks, counts.tracks);
  EXPECT_GT(counts.tracks, 100u);
}

TEST(RunChain, CorrectsAScanWithTheLatestEstimateThatCameBeforeIt) {
  const VehicleConfig vehicle = testing::demo_vehicle();
  std::map<std::uint32_t, std::uint64_t> published;  // sequence by radar
  std::size_t corrected = 0;
  const Chain* running = nullptr;
  const Listeners listeners{[&](const ScanResult& result) {
                              const std::uint64_t used = running->corrected().alignment_sequence;
                              if (used == 0) return;
                              ++corrected;
                              EXPECT_EQ(used, published[result.scan.header.source_id]);
                            },
                            [&](const EstimateResult& result) {
                              published[result.message.header.source_id] = result.message.header.sequence;
                            },
                            {}};
  Chain chain(vehicle, Settings{}, listeners);
  running = &chain;
  GatewayFeed feed(chain);
  testing::play({testing::demo_drive().ego, testing::demo_drive().radars}, vehicle, chain, feed);
  EXPECT_EQ(published.size(), vehicle.radars.size());
  EXPECT_GT(corrected, 20u);
}

TEST(RunChain, CountsSecondsFromTheFirstMeasurement) {
  const DemoRun& run = demo_run();
  EXPECT_NEAR(1e-9 * static_cast<double>(run.chain->length_ns()), 4.0, 0.2);
  for (const auto& row : testing::table_of(run.files.of(File::kScans))) {
    const std::int64_t since_ns = std::stoll(row.at("time_ns")) - run.chain->start_ns();
    EXPECT_NEAR(std::stod(row.at("t_s")), 1e-9 * static_cast<double>(since_ns), 0.6e-6);
  }
}

TEST(RunChain, RefusesAScanOfAnUnknownRadar) {
  Chain chain(testing::demo_vehicle(), Settings{});
  const auto scan = std::make_unique<RadarScan>();
  scan->header.source_id = 9;
  EXPECT_FALSE(chain.add_scan(*scan, 5));
  EXPECT_EQ(chain.counts().unknown_radar_scans, 1u);
}

TEST(RunChain, ProbabilitiesOfEveryRowSumToOne) {
  std::size_t classified = 0;
  for (const auto& row : testing::table_of(demo_run().files.of(File::kDetections))) {
    if (row.at("origin") == "unknown") {
      EXPECT_EQ(row.at("p_moving"), "");
      continue;
    }
    ++classified;
    double sum = 0.0;
    for (const char* const origin : {"moving", "stationary", "ghost_type_1", "ghost_type_2", "clutter", "ambiguity"}) {
      sum += std::stod(row.at(std::string("p_") + origin));
    }
    ASSERT_NEAR(sum, 1.0, 1e-5);
    EXPECT_EQ(row.at("rejected"), "");
  }
  EXPECT_GT(classified, 1000u);
}

TEST(RunRows, RejectedDetectionsNameTheFirstReason) {
  EXPECT_EQ(rejection_of(0), Rejection::kNone);
  EXPECT_EQ(rejection_of(corrected_flag::kMoving), Rejection::kNone);
  EXPECT_EQ(rejection_of(corrected_flag::kWeak), Rejection::kWeak);
  EXPECT_EQ(rejection_of(corrected_flag::kWeak | corrected_flag::kOutsideRegion), Rejection::kOutsideRegion);
  EXPECT_EQ(rejection_of(corrected_flag::kRejected), Rejection::kInvalid);
  EXPECT_EQ(names_of_flags(pipeline_flag::kNoAlignment | pipeline_flag::kTracksStale), "no_alignment+tracks_stale");
}

TEST(RunSummary, RadarNamesWithBlanksAndQuotesStayReadable) {
  VehicleConfig vehicle = testing::demo_vehicle();
  vehicle.radars[0].name = "front \"left\", ö\n";
  vehicle.radars[1].name = "broken \xFF";
  const std::string json = to_json(Summary{}, vehicle);
  EXPECT_THAT(json, HasSubstr(R"("name": "front \"left\", ö\n")"));
  EXPECT_THAT(json, HasSubstr("broken \xEF\xBF\xBD"));
}

}  // namespace
}  // namespace boresight::run
