#include "services/common/e2e/checker.hpp"

#include <algorithm>

#include "services/common/e2e/header.hpp"

namespace boresight::e2e {

Checker::Checker(const Config& config) : config_(config) {}

Status Checker::check(std::span<const std::uint8_t> data) {
  const Status status = judge(data);
  ++statistics_.received;
  switch (status) {
    case Status::kInitial:
    case Status::kOk:
    case Status::kOkSomeLost:
      ++statistics_.accepted;
      break;
    case Status::kRepeated:
      ++statistics_.repeated;
      break;
    case Status::kWrongSequence:
      ++statistics_.wrong_sequence;
      break;
    case Status::kWrongCrc:
      ++statistics_.wrong_crc;
      break;
    case Status::kWrongLength:
      ++statistics_.wrong_length;
      break;
    case Status::kWrongDataId:
      ++statistics_.wrong_data_id;
      break;
  }
  return status;
}

void Checker::reset() {
  last_.reset();
  strayed_.reset();
}

Status Checker::judge(std::span<const std::uint8_t> data) {
  if (config_.profile == Profile::kNone) return Status::kOk;
  if (!has_room(config_, data)) return Status::kWrongLength;
  const Header header = read_header(config_, data);
  if (layout(config_.profile).length_bytes > 0 && header.length != data.size()) return Status::kWrongLength;
  if (header.crc != compute_crc(config_, header.counter, data)) return Status::kWrongCrc;
  if (header.data_id != sent_data_id(config_)) return Status::kWrongDataId;
  return judge_counter(header.counter);
}

/// A message out of sequence is rejected, but its cause may be a restarted sender or a long gap. If it were ignored,
/// all following messages would be rejected too. If its counter were accepted at once, one late message would make the
/// next good one look wrong (compare vsomeip issue 1055). Therefore both counters are kept: the next message is
/// accepted if it follows either the former sequence or the message out of sequence.
Status Checker::judge_counter(std::uint32_t counter) {
  const std::uint64_t values = layout(config_.profile).counter_values;
  if (counter >= values) return Status::kWrongSequence;  // 15 is not a valid counter of P01 and P11
  if (!last_) {
    last_ = counter;
    return Status::kInitial;
  }
  const auto steps_from = [&](std::uint32_t before) { return (counter + values - before) % values; };
  if (counter == *last_ || counter == strayed_) return Status::kRepeated;

  const std::uint64_t allowed = std::max(config_.max_delta_counter, 1u);
  std::uint64_t steps = steps_from(*last_);
  if (steps > allowed && strayed_) steps = steps_from(*strayed_);
  if (steps > allowed) {
    if (strayed_) last_ = strayed_;
    strayed_ = counter;
    if (steps <= values / 2) statistics_.lost += steps - 1;
    return Status::kWrongSequence;
  }
  last_ = counter;
  strayed_.reset();
  statistics_.lost += steps - 1;
  return steps == 1 ? Status::kOk : Status::kOkSomeLost;
}

}  // namespace boresight::e2e
