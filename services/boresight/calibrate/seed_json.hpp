// A seed of the dynamic estimator as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/boresight/json/text.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::calibrate {

/// Radar, rotation vector in vehicle axes (degrees) and its covariance (deg², row-major).
inline json::Value object_of(const alignment::RotationSeed& seed) {
  json::Value object;
  object["radar"] = seed.radar_id;
  json::Value& rotation = object["rotation_vehicle_deg"] = json::Value::array();
  for (const double angle : seed.rotation_vehicle_rad) rotation.push_back(json::significant(angle * kDegreesPerRadian));
  json::Value& covariance = object["covariance_deg2"] = json::Value::array();
  for (Eigen::Index i = 0; i < 9; ++i) {
    covariance.push_back(json::significant(seed.covariance(i / 3, i % 3) * kDegreesPerRadian * kDegreesPerRadian));
  }
  return object;
}

}  // namespace boresight::calibrate
