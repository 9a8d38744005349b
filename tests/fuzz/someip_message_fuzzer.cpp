// Any bytes as a datagram of SOME/IP messages. Every message must lie within the datagram, and the reader must finish.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "services/common/someip/message.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boresight::someip;
  const boresight::fuzz::NoAllocation guard;
  MessageReader reader({data, size});
  Message message;
  std::size_t read = 0;
  std::size_t faults_that_end = 0;
  for (ReadResult result; (result = reader.next(message)) != ReadResult::kEnd; ++read) {
    if (describe(result).empty() != (result == ReadResult::kMessage)) std::abort();
    if (faults_that_end > 0 || read > size / kHeaderBytes) std::abort();
    switch (result) {
      case ReadResult::kMessage: {
        if (message.protected_data.data() < data || message.protected_data.size() < kLengthCountsBytes) std::abort();
        if (message.protected_data.data() + message.protected_data.size() > data + size) std::abort();
        if (message.payload.size() + kLengthCountsBytes != message.protected_data.size()) std::abort();
        break;
      }
      case ReadResult::kProtocolVersion:
      case ReadResult::kMessageType:
        break;
      default:
        ++faults_that_end;
    }
  }
  return 0;
}
