// What a road user of a class is like, before and as a radar detects it: the single table of numbers for tracker, ghost
// filter and judge. The shipped values and their origin stand in config/services/object_classes.toml.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace boresight::extended_object {

enum class RoadUserClass : std::uint8_t { kPedestrian, kTwoWheeler, kCar, kVan, kTruck };
inline constexpr std::size_t kRoadUserClasses = 5;

/// Length and width are independent within a class.
struct SizePrior {
  double length_mean_m = 0.0, length_std_m = 0.0;
  double width_mean_m = 0.0, width_std_m = 0.0;
  double height_m = 0.0;
};

struct MotionPrior {
  double typical_speed_mps = 0.0;
  double largest_speed_mps = 0.0;
  double birth_speed_std_mps = 0.0;               ///< of each component of the velocity of a newly appearing one
  double slow_share = 0.0;                        ///< of its objects: in a jam, at a junction
  double slow_speed_std_mps = 1.0;                ///< of theirs
  double along_acceleration_density_m2ps3 = 0.0;  ///< q of white acceleration along the heading
  double across_acceleration_density_m2ps3 = 0.0;
};

/// Number of detections in one scan of one radar, none included: a gamma-Poisson distribution.
struct DetectionCount {
  double mean_at_30m = 0.0;                                         ///< over all aspects
  double range_power = 0.0;                                         ///< the mean falls by range^−power
  double near_range_m = 0.0;                                        ///< and grows no more within this range
  double rear_factor = 1.0, side_factor = 1.0, front_factor = 1.0;  ///< of the mean, as seen from behind, abeam, ahead
  double dispersion_shape = 0.0;  ///< of the gamma; variance / mean = 1 + mean / shape
};

/// Places of reflections on the body.
struct ReflectionPlaces {
  double interior_share = 0.0;    ///< of the reflections: anywhere in the box, not on a face
  double decay_m = 0.0;           ///< distance behind the near end over which reflections become fewer by e
  double face_depth_m = 0.0;      ///< mean depth of a reflection on a face
  double face_depth_std_m = 0.0;  ///< about that mean
  double corner_radius_m = 0.0;   ///< a face comes into view while the sensor passes twice this distance
  double scan_correlation = 0.0;  ///< of one reflection's place, from a scan to the next one 75 ms later
  double common_share = 0.0;      ///< of their variance that all reflections of one scan have in common
  double lasting_std_m = 0.0;     ///< of an object's own mean depth about that of its class
};

/// Range rates of parts that move against the body.
struct MicroDoppler {
  double body_std_mps = 0.0;                                     ///< of reflections on the body itself
  double rear_share = 0.0, side_share = 0.0, front_share = 0.0;  ///< of moving parts, from behind, abeam, ahead
  double large_share = 0.0;                                      ///< of these: in proportion to the body's range rate
  double small_std_mps = 0.0;                                    ///< of the others about the body, at speed
  double full_speed_mps = 1.0;               ///< at this speed over ground √½ of that std is reached
  double ratio_mean = 0.0, ratio_std = 0.0;  ///< deviation / range rate of the body over ground, of the large ones
};

/// RCS of one detection relative to the level that the radar reports for vehicles at that range. There is no absolute
/// level: each radar has its own scale.
struct RelativeStrength {
  double mean_db = 0.0, std_db = 0.0;
};

struct ObjectClassModel {
  SizePrior size;
  MotionPrior motion;
  DetectionCount count;
  ReflectionPlaces places;
  MicroDoppler micro_doppler;
  RelativeStrength strength;
  double prior_share = 0.0;  ///< among road users; the shares of a table sum to 1
};

using ObjectClassTable = std::array<ObjectClassModel, kRoadUserClasses>;

[[nodiscard]] constexpr const ObjectClassModel& model_of(const ObjectClassTable& table, RoadUserClass c) {
  return table[static_cast<std::size_t>(c)];
}

/// "pedestrian", "two_wheeler", "car", "van", "truck": the order of values in configuration files.
[[nodiscard]] std::string_view name_of(RoadUserClass c);

/// One number of the table, as configuration names it.
struct ObjectClassField {
  std::string_view section, key;  ///< no section: at the top. Fields of a section stand together
  double least, greatest;         ///< allowed values
  std::array<double, kRoadUserClasses> defaults;
  double& (*value_of)(ObjectClassModel& model);
};
[[nodiscard]] std::span<const ObjectClassField> object_class_fields();

/// The table that the product ships.
[[nodiscard]] ObjectClassTable object_class_table_defaults();

}  // namespace boresight::extended_object
