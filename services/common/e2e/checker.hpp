// The receiver's side of E2E protection.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

/// Messages since construction, by verdict; `accepted` sums up the acceptable ones.
struct Statistics {
  std::uint64_t received = 0;
  std::uint64_t accepted = 0;
  /// Messages that the counter stepped over, before accepted messages and before those of a wrong sequence. A jump of
  /// more than half of the counter's values is taken as one backwards (a late message, a sender that restarted) and
  /// adds nothing.
  std::uint64_t lost = 0;
  std::uint64_t repeated = 0;
  std::uint64_t wrong_sequence = 0;
  std::uint64_t wrong_crc = 0;
  std::uint64_t wrong_length = 0;
  std::uint64_t wrong_data_id = 0;
};

/// Judges the messages of one sender, in order of arrival. With Profile::kNone everything is kOk.
class Checker {
 public:
  explicit Checker(const Config& config);

  /// Judges one message: all of the protected data, header included. For SOME/IP these begin at the Request ID, and
  /// offset_bytes is 8. Reads within `data` only, whatever they hold; allocates nothing.
  Status check(std::span<const std::uint8_t> data);

  /// Forgets the counter, so that the next sound message is kInitial; the statistics stay.
  void reset();

  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  [[nodiscard]] const Config& config() const { return config_; }

 private:
  [[nodiscard]] Status judge(std::span<const std::uint8_t> data);
  [[nodiscard]] Status judge_counter(std::uint32_t counter);

  Config config_;
  Statistics statistics_;
  std::optional<std::uint32_t> last_;     ///< counter that the sequence is followed from
  std::optional<std::uint32_t> strayed_;  ///< counter of the message before, if it was out of sequence
};

}  // namespace boresight::e2e
