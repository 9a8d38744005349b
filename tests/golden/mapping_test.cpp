// Public DBC files are read without a problem. A recording decoded by a mapping gives the same as the hand-written
// codec.
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/ingest_gateway/codecs/table_ego.hpp"
#include "services/ingest_gateway/codecs/table_radar.hpp"
#include "services/ingest_gateway/codecs/toyota_radar.hpp"
#include "services/ingest_gateway/dbc/dbc.hpp"
#include "services/ingest_gateway/mapping/mapping_file.hpp"
#include "tests/golden/support/decoded.hpp"

namespace boresight::golden {
namespace {

namespace fs = std::filesystem;

const fs::path kDbcFolder = shared_data() / "opendbc_radar";
const fs::path kMappingRecording = shared_data() / "comma2k19_seg40/radar_ego.candump.log";

constexpr std::string_view kRadarMapping = R"(kind = "radar"
dbc = "DBC"
[cycle]
end = "all_messages"
timeout_ms = 20
[[detections]]
index = [0, 15]
counter = "COUNTER"
[[detections.message]]
name = "TRACK_A_{}"
checksum = "toyota"
[[detections.message]]
name = "TRACK_B_{}"
checksum = "toyota"
[detections.signals]
longitudinal = { signal = "LONG_DIST" }
lateral = { signal = "LAT_DIST", factor = -1 }
range_rate = { signal = "REL_SPEED" }
existence = { signal = "SCORE", unit = "%" }
[[detections.valid]]
signal = "VALID"
is = [1]
)";

constexpr std::string_view kEgoMapping = R"(kind = "ego"
dbc = "DBC"
[speed]
message = "VSC1F01"
signals = ["VXRR", "VXRL"]
[yaw_rate]
message = "YGS1S03"
checksum = "toyota"
signals = ["YR"]
[steering_angle]
message = "STR1S01"
checksum = "toyota"
signals = ["SSA", "SSAS"]
combine = "sum"
)";

/// A mapping in a temporary folder.
class MappingFile {
 public:
  MappingFile(std::string_view text, const fs::path& dbc) {
    folder_ = fs::path(testing::TempDir()) / ("boresight_mapping_" + std::to_string(::getpid()) + dbc.stem().string());
    fs::create_directories(folder_);
    std::string filled(text);
    filled.replace(filled.find("DBC\""), 3, dbc.string());
    std::ofstream(path()) << filled;
  }
  ~MappingFile() { fs::remove_all(folder_); }
  MappingFile(const MappingFile&) = delete;
  MappingFile& operator=(const MappingFile&) = delete;
  [[nodiscard]] fs::path path() const { return folder_ / "mapping.toml"; }

 private:
  fs::path folder_;
};

/// Every product of a decoder, in order.
struct Products : ingest::DecoderOutput {
  struct Ego {
    ingest::EgoReading reading;
    std::int64_t stamp_ns;
  };
  RadarScan* begin_scan() override {
    scans.push_back(std::make_unique<RadarScan>());
    return scans.back().get();
  }
  void publish_scan(const ingest::FrameStamp& reception, const std::optional<ingest::SensorStamp>&,
                    unsigned counter_bits) override {
    scans.back()->header.measurement_time_ns = reception.received_ns;
    bits.push_back(counter_bits);
  }
  void discard_scan() override { scans.pop_back(); }
  void report_conditions(std::uint32_t) override {}
  void take_ego(const ingest::EgoReading& reading, const ingest::FrameStamp& reception) override {
    egos.push_back({reading, reception.received_ns});
  }
  void fault(Fault, std::string_view what) override { faults.emplace_back(what); }

  std::vector<std::unique_ptr<RadarScan>> scans;
  std::vector<unsigned> bits;
  std::vector<Ego> egos;
  std::vector<std::string> faults;
};

/// Feeds a recording without every `drop_each`-th frame (0: all frames).
void play(ingest::Decoder& decoder, Products& products, std::size_t drop_each = 0) {
  const auto reader =
      recording::open_recording(kMappingRecording, [](const std::string& problem) { FAIL() << problem; });
  recording::Frame frame;
  for (std::size_t i = 1; reader->next(frame); ++i) {
    if (drop_each != 0 && i % drop_each == 0) continue;
    decoder.tick(frame.stamp_ns, products);
    decoder.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival}, products);
  }
}

void expect_same_scan(const RadarScan& a, const RadarScan& b) {
  ASSERT_EQ(a.number_of_valid_detections, b.number_of_valid_detections);
  EXPECT_EQ(a.header.measurement_time_ns, b.header.measurement_time_ns);
  EXPECT_EQ(a.cycle_counter, b.cycle_counter);
  EXPECT_EQ(a.integrity, b.integrity);
  EXPECT_EQ(a.fields, b.fields);
  EXPECT_EQ(a.dropped_detections, b.dropped_detections);
  const auto same = [&](const auto& x, const auto& y) {
    return std::equal(x.data(), x.data() + a.number_of_valid_detections, y.data());
  };
  EXPECT_TRUE(same(a.range_m, b.range_m));
  EXPECT_TRUE(same(a.azimuth_rad, b.azimuth_rad));
  EXPECT_TRUE(same(a.elevation_rad, b.elevation_rad));
  EXPECT_TRUE(same(a.range_rate_mps, b.range_rate_mps));
  EXPECT_TRUE(same(a.existence_probability, b.existence_probability));
  EXPECT_TRUE(same(a.detection_flags, b.detection_flags));
}

