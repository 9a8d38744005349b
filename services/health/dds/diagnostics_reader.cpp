#include "services/health/dds/diagnostics_reader.hpp"

#include <chrono>
#include <mutex>
#include <utility>

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

namespace fast = eprosima::fastdds::dds;
using diagnostic_msgs::msg::dds_::DiagnosticArray_;
using Handle = eprosima::fastrtps::rtps::InstanceHandle_t;

std::string source_of(const diagnostics::SensorHealth& sensor) {
  return sensor.radar_name();
}
std::string vehicle_of(const diagnostics::SensorHealth& sensor) {
  return sensor.vehicle_name();
}
std::string source_of(const diagnostics::SystemHealth&) {
  return "system";
}
std::string vehicle_of(const diagnostics::SystemHealth& system) {
  return system.vehicle_name();
}
// Everybody on the network may write this topic, so it has one source.
std::string source_of(const DiagnosticArray_&) {
  return kDiagnosticsTopic.name;
}
std::string vehicle_of(const DiagnosticArray_&) {
  return {};
}

std::int64_t now_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Samples and states of one topic. The deadline is checked in another thread than the one that receives.
template <typename Sample>
class Listener : public fast::DataReaderListener {
 public:
  using OnSample = std::function<void(const Sample&)>;
  using OnPresence = std::function<void(const Presence&)>;
  Listener(const TopicQos& topic, OnSample on_sample, OnPresence on_presence)
      : on_sample_(std::move(on_sample)),
        on_presence_(std::move(on_presence)),
        watch_(topic.name, static_cast<std::size_t>(topic.most_instances)) {}

  [[nodiscard]] bool is_wanted() const { return static_cast<bool>(on_sample_); }

  void on_data_available(fast::DataReader* reader) override {
    const std::lock_guard lock(mutex_);
    fast::SampleInfo info;
    while (reader->take_next_sample(&sample_, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) {
        tell(watch_.received(info.instance_handle, source_of(sample_), vehicle_of(sample_), now_ns()));
        on_sample_(sample_);
      } else if (info.instance_state == fast::NOT_ALIVE_DISPOSED_INSTANCE_STATE) {
        tell(watch_.absent(info.instance_handle, Absence::kEnded, now_ns()));
      } else if (info.instance_state == fast::NOT_ALIVE_NO_WRITERS_INSTANCE_STATE) {
        tell(watch_.absent(info.instance_handle, Absence::kNoWriter, now_ns()));
      }
    }
  }

  void on_requested_deadline_missed(fast::DataReader*, const fast::RequestedDeadlineMissedStatus& status) override {
    const std::lock_guard lock(mutex_);
    tell(watch_.absent(status.last_instance_handle, Absence::kDeadline, now_ns()));
  }

  void on_liveliness_changed(fast::DataReader*, const fast::LivelinessChangedStatus& status) override {
    if (status.alive_count > 0 || status.not_alive_count_change <= 0) return;
    const std::lock_guard lock(mutex_);
    tell_all(watch_.all_absent(Absence::kLiveliness, now_ns()));
  }

  void on_subscription_matched(fast::DataReader*, const fast::SubscriptionMatchedStatus& status) override {
    if (status.current_count > 0 || status.current_count_change >= 0) return;
    const std::lock_guard lock(mutex_);
    tell_all(watch_.all_absent(Absence::kNoWriter, now_ns()));
  }

  void on_requested_incompatible_qos(fast::DataReader*, const fast::RequestedIncompatibleQosStatus&) override {
    const std::lock_guard lock(mutex_);
    tell(watch_.refused());
  }

 private:
  void tell(const std::optional<Presence>& change) {
    if (change && on_presence_) on_presence_(*change);
  }
  void tell_all(const std::vector<Presence>& changes) {
    for (const Presence& change : changes) tell(change);
  }

  OnSample on_sample_;
  OnPresence on_presence_;
  std::mutex mutex_;
  Sample sample_;
  PresenceWatch<Handle> watch_;
};

}  // namespace

class DiagnosticsReader::Readers {
 public:
  Readers(const Config& config, DiagnosticsCallbacks callbacks)
      : sensor_health_(kSensorHealthTopic, std::move(callbacks.on_sensor_health), callbacks.on_presence),
        system_health_(kSystemHealthTopic, std::move(callbacks.on_system_health), callbacks.on_presence),
        diagnostic_array_(kDiagnosticsTopic, std::move(callbacks.on_diagnostic_array), callbacks.on_presence),
        participant_(config, "boresight") {
    if (sensor_health_.is_wanted()) {
      participant_.reader(kSensorHealthTopic, guarded<diagnostics::SensorHealthPubSubType>(kSensorHealthTopic),
                          &sensor_health_);
    }
    if (system_health_.is_wanted()) {
      participant_.reader(kSystemHealthTopic, guarded<diagnostics::SystemHealthPubSubType>(kSystemHealthTopic),
                          &system_health_);
    }
    if (diagnostic_array_.is_wanted()) {
      participant_.reader(kDiagnosticsTopic,
                          guarded<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>(kDiagnosticsTopic),
                          &diagnostic_array_);
    }
  }

 private:
  Listener<diagnostics::SensorHealth> sensor_health_;
  Listener<diagnostics::SystemHealth> system_health_;
  Listener<DiagnosticArray_> diagnostic_array_;
  Participant participant_;  // last member: its destructor stops the listeners first
};

DiagnosticsReader::DiagnosticsReader(const Config& config, DiagnosticsCallbacks callbacks)
    : readers_(std::make_unique<Readers>(config, std::move(callbacks))) {}

DiagnosticsReader::~DiagnosticsReader() = default;

}  // namespace boresight::dds
