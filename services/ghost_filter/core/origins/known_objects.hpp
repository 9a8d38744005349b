// The tracks of the step before, predicted to a scan, as sources of detections.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/extended_object/reflection_model.hpp"
#include "services/ghost_filter/core/evidence/config.hpp"

namespace boresight::ghosts {

/// Normal densities beyond are next to nothing.
inline constexpr double kReachStds = 3.0;

/// An object in the vehicle frame of the scan, velocities over ground.
struct KnownObject {
  extended_object::ObservedObject observed;
  extended_object::RoadUserClass road_user = extended_object::RoadUserClass::kCar;
  Eigen::Matrix2d position_covariance_m2 = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d velocity_covariance_m2ps2 = Eigen::Matrix2d::Zero();
  double existence = 0.0;  ///< 0…1
  /// Added to the range rate over ground that the velocity gives: of a path that is not straight.
  double range_rate_offset_mps = 0.0;
};

/// A detection as the intensities need it.
struct SeenDetection {
  Eigen::Vector2d position_m{0.0, 0.0};  ///< vehicle frame
  Eigen::Vector2d direction{1.0, 0.0};   ///< of the line of sight, unit
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  double range_m = 0.0;
  double range_rate_mps = 0.0;  ///< over ground
  double range_rate_variance_m2ps2 = 0.0;
  double reach_m = 0.0;  ///< farther from a box it is not of that object
};

/// Tracks predicted by `elapsed_s` with constant velocity, into the vehicle frame after the ego motion of that time.
/// Tracks that are not finite are left out. `objects` keeps its capacity.
void predict_objects(const TrackList& tracks, double elapsed_s, const ScanGeometry& geometry,
                     std::vector<KnownObject>& objects);

/// Farther from the object's box its density of places is next to nothing, by the covariance of the prediction.
[[nodiscard]] double reach_m(const KnownObject& object, const IntensityConfig& config);

/// Expected detections of an object in one scan at a place and range rate, per m² and m/s, times its existence:
///
///     (G3)   n · p(place | box) · ((1 − a) p(range rate | velocity) + a / W),
///
/// n, both densities: extended_object; a, W: share and width of the object's Doppler-ambiguous detections. An image of
/// such a detection is rarer still: a = 0.
class ObjectIntensity {
 public:
  ObjectIntensity(const KnownObject& object, bool is_image, const Eigen::Vector2d& sensor_m,
                  const extended_object::ObjectClassTable& classes, const IntensityConfig& config);
  /// Whether the detection is near enough to its box for an intensity.
  [[nodiscard]] bool reaches(const SeenDetection& detection) const {
    const Eigen::Vector2d offset = (to_box_ * (detection.position_m - object_->observed.box.centre_m)).cwiseAbs();
    return (offset - half_size_m_).maxCoeff() < reach_m_ + detection.reach_m;
  }
  /// Equation (G3) times the existence.
  [[nodiscard]] double at(const SeenDetection& detection) const;

 private:
  const KnownObject* object_;
  const extended_object::ObjectClassModel* model_;
  const IntensityConfig* config_;
  Eigen::Matrix2d to_box_, position_covariance_m2_;
  Eigen::Vector2d half_size_m_;
  double ambiguous_share_, reach_m_, speed_mps_, expected_;
  extended_object::ReflectionMixture places_;
};

}  // namespace boresight::ghosts
