// Types of DDS whose reader refuses a damaged sample. The generated code catches a sample that is too short only; one
// with an impossible value, from a faulty or hostile sender, would end the process.
#pragma once

#include <exception>

#include <fastdds/dds/topic/TypeSupport.hpp>

namespace boresight::dds {

/// `Generated` is a …PubSubType of the generator.
template <typename Generated>
class GuardedType : public Generated {
 public:
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
    try {
      return Generated::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;  // the middleware then drops the sample
    }
  }
};

template <typename Generated>
[[nodiscard]] eprosima::fastdds::dds::TypeSupport guarded() {
  return eprosima::fastdds::dds::TypeSupport(new GuardedType<Generated>());
}

}  // namespace boresight::dds
