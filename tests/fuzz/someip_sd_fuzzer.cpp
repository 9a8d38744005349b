// Any payload as a service-discovery message. An accepted message can be read without access beyond its end.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "services/ingest_gateway/codecs/someip/sd.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boresight;
  using namespace boresight::ingest::someip;
  Message message;
  message.service = kSdService;
  message.method = kSdMethod;
  message.interface_version = 1;
  message.payload = {data, size};
  static SdMessage sd;
  const fuzz::NoAllocation guard;
  if (sd.read(message) != SdFault::kNone) return 0;
  recording::Endpoint endpoint;
  for (const SdMessage::Family family : {SdMessage::Family::kIpv4, SdMessage::Family::kIpv6}) {
    for (const SdEntry& entry : sd.entries()) {
      if (entry.fault != SdFault::kNone) continue;
      for (const std::size_t which : {0, 1}) {
        for (const SdOption& option : sd.run(entry, which)) {
          if (option.content.data() < data || option.content.data() + option.content.size() > data + size) std::abort();
        }
      }
      if (sd.endpoint_of(entry, family, SdMessage::Purpose::kUnicast, endpoint) == SdFault::kNone &&
          (endpoint.address.is_multicast() || endpoint.address.is_unspecified() || endpoint.port == 0)) {
        std::abort();
      }
      if (sd.endpoint_of(entry, family, SdMessage::Purpose::kMulticast, endpoint) == SdFault::kNone &&
          !endpoint.address.is_multicast()) {
        std::abort();
      }
    }
    static_cast<void>(sd.sd_endpoint(family, endpoint));
  }
  return 0;
}
