// Reader of a diagnosis tool: delivers samples of the topics, and their absence, to callbacks.
#pragma once

#include <functional>
#include <memory>

#include "generated/diagnostic_array.h"
#include "generated/sensor_health.h"
#include "generated/system_health.h"
#include "services/health/dds/config.hpp"
#include "services/health/dds/presence.hpp"

namespace boresight::dds {

/// What a tool wants to know. Callbacks run in the middleware's threads, one at a time for each topic. A topic with an
/// empty callback is not read.
struct DiagnosticsCallbacks {
  std::function<void(const diagnostics::SensorHealth&)> on_sensor_health;
  std::function<void(const diagnostics::SystemHealth&)> on_system_health;
  std::function<void(const diagnostic_msgs::msg::dds_::DiagnosticArray_&)> on_diagnostic_array;
  /// A source of a topic above became silent, ended, or is received again.
  std::function<void(const Presence&)> on_presence;
};

class DiagnosticsReader {
 public:
  /// Joins the domain; throws std::runtime_error if that is impossible.
  DiagnosticsReader(const Config& config, DiagnosticsCallbacks callbacks);
  ~DiagnosticsReader();

 private:
  class Readers;
  std::unique_ptr<Readers> readers_;
};

}  // namespace boresight::dds
