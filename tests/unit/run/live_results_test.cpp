// Messages of running services as results of the chain.
#include "services/boresight/run/live_results.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "services/boresight/run/summary.hpp"
#include "services/boresight/terminal/appended_file.hpp"
#include "services/boresight/terminal/output_file.hpp"
#include "tests/unit/run/drive_in_memory.hpp"

namespace boresight::run {
namespace {

/// The chain over the demo drive, and a listener who gets only its messages.
struct Spectated {
  testing::TextFiles of_chain, of_listener;
  std::optional<LiveResults> listener;

  LiveResults& listening(const Moment& at) {
    if (!listener) listener.emplace(of_listener.listeners(), at.start_ns);
    return *listener;
  }
  Spectated() {
    const VehicleConfig vehicle = testing::demo_vehicle();
    const Listeners to_files = of_chain.listeners();
    const Listeners listeners{[&](const ScanResult& result) {
                                to_files.scan(result);
                                LiveResults& live = listening(result.at);
                                // Any order: the listener's inputs are queues of their own.
                                if (result.number % 2 == 0) live.observe(result.tracks);
                                live.observe(result.scan);
                                live.observe(result.classified);
                                if (result.number % 2 != 0) live.observe(result.tracks);
                              },
                              [&](const EstimateResult& result) {
                                to_files.estimate(result);
                                listening(result.at).observe(result.message);
                              },
                              {}};
    Chain chain(vehicle, Settings{}, listeners);
    GatewayFeed feed(chain);
    testing::play({testing::demo_drive().ego, testing::demo_drive().radars}, vehicle, chain, feed);
    of_chain.writer.flush();
    listener->finish();
    of_listener.writer.flush();
  }
};

TEST(LiveResults, OfTheMessagesOfTheChainAreTheRowsOfTheChain) {
  const Spectated drive;
  for (const File file : {File::kScans, File::kDetections, File::kReflectors, File::kTracks, File::kRoadEdges,
                          File::kCollisionWarnings}) {
    const std::string& expected = drive.of_chain.of(file);
    EXPECT_GT(expected.size(), file == File::kCollisionWarnings ? 100u : 1000u);
    EXPECT_TRUE(drive.of_listener.of(file) == expected) << kFileNames[static_cast<std::size_t>(file)];
  }
  const auto expected = testing::table_of(drive.of_chain.of(File::kAlignment)),
             seen = testing::table_of(drive.of_listener.of(File::kAlignment));
  ASSERT_EQ(seen.size(), expected.size());
  ASSERT_GT(seen.size(), 20u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    for (const auto& [column, cell] : expected[i]) {
      if (!column.starts_with("rotation_") && !column.starts_with("cov_")) {
        EXPECT_EQ(seen[i].at(column), cell) << column;
        continue;
      }
      // The message holds angles and their covariance as floats.
      const double value = std::stod(cell), tolerance = 1e-7 + 1e-5 * std::abs(value);
      EXPECT_NEAR(std::stod(seen[i].at(column)), value, tolerance) << column;
    }
  }
  EXPECT_EQ(drive.listener->incomplete_scans(), (std::array<std::uint64_t, kMaxRadars + 1>{}));
}

class LiveScans : public ::testing::Test {
 protected:
  template <typename Message>
  std::unique_ptr<Message> message(std::uint32_t radar, std::int64_t time_ns) {
    auto result = std::make_unique<Message>();
    result->header.source_id = radar;
    result->header.source_sequence = 7;
    result->header.measurement_time_ns = time_ns;
    return result;
  }
  void whole_scan(std::uint32_t radar, std::int64_t time_ns) {
    results_.observe(*message<RadarScan>(radar, time_ns));
    results_.observe(*message<ClassifiedScan>(radar, time_ns));
    results_.observe(*message<TrackList>(radar, time_ns));
  }
  std::vector<std::int64_t> times_ns_;
  std::vector<ExtendedQualifier> verdicts_;
  LiveResults results_{
      {[this](const ScanResult& result) { times_ns_.push_back(result.at.time_ns); },
       {},
       [this](const HealthResult& result) { verdicts_.push_back(result.sensors[0].extended_qualifier); }}};
};

TEST_F(LiveScans, WithoutOneOfTheirMessagesAreCountedAndTheOthersAreResults) {
  constexpr std::int64_t kCycle_ns = 50'000'000;
  std::int64_t time_ns = kCycle_ns;
  results_.observe(*message<RadarScan>(1, time_ns));
  results_.observe(*message<TrackList>(1, time_ns));  // its classified_scan was lost
  for (int k = 0; k < 30; ++k) whole_scan(1, time_ns += kCycle_ns);
  EXPECT_EQ(times_ns_.size(), 30u);
  EXPECT_EQ(results_.incomplete_scans()[1], 1u);
  EXPECT_EQ(results_.counts().radars[1].scans, 30u);
  results_.observe(*message<RadarScan>(1, time_ns + kCycle_ns));
  results_.finish();
  EXPECT_EQ(results_.incomplete_scans()[1], 2u) << "at the end, too";
}

TEST_F(LiveScans, AreNoResultsWhicheverMessageIsMissing) {
  results_.observe(*message<ClassifiedScan>(1, 1));
  results_.observe(*message<TrackList>(1, 1));
  results_.observe(*message<RadarScan>(2, 1));
  results_.observe(*message<TrackList>(2, 1));
  results_.observe(*message<RadarScan>(3, 1));
  results_.observe(*message<ClassifiedScan>(3, 1));
  results_.finish();
  EXPECT_TRUE(times_ns_.empty());
  for (std::size_t radar = 1; radar <= 3; ++radar) EXPECT_EQ(results_.incomplete_scans()[radar], 1u) << radar;
}

TEST_F(LiveScans, EstimatesOfBeforeTheFirstMeasurementAreNoResults) {
  results_.observe(*message<AlignmentEstimate>(1, 50));
  results_.observe(*message<EgoMotion>(0, 100));
  results_.observe(*message<AlignmentEstimate>(1, 99));
  EXPECT_EQ(results_.counts().radars[1].estimates, 0u);
  results_.observe(*message<AlignmentEstimate>(1, 100));
  EXPECT_EQ(results_.counts().radars[1].estimates, 1u);
}

TEST_F(LiveScans, GoOnWhenTheClockOfTheMeasurementsJumpsBack) {
  for (std::int64_t t_s = 100; t_s < 120; ++t_s) whole_scan(2, t_s * 1'000'000'000);
  for (std::int64_t t_s = 1; t_s < 21; ++t_s) whole_scan(2, t_s * 1'000'000'000);
  EXPECT_EQ(times_ns_.size(), 40u);
}

TEST_F(LiveScans, OfNoRadarAreIgnored) {
  whole_scan(0, 1);
  whole_scan(kMaxRadars + 1, 1);
  EXPECT_TRUE(times_ns_.empty());
}

TEST_F(LiveScans, VerdictsAreResultsOnceASecondWhenTheyChangeAndAtTheEnd) {
  results_.observe(*message<EgoMotion>(0, 1));
  const auto report = std::make_unique<HealthReport>();
  report->number_of_sensors = 1;
  report->sensors[0].radar_id = 1;
  const auto publish = [&](std::int64_t time_ms, ExtendedQualifier reason) {
    report->header.measurement_time_ns = time_ms * 1'000'000;
    report->sensors[0].extended_qualifier = reason;
    results_.observe(*report);
  };
  for (std::int64_t time_ms = 0; time_ms <= 2000; time_ms += 100) publish(time_ms, ExtendedQualifier::kNormal);
  EXPECT_EQ(verdicts_.size(), 3u);
  publish(2100, ExtendedQualifier::kMisaligned);
  EXPECT_EQ(verdicts_.size(), 4u);
  publish(2200, ExtendedQualifier::kMisaligned);
  results_.finish();
  ASSERT_EQ(verdicts_.size(), 5u);
  EXPECT_EQ(verdicts_.back(), ExtendedQualifier::kMisaligned);
}

TEST(LiveSummary, HoldsTheBeginningOfTheTruthOnceItIsKnown) {
  const LiveResults results({});
  const LiveSummary summary{"1", "car.toml", "config", false, 5, results};
  const std::string text = with_truth_begin(to_json(summary, testing::demo_vehicle()), 1234);
  EXPECT_THAT(text, ::testing::HasSubstr("\"truth_begin_ns\": 1234"));
  EXPECT_THAT(text, ::testing::HasSubstr("\"tool\": \"boresight monitor\""));
  EXPECT_THROW(static_cast<void>(with_truth_begin("[", 1)), std::invalid_argument);
}

TEST(AppendedFile, RemovesALineThatWasCutOffAndGoesOnAfterTheWholeOnes) {
  const testing::TemporaryFolder folder("appended");
  const std::filesystem::path file = folder.path() / "rows.csv";
  const std::string whole = std::string(5000, 'a') + "\nb\n";
  std::ofstream(file) << whole << std::string(9000, 'c');
  {
    terminal::AppendedFile rows(file);
    rows.write("d\n");
    rows.check();
  }
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  EXPECT_EQ(text, whole + "d\n");
}

TEST(AppendedFile, KeepsTheFirstErrorUntilItIsAskedFor) {
  terminal::AppendedFile full("/dev/full");
  full.write("row\n");
  full.flush();
  full.write("row\n");
  EXPECT_THROW(full.check(), terminal::OutputError);
  EXPECT_THROW(terminal::AppendedFile("/dev/null/absent"), terminal::OutputError);
}

}  // namespace
}  // namespace boresight::run
