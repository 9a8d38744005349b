// One participant of a DDS domain, over UDP only: participants that are killed leave nothing behind in /dev/shm.
#pragma once

#include <memory>
#include <string>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "services/health/dds/config.hpp"

namespace boresight::dds {

/// Throws std::runtime_error, naming what could not be made, from the constructor and from the functions.
class Participant {
 public:
  Participant(const Config& config, const std::string& name);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// Reliable and transient-local, the last `depth` samples of each instance.
  [[nodiscard]] eprosima::fastdds::dds::DataWriter& writer(const std::string& topic,
                                                           eprosima::fastdds::dds::TypeSupport type, int depth);
  /// Calls `listener` from the middleware's thread; it has to outlive the participant.
  eprosima::fastdds::dds::DataReader& reader(const std::string& topic, eprosima::fastdds::dds::TypeSupport type,
                                             int depth, eprosima::fastdds::dds::DataReaderListener& listener);

 private:
  [[nodiscard]] eprosima::fastdds::dds::Topic& topic(const std::string& name,
                                                     const eprosima::fastdds::dds::TypeSupport& type);

  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace boresight::dds
