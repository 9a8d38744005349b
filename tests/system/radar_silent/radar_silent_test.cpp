// One of four radars is silent for two seconds: health reports NOT_AVAILABLE within the radar's deadline, the other
// three continue, and the radar is available again with its first scan.
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

#include "tests/system/harness/domain.hpp"
#include "tests/system/harness/observer.hpp"

namespace boresight {
namespace {

using catalogue::TopicId;
using harness::Observer;
using harness::Sample;

constexpr std::uint32_t kSilentRadar = 3;
constexpr std::uint8_t kLastByteOfItsAddress = 115;
constexpr double kDeadline_s = 0.25;  // of config/vehicle/demo.toml
constexpr double kSilence_s = 2.0;

std::uint32_t word_at(const std::vector<char>& bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

/// A copy of an Ethernet capture without the packets of one sender between two seconds of the recording.
std::filesystem::path without_sender(const std::filesystem::path& capture, std::uint8_t last_byte, double from_s,
                                     double to_s) {
  constexpr std::size_t kFileHeader = 24, kPacketHeader = 16, kSourceAddressEnd = 14 + 15;
  std::ifstream input(capture, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(input), {}};
  constexpr std::uint32_t kNanosecondMagic = 0xa1b23c4d;
  const double fraction_s = word_at(bytes, 0) == kNanosecondMagic ? 1e-9 : 1e-6;
  const std::filesystem::path result = capture.parent_path() / "silent.pcap";
  std::ofstream output(result, std::ios::binary);
  output.write(bytes.data(), kFileHeader);
  double begin_s = -1.0;
  for (std::size_t at = kFileHeader; at + kPacketHeader <= bytes.size();) {
    const double t_s = word_at(bytes, at) + fraction_s * word_at(bytes, at + 4);
    if (begin_s < 0.0) begin_s = t_s;
    const std::size_t length = kPacketHeader + word_at(bytes, at + 8);
    const auto sender = static_cast<std::uint8_t>(bytes[at + kPacketHeader + kSourceAddressEnd]);
    const bool dropped = sender == last_byte && t_s - begin_s >= from_s && t_s - begin_s < to_s;
    if (!dropped) output.write(bytes.data() + at, static_cast<std::streamsize>(length));
    at += length;
  }
  return result;
}

TEST(RadarSilent, IsNotAvailableWithinItsDeadlineAndBackSoonAfterItsNextScan) {
  auto recordings = harness::simulated_drive(8.0);
  recordings[0] = without_sender(recordings[0], kLastByteOfItsAddress, 4.0, 4.0 + kSilence_s);
  Observer observer("-silent");
  harness::Domain domain("demo");
  domain.start();
  ASSERT_TRUE(domain.until(5.0, [&] { return observer.is_attached(); }));
  domain.replay(recordings);
  ASSERT_TRUE(domain.until(20.0, [&] { return domain.replay_has_ended(); }));
  EXPECT_EQ(observer.process().stop(), 0);

  std::vector<const Sample*> scans;
  for (const Sample* scan : observer.of(TopicId::kRadarScan)) {
    if (scan->header.source_id == kSilentRadar) scans.push_back(scan);
  }
  ASSERT_GT(scans.size(), 60u);
  // The longest time between two scans is the silence.
  const auto gap = std::adjacent_find(scans.begin(), scans.end(), [](const Sample* a, const Sample* b) {
    return b->received_ns - a->received_ns > 1'500'000'000;
  });
  ASSERT_NE(gap, scans.end()) << "the recording was not silent";
  const std::int64_t last_ns = gap[0]->received_ns, back_ns = gap[1]->received_ns;
  std::int64_t reported_ns = 0, cleared_ns = 0;
  for (const Sample* report : observer.of(TopicId::kHealthReport)) {
    const bool not_available = report->sensor[kSilentRadar] == static_cast<std::uint32_t>(DataQualifier::kNotAvailable);
    if (report->received_ns <= last_ns) continue;
    if (not_available && reported_ns == 0) {
      reported_ns = report->received_ns;
      EXPECT_EQ(report->sensor_reason[kSilentRadar], static_cast<std::uint32_t>(ExtendedQualifier::kNoData));
    }
    if (!not_available && reported_ns != 0 && cleared_ns == 0) cleared_ns = report->received_ns;
    if (report->received_ns < back_ns) {
      for (const std::uint32_t other : {1u, 2u, 4u}) {
        EXPECT_NE(report->sensor[other], static_cast<std::uint32_t>(DataQualifier::kNotAvailable)) << other;
      }
    }
  }
  ASSERT_NE(reported_ns, 0) << "health did not report it";
  const double after_s = static_cast<double>(reported_ns - last_ns) * 1e-9;
  // Health checks every 20 ms; the rest is a tolerance for a loaded machine.
  EXPECT_GE(after_s, kDeadline_s - 0.01);
  EXPECT_LE(after_s, kDeadline_s + 0.02 + 0.08);
  ASSERT_NE(cleared_ns, 0) << "it did not become available again";
  EXPECT_GE(cleared_ns, back_ns - 10'000'000);
  // Debounced by debounce.no_data.clear_s of health.toml.
  EXPECT_LE(static_cast<double>(cleared_ns - back_ns) * 1e-9, 1.3);
  std::printf("NOT_AVAILABLE %.3f s after the last scan (deadline %.2f s), back %.3f s after the next one\n", after_s,
              kDeadline_s, static_cast<double>(cleared_ns - back_ns) * 1e-9);

  std::size_t lists = 0;
  for (const Sample* list : observer.of(TopicId::kTrackList)) {
    if (list->received_ns > last_ns && list->received_ns < back_ns) ++lists;
  }
  EXPECT_GE(lists, 100u) << "three radars of 20 Hz for two seconds";
}

}  // namespace
}  // namespace boresight
