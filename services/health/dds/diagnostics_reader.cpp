#include "services/health/dds/diagnostics_reader.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"

namespace boresight::dds {

namespace {
constexpr int kReadLatestOfEachRadar = 1;
constexpr int kReadArrays = 10;
}  // namespace

template <typename Sample>
void DiagnosticsReader::Listener<Sample>::on_data_available(eprosima::fastdds::dds::DataReader* reader) {
  eprosima::fastdds::dds::SampleInfo info;
  while (reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
    if (info.valid_data) callback_(sample_);
  }
}

DiagnosticsReader::DiagnosticsReader(const Config& config, OnSensorHealth on_sensor_health,
                                     OnDiagnosticArray on_diagnostic_array)
    : sensor_health_(on_sensor_health), diagnostic_array_(on_diagnostic_array), participant_(config, "boresight") {
  using eprosima::fastdds::dds::TypeSupport;
  if (on_sensor_health) {
    participant_.reader(kSensorHealthTopic, TypeSupport(new diagnostics::SensorHealthPubSubType()),
                        kReadLatestOfEachRadar, sensor_health_);
  }
  if (on_diagnostic_array) {
    participant_.reader(kDiagnosticsTopic, TypeSupport(new diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType()),
                        kReadArrays, diagnostic_array_);
  }
}

}  // namespace boresight::dds
