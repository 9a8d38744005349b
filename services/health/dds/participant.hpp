// One participant of a DDS domain, over UDP only: a killed participant leaves no file in /dev/shm.
#pragma once

#include <memory>
#include <string>

#include "services/health/dds/config.hpp"
#include "services/health/dds/topics.hpp"

namespace eprosima::fastdds::dds {
class DataReader;
class DataReaderListener;
class DataWriter;
class DomainParticipant;
class Publisher;
class Subscriber;
class Topic;
class TypeSupport;
}  // namespace eprosima::fastdds::dds

namespace boresight::dds {

/// The constructor and the functions throw std::runtime_error with the name of the entity that could not be created.
class Participant {
 public:
  Participant(const Config& config, const std::string& name);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Offers the quality of service of the topic. Does not block on a slow reader for longer than a millisecond.
  [[nodiscard]] eprosima::fastdds::dds::DataWriter& writer(const TopicQos& topic,
                                                           const eprosima::fastdds::dds::TypeSupport& type);
  /// Requests the quality of service that readers of ours need. Calls `listener`, if not null, from the middleware's
  /// thread. The listener must outlive the participant.
  eprosima::fastdds::dds::DataReader& reader(const TopicQos& topic, const eprosima::fastdds::dds::TypeSupport& type,
                                             eprosima::fastdds::dds::DataReaderListener* listener);

 private:
  [[nodiscard]] eprosima::fastdds::dds::Topic& created(const char* name,
                                                       const eprosima::fastdds::dds::TypeSupport& type);

  double period_s_;  ///< of topics without a period of their own
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace boresight::dds
