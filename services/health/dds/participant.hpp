// One participant of a DDS domain, over UDP only: a killed participant leaves no file in /dev/shm.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "services/health/dds/config.hpp"

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

  /// What a reader gets that joins late.
  enum class Durability : std::uint8_t { kTransientLocal, kVolatile };

  /// Reliable, the last `depth` samples of each instance.
  [[nodiscard]] eprosima::fastdds::dds::DataWriter& writer(const std::string& topic,
                                                           const eprosima::fastdds::dds::TypeSupport& type, int depth,
                                                           Durability durability = Durability::kTransientLocal);
  /// Calls `listener`, if not null, from the middleware's thread. The listener must outlive the participant.
  eprosima::fastdds::dds::DataReader& reader(const std::string& topic, const eprosima::fastdds::dds::TypeSupport& type,
                                             int depth, eprosima::fastdds::dds::DataReaderListener* listener,
                                             Durability durability = Durability::kTransientLocal);

 private:
  [[nodiscard]] eprosima::fastdds::dds::Topic& topic(const std::string& name,
                                                     const eprosima::fastdds::dds::TypeSupport& type);

  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace boresight::dds
