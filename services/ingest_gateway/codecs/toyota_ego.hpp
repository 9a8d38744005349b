// Toyota ego signals: wheel speeds, yaw rate, steering angle.
#pragma once

#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// One reading per frame. The speed is the mean of the two rear wheel speeds, which is that of the rear axle's centre.
/// The signals have no direction of travel.
class ToyotaEgo : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
};

}  // namespace boresight::ingest
