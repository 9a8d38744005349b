// Motion of the vehicle in an alignment drive: road segments with speed and curvature, and body pitch.
#pragma once

#include <cstdint>

#include "services/simulator/alignment/spec.hpp"
#include "services/simulator/car/body.hpp"
#include "services/simulator/random.hpp"

namespace boresight::simulator {

/// True motion of the rear axle's centre.
struct AlignmentMotion {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double acceleration_mps2 = 0.0;
  double lateral_speed_mps = 0.0;   ///< V_y = −c·V·(V·ω), and side slip
  double vertical_speed_mps = 0.0;  ///< in body axes; positive while the nose is down
};

/// The road is drawn segment by segment during the drive, so that a long drive needs no more memory.
class AlignmentRoad {
 public:
  explicit AlignmentRoad(const AlignmentSpec& spec);

  /// Motion at a time since the start (s). The time must not decrease from call to call.
  [[nodiscard]] AlignmentMotion at(double time_s);

 private:
  struct Segment {
    double speed_mps, curvature_per_m, duration_s;
  };
  struct Sample {
    double speed_mps, curvature_per_m, acceleration_mps2, pitch_rad;  // pitch of the Ornstein–Uhlenbeck process
  };
  [[nodiscard]] Segment draw_segment();
  void step();

  const AlignmentSpec spec_;
  Stream segments_;
  Stream pitch_;
  car::SideSlip side_slip_;
  double pitch_decay_;
  Segment segment_;
  double segment_end_s_;
  std::uint64_t index_ = 0;  // of `before_`
  Sample before_, after_;
};

}  // namespace boresight::simulator
