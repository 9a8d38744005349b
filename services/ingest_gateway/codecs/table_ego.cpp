#include "services/ingest_gateway/codecs/table_ego.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace boresight::ingest {

namespace {

using Payload = std::span<const std::uint8_t>;

/// The quantity, if all its signals are in the frame and its value is plausible.
std::optional<double> read(const std::optional<dbc::EgoQuantity>& quantity, Payload payload, std::string_view problem,
                           DecoderOutput& output) {
  if (!quantity) return std::nullopt;
  double value = 0.0;
  for (const dbc::MappedSignal& signal : quantity->signals) {
    if (!signal.is_in(payload)) return std::nullopt;
    value += signal.value(payload);
  }
  if (!quantity->sum) value /= static_cast<double>(quantity->signals.size());
  if (value >= quantity->plausible_min && value <= quantity->plausible_max) return value;
  output.fault(Fault::kWireValue, problem);
  return std::nullopt;
}

}  // namespace

PulseSpeed::Result PulseSpeed::take(Payload payload, std::int64_t stamp_ns) {
  const std::size_t wheels = pulses_.signals.size();
  std::array<std::uint64_t, dbc::kMaxWheels> counters{};
  for (std::size_t i = 0; i < wheels; ++i) {
    const dbc::MappedSignal& signal = pulses_.signals[i];
    if (!signal.is_in(payload)) return {};
    counters[i] = wire::extract_bits(signal.signal, payload) % pulses_.wraps[i];
  }
  if (count_ == 0) {
    restart({counters.data(), wheels}, stamp_ns);
    return {};
  }
  const Sample& last = samples_[(first_ + count_ - 1) % kMaxSamples];
  if (stamp_ns == last.stamp_ns) return {};
  const double elapsed_s = static_cast<double>(stamp_ns - last.stamp_ns) * 1e-9;
  // During a pause the counters may have wrapped.
  const double most_pulses = elapsed_s * pulses_.plausible_max_mps / pulses_.metres_per_pulse;
  double pulses = 0.0;
  bool is_known = elapsed_s > 0.0, jumped = false;
  for (std::size_t i = 0; i < wheels; ++i) {
    const std::uint64_t step = (counters[i] + pulses_.wraps[i] - last_[i]) % pulses_.wraps[i];
    is_known = is_known && most_pulses < static_cast<double>(pulses_.wraps[i]);
    // One pulse more than the time allows may have been counted late.
    jumped = jumped || static_cast<double>(step) > most_pulses + 2.0;
    pulses += static_cast<double>(step) / static_cast<double>(wheels);
  }
  if (!is_known || jumped) {
    restart({counters.data(), wheels}, stamp_ns);
    return {.speed_mps = std::nullopt, .stamp_ns = stamp_ns, .jumped = is_known && jumped};
  }
  std::copy_n(counters.begin(), wheels, last_.begin());
  const Sample now{stamp_ns, last.distance_m + pulses * pulses_.metres_per_pulse};
  add(now);
  // The window starts at the latest sample that is old enough.
  while (count_ > 2 && stamp_ns - samples_[(first_ + 1) % kMaxSamples].stamp_ns >= pulses_.window_ns) {
    first_ = (first_ + 1) % kMaxSamples;
    --count_;
  }
  const std::int64_t age_ns = stamp_ns - oldest().stamp_ns;
  if (age_ns * 2 < pulses_.window_ns) return {};
  const double speed_mps = (now.distance_m - oldest().distance_m) / (static_cast<double>(age_ns) * 1e-9);
  return {.speed_mps = speed_mps, .stamp_ns = oldest().stamp_ns + age_ns / 2, .jumped = false};
}

void PulseSpeed::restart(std::span<const std::uint64_t> counters, std::int64_t stamp_ns) {
  std::copy(counters.begin(), counters.end(), last_.begin());
  first_ = 0;
  count_ = 1;
  samples_[0] = {stamp_ns, 0.0};
}

void PulseSpeed::add(const Sample& sample) {
  if (count_ == kMaxSamples) {
    first_ = (first_ + 1) % kMaxSamples;
    --count_;
  }
  samples_[(first_ + count_++) % kMaxSamples] = sample;
}

TableEgo::TableEgo(dbc::EgoMapping mapping) : mapping_(std::move(mapping)) {
  for (const dbc::EgoMessage& message : mapping_.messages) {
    keys_.push_back(message.frame.key());
    guards_.emplace_back(message.frame);
    pulses_.push_back(message.pulses ? std::optional<PulseSpeed>(*message.pulses) : std::nullopt);
  }
}

void TableEgo::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  if (frame.can_remote) return;
  const std::uint64_t key = dbc::MappedMessage::key_of(frame.can_id, frame.can_extended);
  const auto found = std::lower_bound(keys_.begin(), keys_.end(), key);
  if (found == keys_.end() || *found != key) return;
  const auto index = static_cast<std::size_t>(found - keys_.begin());
  const dbc::EgoMessage& message = mapping_.messages[index];
  const Payload payload = guards_[index].usable(frame, output);
  if (payload.empty()) return;
  EgoReading reading;
  reading.speed_mps = read(message.speed_mps, payload, "speed is outside its plausible range", output);
  reading.speed_is_signed = message.speed_is_signed;
  reading.yaw_rate_radps = read(message.yaw_rate_radps, payload, "yaw rate is outside its plausible range", output);
  reading.steering_angle_rad =
      read(message.steering_angle_rad, payload, "steering angle is outside its plausible range", output);
  if (message.reverse && message.reverse->signal.is_in(payload)) reading.reverse = message.reverse->holds(payload);
  if (reading.speed_mps || reading.yaw_rate_radps || reading.steering_angle_rad || reading.reverse) {
    output.take_ego(reading, stamp);
  }
  if (pulses_[index]) take_pulses(*pulses_[index], payload, stamp, output);
}

void TableEgo::take_pulses(PulseSpeed& pulses, Payload payload, const FrameStamp& stamp, DecoderOutput& output) const {
  const PulseSpeed::Result result = pulses.take(payload, stamp.received_ns);
  if (result.jumped) output.fault(Fault::kWireValue, "wheel pulses exceed the greatest plausible speed");
  if (!result.speed_mps) return;
  EgoReading reading;
  reading.speed_mps = result.speed_mps;
  FrameStamp middle = stamp;
  middle.received_ns = result.stamp_ns;
  output.take_ego(reading, middle);
}

}  // namespace boresight::ingest
