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
  /// Skips `count` numbers of `bytes` bytes each.
  void numbers(std::size_t count, std::size_t bytes) {
    skip((bytes - position_ % bytes) % bytes);
    skip(count * bytes);
  }
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

constexpr std::size_t kByte = 1, kWord = 4, kDoubleWord = 8;

}  // namespace

template <>
bool sequences_fit<perception::TrackList>(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kTrackWords = 20 + 6 + 49;  // numbers up to `flags`, class probabilities, covariance
  constexpr std::size_t kEdgeWords = 22, kObjectWords = 14 + 7;
  constexpr std::uint32_t kMostTracks = 128, kMostEdges = 4, kMostObjects = 16;
  Walk walk(payload);
  walk.text();                    // vehicle_name
  walk.numbers(2, kDoubleWord);   // times
  walk.numbers(3, kWord);         // time_source, layout_version, radar_id
  walk.numbers(10, kDoubleWord);  // sequence numbers, stages
  walk.numbers(5, kWord);         // number_of_confirmed_tracks to likelihood_evaluations
  const std::uint32_t tracks = walk.length(kTrackWords * kWord);
  if (tracks > kMostTracks) return false;
  walk.numbers(tracks * kTrackWords, kWord);
  const std::uint32_t edges = walk.length(kEdgeWords * kWord);
  if (edges > kMostEdges) return false;
  walk.numbers(edges * kEdgeWords, kWord);
  walk.numbers(2, kWord);  // number_of_collision_warnings, dropped_path_objects
  return walk.length(kObjectWords * kWord) <= kMostObjects && walk.is_good();
}

template <>
bool sequences_fit<diagnostics::ServiceStatus>(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kSmallestFault_bytes = 3 * kWord;  // a text and a count
  constexpr std::size_t kSource_bytes = 2 * kWord + 8 * kDoubleWord;
  constexpr std::uint32_t kMostFaults = 32, kMostSources = 16;
  Walk walk(payload);
  walk.text();  // service_name, vehicle_name
  walk.text();
  walk.numbers(1, kDoubleWord);  // time_ns
  walk.numbers(1, kWord);        // condition
  walk.skip(kByte);              // deadline_missed
  walk.numbers(5, kWord);        // last_heartbeat_s to restarts
  walk.numbers(3, kDoubleWord);  // lost, dropped, rejected
  walk.skip(kByte);              // has_heartbeat
  walk.numbers(2, kWord);        // layout_version, service_index
  walk.numbers(3, kDoubleWord);  // sequence_number to incarnation_ns
  walk.numbers(2, kWord);        // pid, state
  walk.numbers(3, kDoubleWord);  // inputs, outputs, heap_allocations
  walk.numbers(6, kWord);        // processing_mean_us to queueing_max_us
  const std::uint32_t faults = walk.length(kSmallestFault_bytes);
  if (faults > kMostFaults) return false;
  for (std::uint32_t i = 0; i < faults && walk.is_good(); ++i) {
    walk.text();
    walk.numbers(1, kDoubleWord);
  }
  return walk.length(kSource_bytes) <= kMostSources && walk.is_good();
}

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
