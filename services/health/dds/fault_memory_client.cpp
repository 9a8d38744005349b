#include "services/health/dds/fault_memory_client.hpp"

#include <algorithm>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "generated/fault_memoryPubSubTypes.h"
#include "services/health/core/faults/status.hpp"
#include "services/health/dds/guarded_type.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

namespace {

namespace fast = eprosima::fastdds::dds;

/// Calls `take(sample, is_alive, info)` for each sample that waits, but no more than a reader holds: a sender must not
/// keep a tool busy.
template <typename Sample, typename Take>
void take_all(fast::DataReader& reader, const Take& take) {
  Sample sample;
  fast::SampleInfo info;
  for (int i = 0; i < kMostEvents; ++i) {
    if (reader.take_next_sample(&sample, &info) != ReturnCode_t::RETCODE_OK) return;
    take(sample, info.valid_data, info);
  }
}

}  // namespace

class FaultMemoryClient::Entities {
 public:
  Entities(const Config& config, Use use)
      : participant(config, "boresight"),
        records(participant.reader(kFaultRecordTopic, guarded<diagnostics::FaultRecordPubSubType>(kFaultRecordTopic),
                                   nullptr)),
        state(participant.reader(kFaultMemoryStateTopic,
                                 guarded<diagnostics::FaultMemoryStatePubSubType>(kFaultMemoryStateTopic), nullptr)),
        replies(participant.reader(kCommandReplyTopic, guarded<diagnostics::CommandReplyPubSubType>(kCommandReplyTopic),
                                   nullptr)),
        commands(use == Use::kCommand
                     ? &participant.writer(kCommandTopic, guarded<diagnostics::ClearCommandPubSubType>(kCommandTopic))
                     : nullptr) {}

  Participant participant;
  fast::DataReader& records;
  fast::DataReader& state;
  fast::DataReader& replies;
  fast::DataWriter* commands;  // null: this client only reads
};

FaultMemoryClient::FaultMemoryClient(const Config& config, Use use)
    : entities_(std::make_unique<Entities>(config, use)) {}
FaultMemoryClient::~FaultMemoryClient() = default;

void FaultMemoryClient::poll() {
  take_all<diagnostics::FaultRecord>(entities_->records, [this](auto& record, bool is_valid, const auto& info) {
    if (is_valid) {
      // A hostile sender could invent codes without end.
      if (records_.size() < kMostEvents) records_[record.dtc()] = record;
    } else if (info.instance_state != fast::ALIVE_INSTANCE_STATE) {
      // The sample has only its key.
      diagnostics::FaultRecord key;
      if (entities_->records.get_key_value(&key, info.instance_handle) == ReturnCode_t::RETCODE_OK) {
        records_.erase(key.dtc());
      } else {
        records_.erase(record.dtc());
      }
    }
  });
  take_all<diagnostics::FaultMemoryState>(entities_->state, [this](auto& state, bool is_valid, const auto&) {
    if (is_valid) state_ = state;
  });
  take_all<diagnostics::CommandReply>(entities_->replies, [this](auto& reply, bool is_valid, const auto&) {
    if (is_valid && asked_.contains(reply.number())) replies_[reply.number()] = reply;
  });
}

std::size_t FaultMemoryClient::stored_records() const {
  return static_cast<std::size_t>(std::count_if(records_.begin(), records_.end(), [](const auto& entry) {
    return (entry.second.status() & (health::dtc_status::kPending | health::dtc_status::kConfirmed)) != 0;
  }));
}

bool FaultMemoryClient::is_complete() const {
  return state_ && stored_records() >= state_->stored();
}

bool FaultMemoryClient::can_command() const {
  if (entities_->commands == nullptr) return false;
  fast::PublicationMatchedStatus commands;
  fast::SubscriptionMatchedStatus replies;
  entities_->commands->get_publication_matched_status(commands);
  entities_->replies.get_subscription_matched_status(replies);
  return commands.current_count > 0 && replies.current_count > 0;
}

void FaultMemoryClient::clear(std::uint32_t dtc, std::uint64_t number, const CommandKey& key) {
  if (entities_->commands == nullptr) return;
  diagnostics::ClearCommand command;
  asked_.insert(number);
  command.number(number);
  command.dtc(dtc);
  command.authentication(authentication_of(key, state_->challenge(), number, dtc));
  entities_->commands->write(&command);
}

const diagnostics::CommandReply* FaultMemoryClient::reply(std::uint64_t number) const {
  const auto found = replies_.find(number);
  return found == replies_.end() ? nullptr : &found->second;
}

}  // namespace boresight::dds
