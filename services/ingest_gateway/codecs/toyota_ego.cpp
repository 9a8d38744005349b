#include "services/ingest_gateway/codecs/toyota_ego.hpp"

#include <cmath>

#include "interfaces/wire/toyota.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::ingest {

namespace toyota_layout = wire::toyota;

void ToyotaEgo::take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) {
  const std::uint32_t id = frame.can_id;
  if (id != toyota_layout::kYawRateId && id != toyota_layout::kSteeringId && id != toyota_layout::kWheelSpeedsId)
    return;
  if (frame.payload.size() != 8) {
    output.fault(Fault::kWireLength, "Toyota ego: frame is not 8 bytes long");
    return;
  }
  if (id != toyota_layout::kWheelSpeedsId && toyota_layout::checksum(id, frame.payload) != frame.payload.back()) {
    output.fault(Fault::kWireValue, "Toyota ego: checksum does not match");
    return;
  }
  EgoReading reading;
  if (id == toyota_layout::kYawRateId) {
    reading.yaw_rate_radps = wire::extract(toyota_layout::kYawRate_degps, frame.payload) * kRadiansPerDegree;
  } else if (id == toyota_layout::kSteeringId) {
    reading.steering_angle_rad = (wire::extract(toyota_layout::kSteeringAngle_deg, frame.payload) +
                                  wire::extract(toyota_layout::kSteeringFraction_deg, frame.payload)) *
                                 kRadiansPerDegree;
  } else {
    const double speed_kmph = 0.5 * (wire::extract(toyota_layout::kWheelRearRight_kmph, frame.payload) +
                                     wire::extract(toyota_layout::kWheelRearLeft_kmph, frame.payload));
    // The frame has no checksum. All bits set, the code for "invalid", mean 260 km/h.
    if (std::abs(speed_kmph) > 252.0) {
      output.fault(Fault::kWireValue, "Toyota ego: wheel speed beyond ±252 km/h");
      return;
    }
    reading.speed_mps = speed_kmph / 3.6;
  }
  output.take_ego(reading, stamp);
}

}  // namespace boresight::ingest
