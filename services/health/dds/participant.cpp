#include "services/health/dds/participant.hpp"

#include <stdexcept>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include "services/health/dds/security.hpp"

namespace boresight::dds {

namespace fast = eprosima::fastdds::dds;

namespace {

template <typename T>
T* made(T* thing, const std::string& what) {
  if (thing == nullptr) throw std::runtime_error("DDS: cannot create " + what);
  return thing;
}

template <typename Qos>
void set_common(Qos& qos, int depth, Participant::Durability durability) {
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = durability == Participant::Durability::kVolatile ? fast::VOLATILE_DURABILITY_QOS
                                                                           : fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
}

}  // namespace

Participant::Participant(const Config& config, const std::string& name) {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  qos.name(name.c_str());
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = config.interfaces;
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

fast::Topic& Participant::topic(const std::string& name, const fast::TypeSupport& type) {
  if (type.register_type(participant_) != ReturnCode_t::RETCODE_OK) {
    throw std::runtime_error("DDS: cannot register type " + type.get_type_name());
  }
  return *made(participant_->create_topic(name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT), "topic " + name);
}

fast::DataWriter& Participant::writer(const std::string& name, const fast::TypeSupport& type, int depth,
                                      Durability durability) {
  if (publisher_ == nullptr) {
    publisher_ = made(participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT), "a publisher");
  }
  fast::DataWriterQos qos = fast::DATAWRITER_QOS_DEFAULT;
  set_common(qos, depth, durability);
  // The sender is the main thread of the service and must not wait for a slow reader.
  qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;
  qos.reliability().max_blocking_time = {0, 1'000'000};
  return *made(publisher_->create_datawriter(&topic(name, type), qos), "a writer of " + name);
}

fast::DataReader& Participant::reader(const std::string& name, const fast::TypeSupport& type, int depth,
                                      fast::DataReaderListener* listener, Durability durability) {
  if (subscriber_ == nullptr) {
    subscriber_ = made(participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT), "a subscriber");
  }
  fast::DataReaderQos qos = fast::DATAREADER_QOS_DEFAULT;
  set_common(qos, depth, durability);
  return *made(subscriber_->create_datareader(&topic(name, type), qos, listener), "a reader of " + name);
}

}  // namespace boresight::dds
