#include "services/health/core/faults/event.hpp"

#include <charconv>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::health {

namespace {

using enum DataQualifier;
using enum ExtendedQualifier;
constexpr EventKind of(RadarEvent event) {
  return kind_of(event);
}

// Ranges of codes that SAE J2012 leaves to the vehicle manufacturer: C1… chassis, U1… network. The last two digits hold
// the subject. Codes of one range differ in their failure type byte.
constexpr std::uint16_t kRadarCode = 0x5A00;        // C1A
constexpr std::uint16_t kRadarInputCode = 0x5B00;   // C1B: what the radar needs
constexpr std::uint16_t kYawCode = 0x5D00;          // C1D
constexpr std::uint16_t kPitchCode = 0x5E00;        // C1E
constexpr std::uint16_t kRollCode = 0x5F00;         // C1F
constexpr std::uint16_t kVehicleCode = 0x5C00;      // C1C
constexpr std::uint16_t kPipelineCode = 0xDB00;     // U1B
constexpr std::uint16_t kServiceCode = 0xDA00;      // U1A
constexpr std::uint16_t kDiagnosticsCode = 0xDC00;  // U1C
constexpr std::uint16_t kFaultMemoryCode = 0xDD00;  // U1D

constexpr std::array<EventType, kNumberOfEventKinds> kTypes = {{
    {of(RadarEvent::kDefective), "defective", Subject::kRadar, kRadarCode, 0x49, kNotAvailable, kInvalidData,
     "the radar reports an internal failure, or that it does not operate", "replace the radar"},
    {of(RadarEvent::kBlocked), "blocked", Subject::kRadar, kRadarCode, 0x97, kNotAvailable, kBlocked,
     "the radar reports that it is blind or nearly blind", "clean the cover: dirt, ice, stickers"},
    {of(RadarEvent::kBlind), "blind", Subject::kRadar, kRadarCode, 0x21, kNotAvailable, kBlocked,
     "almost no detections, or none beyond a short distance, while the vehicle moves",
     "clean the cover: dirt, ice, stickers; else replace the radar"},
    {of(RadarEvent::kNoData), "no_data", Subject::kRadar, kRadarCode, 0x87, kNotAvailable, kNoData,
     "no scan within the radar's deadline", "check supply, connector and link of the radar"},
    {of(RadarEvent::kFrozen), "frozen", Subject::kRadar, kRadarCode, 0x2A, kNotAvailable, kInvalidData,
     "the radar sends the same data again and again", "restart the radar; else replace it"},
    {of(RadarEvent::kEgoContradiction), "ego_contradiction", Subject::kRadar, kRadarCode, 0x64, kNotAvailable,
     kInvalidData, "the range rates contradict the vehicle's motion",
     "check radar, mounting direction and speed signal"},
    {of(RadarEvent::kYawBeyondLimit), "yaw_beyond_limit", Subject::kRadar, kYawCode, 0x76, kNotAvailable, kMisaligned,
     "yaw error beyond the limit of use", "check bracket and mounting, then calibrate"},
    {of(RadarEvent::kPitchBeyondLimit), "pitch_beyond_limit", Subject::kRadar, kPitchCode, 0x76, kNotAvailable,
     kMisaligned, "pitch error beyond the limit of use", "check bracket and mounting, then calibrate"},
    {of(RadarEvent::kRollBeyondLimit), "roll_beyond_limit", Subject::kRadar, kRollCode, 0x76, kNotAvailable,
     kMisaligned, "roll error beyond the limit of use", "check bracket and mounting, then calibrate"},
    {of(RadarEvent::kWrongInput), "wrong_input", Subject::kRadar, kRadarCode, 0x62, kAvailableReduced, kWrongInput,
     "an input contradicts the vehicle file", "correct vehicle file, wiring or signal as the explanation states"},
    {of(RadarEvent::kYawMisaligned), "yaw_misaligned", Subject::kRadar, kYawCode, 0x78, kAvailableReduced, kMisaligned,
     "yaw error beyond the tolerance", "check the mounting, then calibrate"},
    {of(RadarEvent::kPitchMisaligned), "pitch_misaligned", Subject::kRadar, kPitchCode, 0x78, kAvailableReduced,
     kMisaligned, "pitch error beyond the tolerance", "check the mounting, then calibrate"},
    {of(RadarEvent::kRollMisaligned), "roll_misaligned", Subject::kRadar, kRollCode, 0x78, kAvailableReduced,
     kMisaligned, "roll error beyond the tolerance", "check the mounting, then calibrate"},
    {of(RadarEvent::kPartlyBlocked), "partly_blocked", Subject::kRadar, kRadarCode, 0x92, kAvailableReduced,
     kBeginningBlockage, "the radar reports reduced performance", "clean the cover"},
    {of(RadarEvent::kReducedSight), "reduced_sight", Subject::kRadar, kRadarCode, 0x22, kAvailableReduced,
     kBeginningBlockage, "fewer or nearer detections than this radar is used to, while the vehicle moves",
     "clean the cover"},
    {of(RadarEvent::kDisturbed), "disturbed", Subject::kRadar, kRadarCode, 0x2F, kAvailableReduced,
     kExternalDisturbance, "the detections are those of a disturbance, not of a scene",
     "none, if it ends with the place; else check the radar"},
    {of(RadarEvent::kRejectedData), "rejected_data", Subject::kRadar, kRadarCode, 0x81, kAvailableReduced, kInvalidData,
     "too large a share of frames is rejected", "check protocol version, link and end-to-end protection"},
    {of(RadarEvent::kSuspectData), "suspect_data", Subject::kRadar, kRadarCode, 0x82, kAvailableReduced, kInvalidData,
     "too large a share of scans has an integrity fault, for example frozen data", "check the radar"},
    {of(RadarEvent::kRateReduced), "rate_reduced", Subject::kRadar, kRadarCode, 0x36, kAvailableReduced, kRateReduced,
     "scans arrive more rarely than the vehicle file states", "check the load of the link and the cycle time"},
    {of(RadarEvent::kRateTooHigh), "rate_too_high", Subject::kRadar, kRadarCode, 0x37, kAvailableReduced, kInvalidData,
     "scans arrive more often than the vehicle file states", "check for a second sender and the cycle time"},
    {of(RadarEvent::kDelayed), "delayed", Subject::kRadar, kRadarCode, 0x26, kAvailableReduced, kDelayed,
     "scans arrive too late after their measurement", "check the load of the link and the time synchronisation"},
    {of(RadarEvent::kSupply), "supply", Subject::kRadar, kRadarCode, 0x1C, kAvailable, kNormal,
     "the radar reports a supply voltage out of range", "check the supply"},
    {of(RadarEvent::kTemperature), "temperature", Subject::kRadar, kRadarCode, 0x98, kAvailable, kNormal,
     "the radar reports a temperature out of range", "let the radar cool down; check its mounting"},
    {of(RadarEvent::kUnsynchronised), "unsynchronised", Subject::kRadar, kRadarInputCode, 0x29, kAvailable, kNormal,
     "the radar's clock is not synchronised", "check the time synchronisation of the network"},
    {of(RadarEvent::kWithoutEgoMotion), "without_ego_motion", Subject::kRadar, kRadarInputCode, 0x87, kAvailable,
     kNormal, "the radar lacks the vehicle's motion", "check the feed of the vehicle's motion to the radar"},
    {EventKind::kServiceSilent, "service_silent", Subject::kService, kServiceCode, 0x87, kAvailable, kNormal,
     "no heartbeat of the service within its deadline", "read the service's log; report it"},
    {EventKind::kServiceLate, "service_late", Subject::kService, kServiceCode, 0x93, kAvailable, kNormal,
     "the service gets input and publishes nothing in time", "read the service's log; check the load of the ECU"},
    {EventKind::kServiceLosing, "service_losing", Subject::kService, kServiceCode, 0x82, kAvailable, kNormal,
     "the service loses or drops input", "check the load of the ECU"},
    {EventKind::kServiceDegraded, "service_degraded", Subject::kService, kServiceCode, 0x92, kAvailable, kNormal,
     "the service reports that it is degraded", "read the service's log"},
    {EventKind::kServiceRestarted, "service_restarted", Subject::kService, kServiceCode, 0x94, kAvailable, kNormal,
     "the service was restarted", "read the service's log; report it if it repeats"},
    {EventKind::kPipelineLosing, "pipeline_losing", Subject::kVehicle, kPipelineCode, 0x82, kAvailableReduced, kNormal,
     "scans are lost or dropped between the stages", "check the load of the ECU"},
    {EventKind::kPipelineQueueing, "pipeline_queueing", Subject::kVehicle, kPipelineCode, 0x26, kAvailableReduced,
     kNormal, "scans wait too long for a stage", "check the load of the ECU"},
    {EventKind::kPipelineWorkBudget, "pipeline_work_budget", Subject::kVehicle, kPipelineCode, 0x92, kAvailableReduced,
     kNormal, "a stage ends its work on scans before it is complete",
     "check the load of the ECU and the number of detections"},
    {EventKind::kPipelineLate, "pipeline_late", Subject::kVehicle, kPipelineCode, 0x33, kAvailableReduced, kNormal,
     "track lists come later after the arrival of the scan than the latency budget", "check the load of the ECU"},
    {EventKind::kPipelineSilent, "pipeline_silent", Subject::kVehicle, kPipelineCode, 0x31, kNotAvailable, kNormal,
     "no track list although scans arrive", "read the logs of the services"},
    {EventKind::kLoadChange, "load_change", Subject::kVehicle, kVehicleCode, 0x9A, kAvailable, kNormal,
     "the load changed the vehicle's pitch", "none: no radar is misaligned by it"},
    {EventKind::kSpeedSignalChange, "speed_signal_change", Subject::kVehicle, kVehicleCode, 0x64, kAvailable, kNormal,
     "the scale of the speed signal changed", "check tyres and the speed signal"},
    {EventKind::kDiagnosticsMute, "diagnostics_mute", Subject::kVehicle, kDiagnosticsCode, 0x88, kAvailable, kNormal,
     "diagnostics cannot be sent by DDS", "check the network interfaces and the section [dds]"},
    {EventKind::kFaultMemoryLost, "fault_memory_lost", Subject::kVehicle, kFaultMemoryCode, 0x44, kAvailable, kNormal,
     "the stored fault memory could not be used", "look for the file with the suffix .rejected; check the medium"},
    {EventKind::kFaultMemoryUnwritable, "fault_memory_unwritable", Subject::kVehicle, kFaultMemoryCode, 0x43,
     kAvailable, kNormal, "the fault memory cannot be written", "free space on the medium; check its rights"},
    {EventKind::kLevelsLost, "levels_lost", Subject::kVehicle, kFaultMemoryCode, 0x46, kAvailable, kNormal,
     "the stored levels of what the radars are used to see could not be used",
     "none: they are learnt again; look for the file with the suffix .rejected"},
}};

constexpr bool types_are_in_order() {
  for (std::size_t i = 0; i < kTypes.size(); ++i) {
    if (static_cast<std::size_t>(kTypes[i].kind) != i) return false;
    for (std::size_t j = 0; j < i; ++j) {
      if (kTypes[i].code == kTypes[j].code && kTypes[i].failure_type == kTypes[j].failure_type) return false;
    }
  }
  return true;
}
static_assert(types_are_in_order(), "type_of(kind) indexes the table, and no two kinds share a code");

}  // namespace

