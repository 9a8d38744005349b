#include "services/health/dds/participant.hpp"

#include <algorithm>
#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include "services/common/runtime/config/network_values.hpp"
#include "services/health/dds/interfaces.hpp"
#include "services/health/dds/security.hpp"

namespace boresight::dds {

namespace fast = eprosima::fastdds::dds;

namespace {

template <typename T>
T* made(T* thing, const std::string& what) {
  if (thing == nullptr) throw std::runtime_error("DDS: cannot create " + what);
  return thing;
}

eprosima::fastrtps::Duration_t duration_of(double seconds) {
  return eprosima::fastrtps::Duration_t(static_cast<long double>(seconds));
}

template <typename Qos>
void set_common(Qos& qos, const TopicQos& topic, int depth) {
  qos.reliability().kind =
      topic.reliability == Reliability::kReliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      topic.durability == Durability::kVolatile ? fast::VOLATILE_DURABILITY_QOS : fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  // The middleware's default is ten instances.
  qos.resource_limits().max_instances = topic.most_instances;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().max_samples = topic.most_instances * (depth + 1);  // one more while the next is received
  qos.resource_limits().allocated_samples = 1;
  qos.data_sharing().off();
}

}  // namespace

Participant::Participant(const Config& config, const std::string& name) : period_s_(config.period_s) {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  qos.name(name.c_str());
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  const UsableInterfaces usable = usable_interfaces(config.interfaces, local_interfaces());
  // Without a usable address the middleware would be mute without an error.
  if (usable.addresses.empty()) throw std::runtime_error("DDS: " + joined(usable.problems));
  const bool uses_all = std::ranges::find(config.interfaces, config::kAllInterfaces) != config.interfaces.end();
  if (!uses_all) udp->interfaceWhiteList = usable.addresses;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  secure(qos, config.security, config.domain);
  auto* const factory = fast::DomainParticipantFactory::get_instance();
  participant_ =
      made(factory->create_participant(config.domain, qos), "a participant of domain " + std::to_string(config.domain));
}

Participant::~Participant() {
  // Deletes writers, readers and topics first, so that no listener is called afterwards.
  participant_->delete_contained_entities();
  fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

fast::Topic& Participant::created(const char* name, const fast::TypeSupport& type) {
  if (type.register_type(participant_) != ReturnCode_t::RETCODE_OK) {
    throw std::runtime_error("DDS: cannot register type " + type.get_type_name());
  }
  return *made(participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT),
               std::string("topic ") + name);
}

fast::DataWriter& Participant::writer(const TopicQos& topic, const fast::TypeSupport& type) {
  if (publisher_ == nullptr) {
    publisher_ = made(participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT), "a publisher");
  }
  fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
  set_common(qos, topic, topic.written_depth);
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  // The sender is the main thread of the service and must not wait for a slow reader.
  qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;
  qos.reliability().max_blocking_time = {0, 1'000'000};
  // What is sent in each period ends with its sender; the records of the fault memory do not.
  qos.writer_data_lifecycle().autodispose_unregistered_instances = topic.deadline_periods > 0.0;
  const double period_s = topic.period_s > 0.0 ? topic.period_s : period_s_;
  if (topic.deadline_periods > 0.0) qos.deadline().period = duration_of(topic.deadline_periods * period_s);
  if (topic.lease_periods > 0.0) {
    qos.liveliness().kind = fast::AUTOMATIC_LIVELINESS_QOS;
    qos.liveliness().lease_duration = duration_of(topic.lease_periods * period_s);
    // Three signs of life in a lease: two of them may be lost.
    qos.liveliness().announcement_period = duration_of(topic.lease_periods * period_s / 3.0);
  }
  if (topic.lifespan_periods > 0.0) qos.lifespan().duration = duration_of(topic.lifespan_periods * period_s);
  return *made(publisher_->create_datawriter(&created(topic.name, type), qos),
               std::string("a writer of ") + topic.name);
}

fast::DataReader& Participant::reader(const TopicQos& topic, const fast::TypeSupport& type,
                                      fast::DataReaderListener* listener) {
  if (subscriber_ == nullptr) {
    subscriber_ = made(participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT), "a subscriber");
  }
  fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
  set_common(qos, topic, topic.read_depth);
  // The size of the type is the most that a sender can make this reader reserve, whatever size it announces.
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_MEMORY_MODE;
  const double period_s = topic.period_s > 0.0 ? topic.period_s : period_s_;
  if (topic.requested_periods > 0.0) {
    qos.deadline().period = duration_of(topic.requested_periods * period_s);
    qos.liveliness().lease_duration = duration_of(topic.requested_periods * period_s);
  }
  return *made(subscriber_->create_datareader(&created(topic.name, type), qos, listener),
               std::string("a reader of ") + topic.name);
}

}  // namespace boresight::dds
