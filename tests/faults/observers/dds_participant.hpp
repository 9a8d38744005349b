// A participant of DDS as another maker's tool would have it: the types of interfaces/idl, and none of the product's
// code.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

namespace boresight::faults {

inline constexpr const char* kSensorHealthTopic = "boresight/sensor_health";
inline constexpr const char* kSystemHealthTopic = "boresight/system_health";

/// Reliable and transient-local, the latest sample of each instance.
template <typename Qos>
Qos latest(Qos qos) {
  qos.reliability().kind = eprosima::fastdds::dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = eprosima::fastdds::dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = eprosima::fastdds::dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

/// Entities live until the process ends. The functions throw std::runtime_error if an entity cannot be made.
class Participant {
 public:
  Participant(std::uint32_t domain, const std::string& name) {
    eprosima::fastdds::dds::DomainParticipantQos qos = eprosima::fastdds::dds::PARTICIPANT_QOS_DEFAULT;
    qos.name(name.c_str());
    participant_ =
        made(eprosima::fastdds::dds::DomainParticipantFactory::get_instance()->create_participant(domain, qos),
             "participant");
  }

  eprosima::fastdds::dds::DataReader& reader(const std::string& topic, const eprosima::fastdds::dds::TypeSupport& type,
                                             eprosima::fastdds::dds::DataReaderListener& listener) {
    auto* const subscriber =
        made(participant_->create_subscriber(eprosima::fastdds::dds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
    return *made(subscriber->create_datareader(topic_of(topic, type),
                                               latest(eprosima::fastdds::dds::DATAREADER_QOS_DEFAULT), &listener),
                 "reader");
  }

  eprosima::fastdds::dds::DataWriter& writer(const std::string& topic,
                                             const eprosima::fastdds::dds::TypeSupport& type) {
    auto* const publisher =
        made(participant_->create_publisher(eprosima::fastdds::dds::PUBLISHER_QOS_DEFAULT), "publisher");
    return *made(
        publisher->create_datawriter(topic_of(topic, type), latest(eprosima::fastdds::dds::DATAWRITER_QOS_DEFAULT)),
        "writer");
  }

 private:
  template <typename T>
  static T* made(T* entity, const char* what) {
    if (entity == nullptr) throw std::runtime_error(std::string("DDS: no ") + what);
    return entity;
  }
  eprosima::fastdds::dds::Topic* topic_of(const std::string& name, const eprosima::fastdds::dds::TypeSupport& type) {
    type.register_type(participant_);
    return made(participant_->create_topic(name, type.get_type_name(), eprosima::fastdds::dds::TOPIC_QOS_DEFAULT),
                "topic");
  }

  eprosima::fastdds::dds::DomainParticipant* participant_;
};

}  // namespace boresight::faults
