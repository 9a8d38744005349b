#include "services/health/dds/diagnostics_reader.hpp"

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

namespace {

template <typename Sample>
class Listener : public eprosima::fastdds::dds::DataReaderListener {
 public:
  explicit Listener(std::function<void(const Sample&)> callback) : callback_(std::move(callback)) {}

  void on_data_available(eprosima::fastdds::dds::DataReader* reader) override {
    eprosima::fastdds::dds::SampleInfo info;
    while (reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) callback_(sample_);
    }
  }

 private:
  std::function<void(const Sample&)> callback_;
  Sample sample_;
};

}  // namespace

class DiagnosticsReader::Readers {
 public:
  Readers(const Config& config, OnSensorHealth on_sensor_health, OnDiagnosticArray on_diagnostic_array,
          OnSystemHealth on_system_health)
      : sensor_health_(on_sensor_health),
        system_health_(on_system_health),
        diagnostic_array_(on_diagnostic_array),
        participant_(config, "boresight") {
    if (on_sensor_health) {
      participant_.reader(kSensorHealthTopic, guarded<diagnostics::SensorHealthPubSubType>(), &sensor_health_);
    }
    if (on_system_health) {
      participant_.reader(kSystemHealthTopic, guarded<diagnostics::SystemHealthPubSubType>(), &system_health_);
    }
    if (on_diagnostic_array) {
      participant_.reader(kDiagnosticsTopic, guarded<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>(),
                          &diagnostic_array_);
    }
  }

 private:
  Listener<diagnostics::SensorHealth> sensor_health_;
  Listener<diagnostics::SystemHealth> system_health_;
  Listener<diagnostic_msgs::msg::dds_::DiagnosticArray_> diagnostic_array_;
  Participant participant_;  // last member: its destructor stops the listeners first
};

DiagnosticsReader::DiagnosticsReader(const Config& config, OnSensorHealth on_sensor_health,
                                     OnDiagnosticArray on_diagnostic_array, OnSystemHealth on_system_health)
    : readers_(std::make_unique<Readers>(config, std::move(on_sensor_health), std::move(on_diagnostic_array),
                                         std::move(on_system_health))) {}

DiagnosticsReader::~DiagnosticsReader() = default;

}  // namespace boresight::dds
