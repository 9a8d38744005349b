// Frames of an ARS408, as sent by the sensor.
#pragma once

#include <cstdint>
#include <vector>

#include "interfaces/wire/ars408.hpp"
#include "tests/unit/ingest_gateway/put_signal.hpp"

namespace boresight::ingest::ars408_frames {

namespace layout = wire::ars408;
using Bytes = std::vector<std::uint8_t>;

struct CanFrame {
  std::uint32_t id;
  Bytes bytes;
};
using Frames = std::vector<CanFrame>;

/// Values of one cluster or object.
struct Target {
  double x_m = 30.0, y_m = 4.1, vx_mps = -10.0, vy_mps = 2.0, rcs_dbsm = 7.5;
  unsigned rms_x = 10, rms_y = 12, rms_vx = 8, rms_vy = 14;
  unsigned probability = 1, state = 0, ambiguity = 3;  // clusters: of a false alarm
};

inline CanFrame cluster_status(unsigned near, unsigned far, unsigned counter = 17) {
  CanFrame frame{layout::kClusterStatusId, Bytes(5)};
  put_raw(frame.bytes, layout::cluster_status::kNear, near);
  put_raw(frame.bytes, layout::cluster_status::kFar, far);
  put_raw(frame.bytes, layout::cluster_status::kMeasurementCounter, counter);
  put_raw(frame.bytes, layout::cluster_status::kInterfaceVersion, 1);
  return frame;
}

inline CanFrame object_status(unsigned count, unsigned counter = 17) {
  CanFrame frame{layout::kObjectStatusId, Bytes(4)};
  put_raw(frame.bytes, layout::object_status::kCount, count);
  put_raw(frame.bytes, layout::object_status::kMeasurementCounter, counter);
  return frame;
}

inline CanFrame general(std::uint32_t frame_id, unsigned id, const Target& target) {
  CanFrame frame{frame_id, Bytes(8)};
  const bool cluster = frame_id == layout::kClusterGeneralId;
  put_raw(frame.bytes, layout::kEntryId, id);
  put(frame.bytes, layout::general::kLongitudinal_m, target.x_m);
  put(frame.bytes, cluster ? layout::general::kClusterLateral_m : layout::general::kObjectLateral_m, target.y_m);
  put(frame.bytes, layout::general::kLongitudinalVelocity_mps, target.vx_mps);
  put(frame.bytes, layout::general::kLateralVelocity_mps, target.vy_mps);
  put(frame.bytes, layout::general::kRcs_dbsm, target.rcs_dbsm);
  return frame;
}

inline CanFrame quality(std::uint32_t frame_id, unsigned id, const Target& target) {
  const bool cluster = frame_id == layout::kClusterQualityId;
  CanFrame frame{frame_id, Bytes(cluster ? 5 : 7)};
  put_raw(frame.bytes, layout::kEntryId, id);
  put_raw(frame.bytes, layout::quality::kLongitudinal, target.rms_x);
  put_raw(frame.bytes, layout::quality::kLateral, target.rms_y);
  put_raw(frame.bytes, layout::quality::kLongitudinalVelocity, target.rms_vx);
  put_raw(frame.bytes, layout::quality::kLateralVelocity, target.rms_vy);
  if (cluster) {
    put_raw(frame.bytes, layout::cluster_quality::kFalseAlarm, target.probability);
    put_raw(frame.bytes, layout::cluster_quality::kInvalidState, target.state);
    put_raw(frame.bytes, layout::cluster_quality::kAmbiguityState, target.ambiguity);
  } else {
    put_raw(frame.bytes, layout::object_quality::kExistence, target.probability);
    put_raw(frame.bytes, layout::object_quality::kMeasurementState, target.state);
  }
  return frame;
}

/// A complete cycle of clusters with ids from 0, in the sensor's order.
inline Frames cluster_cycle(const std::vector<Target>& targets, bool with_quality, unsigned counter = 17) {
  Frames frames{cluster_status(static_cast<unsigned>(targets.size()), 0, counter)};
  for (unsigned i = 0; i < targets.size(); ++i) {
    frames.push_back(general(layout::kClusterGeneralId, i, targets[i]));
  }
  for (unsigned i = 0; with_quality && i < targets.size(); ++i) {
    frames.push_back(quality(layout::kClusterQualityId, i, targets[i]));
  }
  return frames;
}

}  // namespace boresight::ingest::ars408_frames
