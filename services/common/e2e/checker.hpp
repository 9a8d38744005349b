// The receiver's side of E2E protection.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

/// Messages since construction, by result; `accepted` is the number of acceptable ones.
struct Statistics {
  std::uint64_t received = 0;
  std::uint64_t accepted = 0;
  /// Missing messages by the counter, before accepted messages and before those of a wrong sequence. A jump of more
  /// than half of the counter's values counts as a jump backwards (late message, restarted sender) and adds nothing.
  std::uint64_t lost = 0;
  std::uint64_t repeated = 0;
  std::uint64_t wrong_sequence = 0;
  std::uint64_t wrong_crc = 0;
  std::uint64_t wrong_length = 0;
  std::uint64_t wrong_data_id = 0;
};

/// Checks the messages of one sender, in order of arrival. With Profile::kNone every message is kOk.
class Checker {
 public:
  explicit Checker(const Config& config);

  /// Checks one message: all protected data, including the header. For SOME/IP these begin at the Request ID, and
  /// offset_bytes is 8. Never reads outside `data`; allocates nothing.
  Status check(std::span<const std::uint8_t> data);

  /// Forgets the counter, so that the next correct message is kInitial; keeps the statistics.
  void reset();

  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  [[nodiscard]] const Config& config() const { return config_; }

 private:
  [[nodiscard]] Status judge(std::span<const std::uint8_t> data);
  [[nodiscard]] Status judge_counter(std::uint32_t counter);

  Config config_;
  Statistics statistics_;
  std::optional<std::uint32_t> last_;     ///< counter of the last message in sequence
  std::optional<std::uint32_t> strayed_;  ///< counter of the previous message, if it was out of sequence
};

}  // namespace boresight::e2e
