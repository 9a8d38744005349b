// Types of DDS whose reader refuses a damaged or excessive sample. The generated code catches a sample that is too
// short only; one with an impossible value, from a faulty or hostile sender, would end the process or take its memory.
#pragma once

#include <exception>

#include <fastdds/dds/topic/TypeSupport.hpp>

#include "services/health/dds/sample_bounds.hpp"
#include "services/health/dds/topics.hpp"

namespace boresight::dds {

/// `Generated` is a …PubSubType of the generator.
template <typename Generated>
class GuardedType : public Generated {
 public:
  /// Refuses samples of more than `most_bytes`. Readers reserve that size for a sample, whatever the sender announces.
  explicit GuardedType(std::uint32_t most_bytes) : most_bytes_(most_bytes) { this->m_typeSize = most_bytes; }

  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    if (payload->length > most_bytes_) return false;
    if (!sequences_fit<typename Generated::type>({payload->data, payload->length})) return false;
    try {
      return Generated::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;  // the middleware then drops the sample
    }
  }

 private:
  std::uint32_t most_bytes_;
};

template <typename Generated>
[[nodiscard]] eprosima::fastdds::dds::TypeSupport guarded(const TopicQos& topic) {
  return eprosima::fastdds::dds::TypeSupport(new GuardedType<Generated>(topic.most_bytes));
}

}  // namespace boresight::dds
