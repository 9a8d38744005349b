// Fuzzer of E2E protection. The first bytes choose the configuration, which may be wrong; the rest is data. A check
// must never read out of bounds (checked by the sanitizers), and the receiver must accept a message that its sender
// protected.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "services/common/e2e/checker.hpp"
#include "services/common/e2e/protector.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight::e2e;
using boresight::fuzz::NoAllocation;
using boresight::fuzz::require;

/// Returns the next bytes of the input, and zeros after its end.
class Choices {
 public:
  Choices(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint32_t next(std::size_t bytes) {
    std::uint32_t value = 0;
    for (; bytes > 0; --bytes) value = value << 8 | (at_ < size_ ? data_[at_++] : 0u);
    return value;
  }
  [[nodiscard]] std::vector<std::uint8_t> rest() const { return {data_ + at_, data_ + size_}; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* input, std::size_t size) {
  Choices choices(input, size);
  Config config;
  config.profile = static_cast<Profile>(choices.next(1) % 10);  // the last is none of them
  config.data_id_mode = static_cast<DataIdMode>(choices.next(1) % 5);
  config.data_id = choices.next(4);
  const std::uint32_t kind = choices.next(1);
  config.offset_bytes = kind == 0xFF ? 0xFFFFFFFF - choices.next(1) : kind % 32;
  config.max_delta_counter = choices.next(2);
  for (std::uint8_t& id : config.data_id_list) id = static_cast<std::uint8_t>(choices.next(1));
  const bool valid = !validate(config).has_value();

  // The input unchanged, twice: the second time the message is a repetition.
  const std::vector<std::uint8_t> data = choices.rest();
  Checker receiver(config);
  const Status again = [&] {
    const NoAllocation guard;
    receiver.check(data);
    return receiver.check(data);
  }();
  if (valid && config.profile != Profile::kNone) require(!is_acceptable(again));

  // Truncated messages, some of which end within the header.
  Checker truncated(config);
  for (std::size_t length = 0; length <= std::min<std::size_t>(data.size(), 40); ++length) {
    const std::vector<std::uint8_t> part(data.begin(), data.begin() + static_cast<std::ptrdiff_t>(length));
    truncated.check(part);
  }

  std::vector<std::uint8_t> message = data;
  Protector sender(config);
  Checker fresh(config);
  const NoAllocation guard;
  for (int i = 0; i < 18; ++i) {  // beyond the wrap of the short counters
    if (!sender.protect(message)) {
      require(message == data);
      break;
    }
    const Status status = fresh.check(message);
    if (valid) require(config.profile == Profile::kNone || i > 0 ? status == Status::kOk : status == Status::kInitial);
  }
  const Statistics& s = fresh.statistics();
  require(s.received == s.accepted + s.repeated + s.wrong_sequence + s.wrong_crc + s.wrong_length + s.wrong_data_id);
  return 0;
}