const std::array<EventType, kNumberOfEventKinds>& event_types() {
  return kTypes;
}

bool is_debounced_here(EventKind kind) {
  return type_of(kind).reason != ExtendedQualifier::kMisaligned;
}

std::uint32_t dtc_of(Event event) {
  const EventType& type = type_of(event.kind);
  return (static_cast<std::uint32_t>(type.code) + event.subject) << 8U | type.failure_type;
}

std::string code_text(std::uint32_t dtc) {
  constexpr std::string_view kLetters = "PCBU";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text(1, kLetters[(dtc >> 22U) & 3U]);
  text += kDigits[(dtc >> 20U) & 3U];
  for (const unsigned shift : {16U, 12U, 8U, 4U, 0U}) {
    if (shift == 4U) text += '-';
    text += kDigits[(dtc >> shift) & 15U];
  }
  return text;
}

std::optional<Event> event_of(std::uint32_t dtc) {
  for (const EventType& type : kTypes) {
    const std::uint32_t base = static_cast<std::uint32_t>(type.code) << 8U | type.failure_type;
    if ((dtc & ~0xFF00U) != base) continue;
    const std::uint32_t subject = (dtc >> 8U) & 0xFFU;
    const bool exists =
        type.subject == Subject::kRadar ? subject >= 1 && subject <= kMaxRadars : subject < subjects_of(type.subject);
    if (exists) return Event{type.kind, static_cast<std::uint8_t>(subject)};
  }
  return std::nullopt;
}

std::optional<std::uint32_t> dtc_from_text(std::string_view text) {
  constexpr std::size_t kLength = 8;  // "C1A02-78"
  if (text.size() != kLength || text[5] != '-') return std::nullopt;
  constexpr std::string_view kLetters = "PCBUpcbu";
  const std::size_t letter = kLetters.find(text[0]);
  if (letter == std::string_view::npos) return std::nullopt;
  std::uint32_t code = 0, type = 0;
  const auto is_number = [](std::string_view digits, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    return error == std::errc{} && end == digits.data() + digits.size();
  };
  if (!is_number(text.substr(1, 4), code) || code > 0x3FFF || !is_number(text.substr(6, 2), type)) return std::nullopt;
  return static_cast<std::uint32_t>(letter % 4) << 22U | code << 8U | type;
}

std::size_t subjects_of(Subject subject) {
  switch (subject) {
    case Subject::kRadar:
      return kMaxRadars;
    case Subject::kService:
      return catalogue::kNumberOfSupervisedServices;
    case Subject::kVehicle:
      break;
  }
  return 1;
}

}  // namespace boresight::health
