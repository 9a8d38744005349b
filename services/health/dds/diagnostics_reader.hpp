// Reader of a diagnosis tool: delivers samples of the topics to callbacks.
#pragma once

#include <functional>
#include <memory>

#include "generated/diagnostic_array.h"
#include "generated/sensor_health.h"
#include "generated/system_health.h"
#include "services/health/dds/config.hpp"

namespace boresight::dds {

/// Callbacks run in the middleware's thread, one at a time for each topic. A topic with an empty callback is not read.
class DiagnosticsReader {
 public:
  using OnSensorHealth = std::function<void(const diagnostics::SensorHealth&)>;
  using OnSystemHealth = std::function<void(const diagnostics::SystemHealth&)>;
  using OnDiagnosticArray = std::function<void(const diagnostic_msgs::msg::dds_::DiagnosticArray_&)>;
  /// Joins the domain; throws std::runtime_error if that is impossible.
  DiagnosticsReader(const Config& config, OnSensorHealth on_sensor_health, OnDiagnosticArray on_diagnostic_array,
                    OnSystemHealth on_system_health = {});

  ~DiagnosticsReader();

 private:
  class Readers;

  std::unique_ptr<Readers> readers_;
};

}  // namespace boresight::dds