TEST(PublicDbcFiles, AllAreReadWithoutAProblem) {
  REQUIRE_RECORDING(kDbcFolder);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(kDbcFolder)) {
    if (entry.path().extension() != ".dbc") continue;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const ingest::dbc::Database database = ingest::dbc::parse_dbc(text, entry.path().filename().string());
    EXPECT_THAT(database.problems, testing::IsEmpty());
    EXPECT_GT(database.messages.size(), 5u) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 6u);
}

class ToyotaByMapping : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    REQUIRE_RECORDING(kMappingRecording);
    REQUIRE_RECORDING(kDbcFolder);
  }
};

// Complete, and with frames missing: every detection is equal.
TEST_P(ToyotaByMapping, RadarScansAreThoseOfTheCodecByHand) {
  const MappingFile file(kRadarMapping, kDbcFolder / "toyota_adas.dbc");
  ingest::TableRadar by_table(ingest::read_radar_mapping(file.path()));
  ingest::ToyotaRadar by_hand;
  Products table, hand;
  play(by_table, table, GetParam());
  play(by_hand, hand, GetParam());
  ASSERT_EQ(table.scans.size(), hand.scans.size());
  EXPECT_GE(hand.scans.size(), 1200u);
  EXPECT_EQ(table.faults.size(), hand.faults.size());
  EXPECT_EQ(table.bits, hand.bits);
  std::size_t detections = 0;
  for (std::size_t i = 0; i < hand.scans.size(); ++i) {
    expect_same_scan(*table.scans[i], *hand.scans[i]);
    ASSERT_FALSE(HasFailure()) << "scan " << i;
    detections += hand.scans[i]->number_of_valid_detections;
  }
  if (GetParam() == 0) {
    EXPECT_EQ(detections, 10'100u);
    EXPECT_THAT(table.faults, testing::IsEmpty());
  }
}

INSTANTIATE_TEST_SUITE_P(DropEach, ToyotaByMapping, testing::Values(0, 97, 1000));

/// Takes products without keeping them.
struct Drain : ingest::DecoderOutput {
  RadarScan* begin_scan() override { return &scan; }
  void publish_scan(const ingest::FrameStamp&, const std::optional<ingest::SensorStamp>&, unsigned) override {}
  void discard_scan() override {}
  void report_conditions(std::uint32_t) override {}
  void take_ego(const ingest::EgoReading&, const ingest::FrameStamp&) override {}
  void fault(Fault, std::string_view) override {}
  RadarScan scan{};
};

TEST(Mapped, NothingIsAllocatedForAFrame) {
  REQUIRE_RECORDING(kMappingRecording);
  REQUIRE_RECORDING(kDbcFolder);
  std::vector<recording::Frame> frames;
  std::vector<std::array<std::uint8_t, 8>> payloads;
  const auto reader =
      recording::open_recording(kMappingRecording, [](const std::string& problem) { FAIL() << problem; });
  for (recording::Frame frame; reader->next(frame);) {
    auto& payload = payloads.emplace_back();
    std::copy(frame.payload.begin(), frame.payload.end(), payload.begin());
    frames.push_back(frame);
  }
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].payload = {payloads[i].data(), frames[i].payload.size()};
  const MappingFile radar_file(kRadarMapping, kDbcFolder / "toyota_adas.dbc");
  const MappingFile ego_file(kEgoMapping, kDbcFolder / "toyota_2017_ref_pt.dbc");
  ingest::TableRadar radar(ingest::read_radar_mapping(radar_file.path()));
  ingest::TableEgo ego(ingest::read_ego_mapping(ego_file.path()));
  const auto drain = std::make_unique<Drain>();
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations count;
    for (const recording::Frame& frame : frames) {
      const ingest::FrameStamp stamp{frame.stamp_ns, 0, TimeSource::kLinkArrival};
      radar.take(frame, stamp, *drain);
      ego.take(frame, stamp, *drain);
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST(ToyotaEgoByMapping, ReadingsMakeTheEgoMotionOfTheCodecByHand) {
  REQUIRE_RECORDING(kMappingRecording);
  REQUIRE_RECORDING(kDbcFolder);
  const MappingFile file(kEgoMapping, kDbcFolder / "toyota_2017_ref_pt.dbc");
  ingest::TableEgo by_table(ingest::read_ego_mapping(file.path()));
  Products table;
  play(by_table, table);
  EXPECT_THAT(table.faults, testing::IsEmpty());
  // The hand-written codec publishes each speed with the last value of the other signals.
  const Decoding hand = decode(vehicle("comma2k19"), kMappingRecording);
  auto expected = hand.messages.begin();
  std::size_t compared = 0;
  double yaw_rate = 0.0, steering_angle = 0.0;
  for (const Products::Ego& ego : table.egos) {
    yaw_rate = ego.reading.yaw_rate_radps.value_or(yaw_rate);
    steering_angle = ego.reading.steering_angle_rad.value_or(steering_angle);
    if (!ego.reading.speed_mps) continue;
    while (expected != hand.messages.end() && !expected->ego) ++expected;
    ASSERT_NE(expected, hand.messages.end());
    const EgoMotion& motion = *expected++->ego;
    ASSERT_EQ(motion.header.measurement_time_ns, ego.stamp_ns);
    ASSERT_NEAR(motion.speed_mps, *ego.reading.speed_mps, 1e-5);
    if (motion.has(ego_field::kYawRate)) {
      ASSERT_NEAR(motion.yaw_rate_radps, yaw_rate, 1e-6);
    }
    if (motion.has(ego_field::kSteeringAngle)) {
      ASSERT_NEAR(motion.steering_angle_rad, steering_angle, 1e-6);
    }
    EXPECT_FALSE(ego.reading.speed_is_signed);
    ++compared;
  }
  EXPECT_EQ(compared, 4974u);
}

}  // namespace
}  // namespace boresight::golden
