// dds_stranger DOMAIN RADAR SECONDS: a stranger on the diagnosis domain. Its first line of output is the GUID of its
// writer. Then it asserts fifty times a second that RADAR is AVAILABLE, with names that contain control characters,
// enumerators that do not exist, and strings of a few kilobytes.
#include <cstdlib>
#include <iostream>
#include <string>

#include <unistd.h>

#include "generated/sensor_healthPubSubTypes.h"
#include "tests/faults/observers/dds_participant.hpp"

namespace boresight::faults {
namespace {

constexpr unsigned kPeriod_us = 20'000;
constexpr int kMicrosecondsPerSecond = 1'000'000;

diagnostics::SensorHealth sample(std::uint32_t radar, int number) {
  constexpr std::size_t kLongText = 4096;
  constexpr int kNoEnumerator = 77;
  diagnostics::SensorHealth false_health;
  false_health.radar_id(radar);
  false_health.vehicle_name("demo");
  false_health.radar_name("front\x1b[2J\n\r\tright");
  false_health.data_qualifier(diagnostics::AVAILABLE);
  false_health.extended_qualifier(diagnostics::NORMAL);
  switch (number % 4) {
    case 1:
      false_health.explanation(std::string(kLongText, '\x07'));
      break;
    case 2:
      false_health.extended_qualifier(static_cast<diagnostics::ExtendedQualifier>(kNoEnumerator));
      break;
    case 3:
      false_health.radar_id(radar + static_cast<std::uint32_t>(number));
      break;  // radars that do not exist
    default:
      break;
  }
  return false_health;
}

int publish(std::uint32_t domain, std::uint32_t radar, double seconds) {
  Participant participant(domain, "stranger");
  auto& writer = participant.writer(kSensorHealthTopic,
                                    eprosima::fastdds::dds::TypeSupport(new diagnostics::SensorHealthPubSubType()));
  std::cout << writer.guid() << std::endl;
  const int samples = static_cast<int>(seconds * kMicrosecondsPerSecond / kPeriod_us);
  for (int number = 0; number < samples; ++number) {
    diagnostics::SensorHealth false_health = sample(radar, number);
    writer.write(&false_health);
    usleep(kPeriod_us);
  }
  return 0;
}

}  // namespace
}  // namespace boresight::faults

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "dds_stranger DOMAIN RADAR SECONDS\n";
    return 2;
  }
  return boresight::faults::publish(static_cast<std::uint32_t>(std::atoi(argv[1])),
                                    static_cast<std::uint32_t>(std::atoi(argv[2])), std::atof(argv[3]));
}
