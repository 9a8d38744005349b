// Toyota ego signals: wheel speeds, yaw rate, steering angle.
#pragma once

#include "services/ingest_gateway/codecs/decoder.hpp"

namespace boresight::ingest {

/// One reading a frame. The speed is the mean of the rear wheels, that is, of the rear axle's centre; these wheel
/// speeds carry no direction of travel.
class ToyotaEgo : public Decoder {
 public:
  void take(const recording::Frame& frame, const FrameStamp& stamp, DecoderOutput& output) override;
};

}  // namespace boresight::ingest
