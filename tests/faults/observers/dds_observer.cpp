// dds_observer DOMAIN: prints every sample of sensor_health and system_health with its writer's GUID, one JSON object a
// line, for the fault campaign. Strings of samples are not printed: a stranger may have written them.
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include "generated/sensor_healthPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "tests/faults/observers/dds_participant.hpp"

namespace boresight::faults {
namespace {

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

std::string fields_of(const diagnostics::SensorHealth& sample) {
  return fmt::format(R"("topic":"dds_sensor","radar":{},"verdict":{},"reason":{})", sample.radar_id(),
                     static_cast<int>(sample.data_qualifier()), static_cast<int>(sample.extended_qualifier()));
}

std::string fields_of(const diagnostics::SystemHealth& sample) {
  return fmt::format(R"("topic":"dds_system","overall":{},"pipeline":{})", static_cast<int>(sample.overall()),
                     static_cast<int>(sample.pipeline().data_qualifier()));
}

/// A sample that the generated code cannot read is dropped, as in any tool that is to survive.
template <typename Generated>
class Guarded : public Generated {
 public:
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      return Generated::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;
    }
  }
};

template <typename Sample>
class Printer : public eprosima::fastdds::dds::DataReaderListener {
 public:
  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    Sample sample;
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&sample, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      std::ostringstream writer;
      writer << info.sample_identity.writer_guid();
      const std::string line =
          fmt::format("{{\"at_ns\":{},{},\"writer\":\"{}\"}}\n", now_ns(), fields_of(sample), writer.str());
      static_cast<void>(write(STDOUT_FILENO, line.data(), line.size()));
    }
  }
};

int observe(std::uint32_t domain) {
  Printer<diagnostics::SensorHealth> sensors;
  Printer<diagnostics::SystemHealth> systems;
  Participant participant(domain, "fault observer");
  participant.reader(kSensorHealthTopic,
                     eprosima::fastdds::dds::TypeSupport(new Guarded<diagnostics::SensorHealthPubSubType>()), sensors);
  participant.reader(kSystemHealthTopic,
                     eprosima::fastdds::dds::TypeSupport(new Guarded<diagnostics::SystemHealthPubSubType>()), systems);
  for (;;) pause();  // until a signal ends the process
}

}  // namespace
}  // namespace boresight::faults

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "dds_observer DOMAIN\n";
    return 2;
  }
  return boresight::faults::observe(static_cast<std::uint32_t>(std::atoi(argv[1])));
}
