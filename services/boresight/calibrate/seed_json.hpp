// A seed of the dynamic estimator as JSON.
#pragma once

#include <cmath>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/boresight/align/json_writer.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::calibrate {

/// Key `seed`: radar, rotation vector in vehicle axes (degrees) and its covariance (deg², row-major).
inline void write_seed(align::JsonWriter& json, const alignment::RotationSeed& seed) {
  json.key("seed").begin_object().field("radar", std::uint64_t{seed.radar_id});
  json.key("rotation_vehicle_deg").begin_array();
  for (const double angle : seed.rotation_vehicle_rad) json.value(angle * kDegreesPerRadian);
  json.end_array().key("covariance_deg2").begin_array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      json.value(seed.covariance(row, column) * kDegreesPerRadian * kDegreesPerRadian);
    }
  }
  json.end_array().end_object();
}

}  // namespace boresight::calibrate
