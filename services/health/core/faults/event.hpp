// Events: what the health service tests, and the diagnostic trouble code (DTC) of each (ISO 14229-1, ISO 15031-6).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interfaces/messages/health_report.hpp"

namespace boresight::health {

/// What an event is about; with its number (radar id, service index, 0 for the vehicle) it makes one event of a kind.
enum class Subject : std::uint8_t { kRadar, kService, kVehicle };

/// Kinds of events. Those of radars come first, in the order of RadarEvent.
enum class EventKind : std::uint8_t {
  kServiceSilent = kNumberOfRadarEvents,
  kServiceLate,
  kServiceLosing,
  kServiceDegraded,
  kServiceRestarted,
  kPipelineLosing,  // in the order of PipelineEvent
  kPipelineQueueing,
  kPipelineWorkBudget,
  kPipelineLate,
  kPipelineSilent,
  kLoadChange,
  kSpeedSignalChange,
  kDiagnosticsMute,
  kFaultMemoryLost,
  kFaultMemoryUnwritable,
  kLevelsLost,
};
inline constexpr std::size_t kNumberOfEventKinds = kNumberOfRadarEvents + 16;

[[nodiscard]] constexpr EventKind kind_of(RadarEvent event) {
  return static_cast<EventKind>(event);
}

[[nodiscard]] constexpr EventKind kind_of(PipelineEvent event) {
  return static_cast<EventKind>(static_cast<unsigned>(EventKind::kPipelineLosing) + static_cast<unsigned>(event));
}

/// One tested thing: a kind and its subject.
struct Event {
  EventKind kind;
  std::uint8_t subject = 0;  ///< radar id 1…16, index of a service, or 0

  [[nodiscard]] bool operator==(const Event&) const = default;
};

/// Row of the table of trouble codes.
struct EventType {
  EventKind kind;
  std::string_view name;  ///< also the key of its debounce times in the configuration
  Subject subject;
  std::uint16_t code;         ///< first two bytes of the trouble code, without the subject's number
  std::uint8_t failure_type;  ///< third byte: SAE J2012-DA
  DataQualifier effect;       ///< on the data of the radar or the pipeline; kAvailable: none
  ExtendedQualifier reason;   ///< of the radar's verdict; kNormal: none
  std::string_view meaning;
  std::string_view remedy;
};

/// All kinds, in the order of EventKind.
[[nodiscard]] const std::array<EventType, kNumberOfEventKinds>& event_types();
[[nodiscard]] inline const EventType& type_of(EventKind kind) {
  return event_types()[static_cast<std::size_t>(kind)];
}

/// False for the events whose test debounces its result itself: those of the mounting angles.
[[nodiscard]] bool is_debounced_here(EventKind kind);

/// Trouble code of three bytes, in the lower 24 bits.
[[nodiscard]] std::uint32_t dtc_of(Event event);
/// "C1A02-78": letter and digits of the two first bytes (ISO 15031-6), and the failure type byte.
[[nodiscard]] std::string code_text(std::uint32_t dtc);
/// The event of a trouble code, whether the vehicle has its subject or not.
[[nodiscard]] std::optional<Event> event_of(std::uint32_t dtc);
/// The trouble code written as by code_text(), in either case.
[[nodiscard]] std::optional<std::uint32_t> dtc_from_text(std::string_view text);

/// Subjects of a kind at most.
[[nodiscard]] std::size_t subjects_of(Subject subject);

}  // namespace boresight::health
