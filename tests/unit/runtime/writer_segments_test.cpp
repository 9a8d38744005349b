// Whose memory a message lies in: by addresses, as in /proc/self/maps.
#include "services/common/runtime/writer_segments.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boresight::runtime {
namespace {

using catalogue::Service;
using catalogue::topic;
using catalogue::TopicId;

/// Stands for the segments of three services. Each has room for one message of any topic.
class WriterSegmentsTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kSegment_bytes = 100'000;

  std::vector<char> gateway_ = std::vector<char>(kSegment_bytes);
  std::vector<char> tracker_ = std::vector<char>(kSegment_bytes);
  std::vector<char> elsewhere_ = std::vector<char>(kSegment_bytes);

  static std::string line(const std::vector<char>& memory, const std::string& path) {
    char addresses[64];
    const auto begin = reinterpret_cast<std::uintptr_t>(memory.data());
    std::snprintf(addresses, sizeof(addresses), "%lx-%lx", begin, begin + memory.size());
    return std::string(addresses) + " r--s 00000000 00:19 7                          " + path + "\n";
  }
  /// A header at the begin of the memory, with this source.
  static MessageHeader& header_in(std::vector<char>& memory, std::uint32_t source = 1) {
    auto& header = *new (memory.data()) MessageHeader{};
    header.source_id = source;
    return header;
  }

  const std::string maps_ = "55d0c0000000-55d0c0001000 r-xp 00000000 08:01 4 /usr/lib/boresight/boresight-tracker\n" +
                            line(gateway_, "/dev/shm/boresight-ingest_gateway") +
                            line(tracker_, "/dev/shm/boresight-tracker") + line(elsewhere_, "/dev/shm/iceoryx_mgmt") +
                            "7ffd4e5f2000-7ffd4e613000 rw-p 00000000 00:00 0 [stack]\n";
  const WriterSegments segments_{maps_};
};

TEST_F(WriterSegmentsTest, MessageInTheMemoryOfTheTopicsWriterIsAccepted) {
  EXPECT_TRUE(segments_.accept(topic(TopicId::kRadarScan), header_in(gateway_)));
  EXPECT_TRUE(segments_.accept(topic(TopicId::kTrackList), header_in(tracker_)));
}

TEST_F(WriterSegmentsTest, MessageInTheMemoryOfAnotherServiceIsRefused) {
  EXPECT_FALSE(segments_.accept(topic(TopicId::kRadarScan), header_in(tracker_)));
  EXPECT_FALSE(segments_.accept(topic(TopicId::kTrackList), header_in(gateway_)));
}

TEST_F(WriterSegmentsTest, MessageInTheManagementMemoryIsRefused) {
  EXPECT_FALSE(segments_.accept(topic(TopicId::kRadarScan), header_in(elsewhere_)));
}

TEST_F(WriterSegmentsTest, MessageOutsideAllSegmentsIsRefusedWithoutReadingIt) {
  const auto* const nowhere = reinterpret_cast<const MessageHeader*>(std::uintptr_t{4096});
  EXPECT_FALSE(segments_.accept(topic(TopicId::kServiceStatus), *nowhere));
}

TEST_F(WriterSegmentsTest, MessageThatReachesBeyondTheSegmentIsRefused) {
  const std::size_t size = topic(TopicId::kRadarScan).payload_bytes;
  const char* const last = gateway_.data() + kSegment_bytes - size;
  EXPECT_TRUE(segments_.contains(Service::kIngestGateway, last, size));
  EXPECT_FALSE(segments_.contains(Service::kIngestGateway, last + 1, size));
  EXPECT_FALSE(segments_.contains(Service::kIngestGateway, gateway_.data() - 1, size));
}

TEST_F(WriterSegmentsTest, HeartbeatIsAcceptedOnlyInTheNameOfTheServiceThatWroteIt) {
  const auto source = [](Service service) { return static_cast<std::uint32_t>(service); };
  const catalogue::Topic& status = topic(TopicId::kServiceStatus);
  EXPECT_TRUE(segments_.accept(status, header_in(tracker_, source(Service::kTracker))));
  EXPECT_FALSE(segments_.accept(status, header_in(tracker_, source(Service::kIngestGateway))));
}

TEST_F(WriterSegmentsTest, WriterWithoutAMappedSegmentIsNotBelieved) {
  EXPECT_FALSE(segments_.accept(topic(TopicId::kHealthReport), header_in(tracker_)));
}

TEST_F(WriterSegmentsTest, OneSegmentForAllServicesIsNotChecked) {
  const WriterSegments one(line(gateway_, "/dev/shm/root") + line(tracker_, "/dev/shm/iceoryx_mgmt"));
  EXPECT_TRUE(one.accept(topic(TopicId::kTrackList), header_in(gateway_)));
  EXPECT_TRUE(WriterSegments("").accept(topic(TopicId::kTrackList), header_in(gateway_)));
}

TEST_F(WriterSegmentsTest, DamagedLinesAreIgnored) {
  for (const char* text : {"x", "-", "12", "12-", "12-34", "zz-34 r--s /dev/shm/boresight-tracker", "\n\n",
                           "12-34 r--s 0 0 0 /dev/shm/boresight-tracker_2"}) {
    EXPECT_TRUE(WriterSegments(text).accept(topic(TopicId::kTrackList), header_in(gateway_))) << text;
  }
}

}  // namespace
}  // namespace boresight::runtime
