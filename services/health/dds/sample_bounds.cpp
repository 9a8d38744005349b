#include "services/health/dds/sample_bounds.hpp"

namespace boresight::dds {

namespace {

/// Walks over a payload in CDR (OMG DDSI-RTPS 10.2): two bytes with the byte order, two of options, then the fields,
/// each aligned to its size. A step beyond the end fails, and so do all later ones.
class Walk {
 public:
  explicit Walk(std::span<const std::uint8_t> payload) {
    constexpr std::size_t kHeader_bytes = 4;
    is_good_ = payload.size() >= kHeader_bytes;
    if (!is_good_) return;
    is_little_endian_ = (payload[1] & 1U) != 0;
    rest_ = payload.subspan(kHeader_bytes);
  }
  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] std::size_t remaining() const { return rest_.size() - position_; }

  void skip(std::size_t bytes) {
    is_good_ = is_good_ && bytes <= remaining();
    if (is_good_) position_ += bytes;
  }
  /// 0 after a failure.
  std::uint32_t number() {
    constexpr std::size_t kBytes = 4;
    skip((kBytes - position_ % kBytes) % kBytes);
    if (!is_good_ || remaining() < kBytes) {
      is_good_ = false;
      return 0;
    }
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < kBytes; ++i) {
      const std::size_t byte = is_little_endian_ ? kBytes - 1 - i : i;
      value = value << 8U | rest_[position_ + byte];
    }
    position_ += kBytes;
    return value;
  }
  void text() { skip(number()); }
  /// Length of a sequence whose elements have at least that size; 0 after a failure.
  std::uint32_t length(std::size_t smallest_element_bytes) {
    const std::uint32_t announced = number();
    is_good_ = is_good_ && announced <= remaining() / smallest_element_bytes;
    return is_good_ ? announced : 0;
  }

 private:
  std::span<const std::uint8_t> rest_;
  std::size_t position_ = 0;
  bool is_little_endian_ = false;
  bool is_good_ = false;
};

}  // namespace

template <>
bool sequences_fit<diagnostic_msgs::msg::dds_::DiagnosticArray_>(std::span<const std::uint8_t> payload) {
  // An empty text has its length and, from most writers, a terminating zero.
  constexpr std::size_t kSmallestText_bytes = 4;
  constexpr std::size_t kSmallestValue_bytes = 2 * kSmallestText_bytes;
  constexpr std::size_t kSmallestStatus_bytes = 1 + 3 * kSmallestText_bytes + 4;
  Walk walk(payload);
  walk.number();  // stamp
  walk.number();
  walk.text();  // frame_id
  const std::uint32_t statuses = walk.length(kSmallestStatus_bytes);
  for (std::uint32_t i = 0; i < statuses && walk.is_good(); ++i) {
    walk.skip(1);  // level
    walk.text();   // name, message, hardware_id
    walk.text();
    walk.text();
    const std::uint32_t values = walk.length(kSmallestValue_bytes);
    for (std::uint32_t k = 0; k < values && walk.is_good(); ++k) {
      walk.text();
      walk.text();
    }
  }
  return walk.is_good();
}

}  // namespace boresight::dds
