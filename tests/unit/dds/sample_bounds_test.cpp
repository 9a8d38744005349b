#include "services/health/dds/sample_bounds.hpp"

#include <vector>

#include <fastdds/rtps/common/SerializedPayload.h>
#include <gtest/gtest.h>

#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"

namespace boresight::dds {
namespace {

using diagnostic_msgs::msg::dds_::DiagnosticArray_;
using diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType;
using eprosima::fastrtps::rtps::SerializedPayload_t;

constexpr std::uint32_t kMostBytes = kDiagnosticsTopic.most_bytes;
constexpr std::size_t kLengthOfStatuses = 16;  // header, stamp, an empty frame_id with its end and padding

DiagnosticArray_ array_of(std::size_t statuses, std::size_t values) {
  DiagnosticArray_ array;
  for (std::size_t i = 0; i < statuses; ++i) {
    diagnostic_msgs::msg::dds_::DiagnosticStatus_ status;
    status.name_("a name");
    for (std::size_t k = 0; k < values; ++k) status.values_().emplace_back();
    array.status_().push_back(status);
  }
  return array;
}

std::vector<std::uint8_t> bytes_of(DiagnosticArray_ array) {
  DiagnosticArray_PubSubType type;
  SerializedPayload_t payload(type.getSerializedSizeProvider(&array)());
  EXPECT_TRUE(type.serialize(&array, &payload));
  return {payload.data, payload.data + payload.length};
}

/// What a reader of ours makes of it.
bool is_accepted(const std::vector<std::uint8_t>& bytes, DiagnosticArray_& array) {
  GuardedType<DiagnosticArray_PubSubType> type(kMostBytes);
  SerializedPayload_t payload(static_cast<std::uint32_t>(bytes.size()));
  std::copy(bytes.begin(), bytes.end(), payload.data);
  payload.length = static_cast<std::uint32_t>(bytes.size());
  return type.deserialize(&payload, &array);
}

TEST(SampleBounds, ArraysAsRosWritesThemAreAccepted) {
  for (const std::size_t statuses : {0u, 1u, 25u}) {
    for (const std::size_t values : {0u, 1u, 30u}) {
      DiagnosticArray_ read;
      ASSERT_TRUE(is_accepted(bytes_of(array_of(statuses, values)), read)) << statuses << " of " << values;
      EXPECT_EQ(read.status_().size(), statuses);
    }
  }
}

TEST(SampleBounds, AnAnnouncedLengthWithoutItsElementsTakesNoMemory) {
  std::vector<std::uint8_t> bytes = bytes_of(array_of(1, 0));
  bytes.resize(kMostBytes - 4);
  // As many statuses as bytes follow: the generated code would take 130 bytes for each of them.
  const auto announced = static_cast<std::uint32_t>(bytes.size() - kLengthOfStatuses - 8);
  for (std::size_t i = 0; i < 4; ++i) bytes[4 + kLengthOfStatuses - 4 + i] = 0;
  for (std::size_t at = 4; at + 4 <= 32; at += 4) {
    std::vector<std::uint8_t> hostile = bytes;
    for (std::size_t i = 0; i < 4; ++i) hostile[at + i] = static_cast<std::uint8_t>(announced >> 8U * i);
    DiagnosticArray_ read;
    static_cast<void>(is_accepted(hostile, read));
    EXPECT_LT(read.status_().capacity(), kMostBytes / 16) << at;
  }
}

TEST(SampleBounds, ALargerSampleIsRefused) {
  DiagnosticArray_ array;
  array.header_().frame_id_(std::string(kMostBytes, 'x'));
  DiagnosticArray_ read;
  EXPECT_FALSE(is_accepted(bytes_of(array), read));
}

TEST(SampleBounds, EveryCutOfAnArrayIsRefused) {
  const std::vector<std::uint8_t> whole = bytes_of(array_of(2, 2));
  for (std::size_t size = 0; size + 8 < whole.size(); ++size) {
    DiagnosticArray_ read;
    EXPECT_FALSE(is_accepted({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, read)) << size;
  }
}

}  // namespace
}  // namespace boresight::dds
