#include "services/health/dds/guarded_type.hpp"

#include <random>

#include <gtest/gtest.h>

#include "generated/fault_memoryPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "services/health/dds/topics.hpp"

namespace boresight::dds {
namespace {

using eprosima::fastrtps::rtps::SerializedPayload_t;

/// Damages samples at random places and reads them; returns how many were refused.
template <typename Generated, typename Sample>
int refused_of(const TopicQos& topic, const Sample& sample, int trials) {
  GuardedType<Generated> type(topic.most_bytes);
  Sample written = sample;
  SerializedPayload_t good(type.getSerializedSizeProvider(&written)());
  EXPECT_TRUE(type.serialize(&written, &good));
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < trials; ++i) {
    SerializedPayload_t payload(good.length);
    payload.copy(&good);
    payload.data[4 + random() % (payload.length - 4)] = static_cast<unsigned char>(random());
    Sample read;
    refused += type.deserialize(&payload, &read) ? 0 : 1;
  }
  return refused;
}

TEST(GuardedType, RefusesDamagedSamplesAndSurvivesThem) {
  diagnostics::SensorHealth sensor;
  sensor.radar_name("front_left");
  EXPECT_GT((refused_of<diagnostics::SensorHealthPubSubType>(kSensorHealthTopic, sensor, 3000)), 0);
  diagnostics::SystemHealth system;
  system.services("tracker:alive");
  EXPECT_GT((refused_of<diagnostics::SystemHealthPubSubType>(kSystemHealthTopic, system, 3000)), 0);
  EXPECT_GT((refused_of<diagnostics::FaultMemoryStatePubSubType>(kFaultMemoryStateTopic,
                                                                 diagnostics::FaultMemoryState(), 3000)),
            0);
}

}  // namespace
}  // namespace boresight::dds
