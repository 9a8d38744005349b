// The topics off the ECU as documentation: what a reader of each must know.
#pragma once

#include <array>
#include <string>

#include "services/health/dds/topics.hpp"

namespace boresight::dds {

struct TopicDescription {
  const TopicQos* qos;
  const char* type;  ///< as in the IDL, and as the middleware registers it
  const char* idl;   ///< file in interfaces/idl
  const char* key;   ///< field that distinguishes the instances; "": one instance
};

inline constexpr std::array<TopicDescription, kTopics.size()> kTopicDescriptions = {{
    {&kSensorHealthTopic, "boresight::diagnostics::SensorHealth", "sensor_health.idl", "radar_id"},
    {&kSystemHealthTopic, "boresight::diagnostics::SystemHealth", "system_health.idl", "vehicle_name"},
    {&kTrackListTopic, "boresight::perception::TrackList", "track_list.idl", "vehicle_name"},
    {&kAlignmentTopic, "boresight::diagnostics::AlignmentEstimate", "alignment_estimate.idl", "radar_id"},
    {&kServiceStatusTopic, "boresight::diagnostics::ServiceStatus", "service_status.idl", "service_name"},
    {&kDiagnosticsTopic, "diagnostic_msgs::msg::dds_::DiagnosticArray_", "diagnostic_array.idl", ""},
    {&kFaultRecordTopic, "boresight::diagnostics::FaultRecord", "fault_memory.idl", "dtc"},
    {&kFaultMemoryStateTopic, "boresight::diagnostics::FaultMemoryState", "fault_memory.idl", ""},
    {&kCommandTopic, "boresight::diagnostics::ClearCommand", "fault_memory.idl", ""},
    {&kCommandReplyTopic, "boresight::diagnostics::CommandReply", "fault_memory.idl", ""},
}};

/// A Markdown table with a row for each topic. P stands for `dds.period_s`.
[[nodiscard]] std::string topics_as_markdown();

}  // namespace boresight::dds
