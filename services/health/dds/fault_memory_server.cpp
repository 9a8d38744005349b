#include "services/health/dds/fault_memory_server.hpp"

#include <algorithm>
#include <string_view>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fmt/format.h>

#include "generated/fault_memoryPubSubTypes.h"
#include "interfaces/catalogue/catalogue.hpp"
#include "services/common/alignment_words/alignment_words.hpp"
#include "services/health/dds/guarded_type.hpp"

namespace boresight::dds {

namespace {

using health::FreezeFrame;

// A refused command must not help to guess the secret by trying, or load the service.
constexpr std::int64_t kCommandPause_ns = 200'000'000;

diagnostics::FreezeFrame to_frame(const FreezeFrame& frame, bool exists) {
  diagnostics::FreezeFrame out;
  if (!exists) return out;
  out.time_ns(frame.time_ns);
  out.uptime_ns(frame.uptime_ns);
  out.operation_cycle(frame.cycle);
  out.speed_mps(frame.speed_mps);
  out.rate_hz(frame.rate_hz);
  out.detections_per_scan(frame.detections_per_scan);
  out.lateral_displacement_m(frame.lateral_displacement_m);
  out.reference_range_m(frame.reference_range_m);
  out.lost_coverage_ratio(frame.lost_coverage_ratio);
  out.range_loss_ratio(frame.range_loss_ratio);
  out.velocity_error_mps(frame.velocity_error_mps);
  out.estimate(frame.estimate);
  out.covariance(frame.covariance);
  out.configuration(frame.configuration);
  out.software(std::string(frame.software.data()));
  return out;
}

bool is_shown(const health::EventStatus& status) {
  return status.is_stored() || status.has(health::dtc_status::kTestFailed);
}

bool differ(const health::EventStatus& a, const health::EventStatus& b) {
  return a.bits != b.bits || a.occurrences != b.occurrences || a.aged_cycles != b.aged_cycles ||
         a.healed_cycles != b.healed_cycles || a.failed_cycles != b.failed_cycles;
}

}  // namespace

std::string subject_text(health::Event event, const VehicleConfig& vehicle) {
  switch (health::type_of(event.kind).subject) {
    case health::Subject::kRadar:
      return "radar " + alignment_words::radar_name(vehicle, event.subject);
    case health::Subject::kService:
      return "service " + std::string(catalogue::name_of(static_cast<catalogue::Service>(event.subject)));
    case health::Subject::kVehicle:
      break;
  }
  return "vehicle";
}

diagnostics::FaultRecord to_fault_record(const health::FaultRecord& record, const VehicleConfig& vehicle) {
  const health::EventType& type = health::type_of(record.event.kind);
  diagnostics::FaultRecord out;
  out.dtc(health::dtc_of(record.event));
  out.code(health::code_text(out.dtc()));
  out.name(std::string(type.name));
  out.subject(subject_text(record.event, vehicle));
  out.meaning(std::string(type.meaning));
  out.remedy(std::string(type.remedy));
  out.status(record.status.bits);
  out.fault_detection_counter(static_cast<std::uint8_t>(record.debounce.counter()));
  out.occurrences(record.status.occurrences);
  out.failed_cycles(record.status.failed_cycles);
  out.healed_cycles(record.status.healed_cycles);
  out.aged_cycles(record.status.aged_cycles);
  const bool has_frames = record.status.occurrences > 0;
  out.first(to_frame(record.first, has_frames));
  out.latest(to_frame(record.latest, has_frames));
  return out;
}

FaultMemoryServer::FaultMemoryServer(Participant& participant, const VehicleConfig& vehicle,
                                     health::FaultMemory& memory, const CommandKey& key)
    : vehicle_(vehicle),
      memory_(memory),
      key_(key),
      records_(participant.writer(kFaultRecordTopic, guarded<diagnostics::FaultRecordPubSubType>(kFaultRecordTopic))),
      state_(participant.writer(kFaultMemoryStateTopic,
                                guarded<diagnostics::FaultMemoryStatePubSubType>(kFaultMemoryStateTopic))),
      replies_(
          participant.writer(kCommandReplyTopic, guarded<diagnostics::CommandReplyPubSubType>(kCommandReplyTopic))),
      commands_(
          participant.reader(kCommandTopic, guarded<diagnostics::ClearCommandPubSubType>(kCommandTopic), nullptr)),
      challenge_(new_challenge()),
      is_sent_(memory.records().size()),
      sent_status_(memory.records().size()) {}

std::vector<std::string> FaultMemoryServer::serve(std::int64_t now_ns) {
  std::vector<std::string> lines;
  diagnostics::ClearCommand command;
  eprosima::fastdds::dds::SampleInfo info;
  while (now_ns >= next_command_ns_ && commands_.take_next_sample(&command, &info) == ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    diagnostics::CommandReply reply;
    lines.push_back(execute(command, reply));
    replies_.write(&reply);
    next_command_ns_ = now_ns + kCommandPause_ns;
  }
  if (has_sent_ && memory_.revision() == sent_revision_ && lines.empty()) return lines;
  publish_records();
  publish_state();
  has_sent_ = true;
  sent_revision_ = memory_.revision();
  return lines;
}

std::string FaultMemoryServer::execute(const diagnostics::ClearCommand& command, diagnostics::CommandReply& reply) {
  reply.number(command.number());
  reply.is_accepted(false);
  const std::string target = command.dtc() == kAllDtcs ? "all codes" : health::code_text(command.dtc());
  if (key_.empty()) {
    reply.reason("no secret for commands is configured: dds.command_key_file");
  } else if (!is_authentic(key_, challenge_, command.number(), command.dtc(), command.authentication())) {
    reply.reason("not authorised");
  } else if (command.dtc() == kAllDtcs) {
    memory_.clear_all();
    reply.is_accepted(true);
  } else if (memory_.clear(command.dtc())) {
    reply.is_accepted(true);
  } else {
    reply.reason("this vehicle has no code " + target);
  }
  // Each challenge serves once, so that a recorded command is worth nothing.
  challenge_ = new_challenge();
  return reply.is_accepted() ? "fault memory: " + target + " cleared by command"
                             : "fault memory: command to clear " + target + " refused: " + reply.reason();
}

void FaultMemoryServer::publish_records() {
  const auto records = memory_.records();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const bool shown = is_shown(records[i].status);
    if (!shown && !is_sent_[i]) continue;
    if (shown && is_sent_[i] && !differ(records[i].status, sent_status_[i])) continue;
    diagnostics::FaultRecord sample = to_fault_record(records[i], vehicle_);
    if (shown) {
      records_.write(&sample);
    } else {
      records_.dispose(&sample, eprosima::fastrtps::rtps::InstanceHandle_t());
    }
    is_sent_[i] = shown;
    sent_status_[i] = records[i].status;
  }
}

void FaultMemoryServer::publish_state() {
  diagnostics::FaultMemoryState state;
  state.vehicle_name(vehicle_.name);
  state.operation_cycle(memory_.cycle());
  state.stored(memory_.stored());
  state.accepts_commands(!key_.empty());
  state.challenge(challenge_);
  state_.write(&state);
}

}  // namespace boresight::dds
