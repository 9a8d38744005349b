// Reader of a diagnosis tool: delivers samples of both topics to callbacks.
#pragma once

#include <functional>

#include <fastdds/dds/subscriber/DataReaderListener.hpp>

#include "generated/diagnostic_array.h"
#include "generated/sensor_health.h"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

/// Callbacks run in the middleware's thread, one at a time for each topic. A topic with an empty callback is not read.
class DiagnosticsReader {
 public:
  using OnSensorHealth = std::function<void(const diagnostics::SensorHealth&)>;
  using OnDiagnosticArray = std::function<void(const diagnostic_msgs::msg::dds_::DiagnosticArray_&)>;
  /// Joins the domain; throws std::runtime_error if that is impossible.
  DiagnosticsReader(const Config& config, OnSensorHealth on_sensor_health, OnDiagnosticArray on_diagnostic_array);

 private:
  template <typename Sample>
  class Listener : public eprosima::fastdds::dds::DataReaderListener {
   public:
    explicit Listener(std::function<void(const Sample&)> callback) : callback_(std::move(callback)) {}
    void on_data_available(eprosima::fastdds::dds::DataReader* reader) override;

   private:
    std::function<void(const Sample&)> callback_;
    Sample sample_;
  };

  Listener<diagnostics::SensorHealth> sensor_health_;
  Listener<diagnostic_msgs::msg::dds_::DiagnosticArray_> diagnostic_array_;
  Participant participant_;  // last member: its destructor stops the listeners first
};

}  // namespace boresight::dds
