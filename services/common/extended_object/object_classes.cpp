#include "services/common/extended_object/object_classes.hpp"

namespace boresight::extended_object {

namespace {

using M = ObjectClassModel;
using S = SizePrior;
using K = MotionPrior;
using C = DetectionCount;
using P = ReflectionPlaces;
using D = MicroDoppler;
using R = RelativeStrength;

template <auto kGroup, auto kValue>
double& at(M& model) {
  return model.*kGroup.*kValue;
}

double& prior_share(M& model) {
  return model.prior_share;
}

}  // namespace

std::span<const ObjectClassField> object_class_fields() {
  // Section, key, allowed range, and the defaults of pedestrian, two-wheeler, car, van, truck.
  static constexpr ObjectClassField kFields[] = {
      {"", "prior_share", 1e-6, 1.0, {0.2, 0.05, 0.55, 0.05, 0.15}, prior_share},
      {"size", "length_mean_m", 0.1, 30.0, {0.73, 1.8, 4.6, 5.6, 11.0}, at<&M::size, &S::length_mean_m>},
      {"size", "length_std_m", 0.01, 10.0, {0.2, 0.2, 0.4, 0.6, 4.5}, at<&M::size, &S::length_std_m>},
      {"size", "width_mean_m", 0.1, 5.0, {0.67, 0.7, 1.85, 2.0, 2.5}, at<&M::size, &S::width_mean_m>},
      {"size", "width_std_m", 0.01, 2.0, {0.15, 0.15, 0.1, 0.1, 0.1}, at<&M::size, &S::width_std_m>},
      {"size", "height_m", 0.1, 6.0, {1.75, 1.7, 1.6, 2.4, 3.3}, at<&M::size, &S::height_m>},
      {"motion", "typical_speed_mps", 0.1, 100.0, {1.4, 5.0, 13.0, 13.0, 13.0}, at<&M::motion, &K::typical_speed_mps>},
      {"motion", "largest_speed_mps", 0.1, 150.0, {5.0, 15.0, 70.0, 50.0, 32.0}, at<&M::motion, &K::largest_speed_mps>},
      {"motion",
       "birth_speed_std_mps",
       0.1,
       100.0,
       {1.3, 4.0, 10.0, 10.0, 9.0},
       at<&M::motion, &K::birth_speed_std_mps>},
      {"motion", "slow_share", 0.0, 1.0, {0.0, 0.1, 0.2, 0.2, 0.2}, at<&M::motion, &K::slow_share>},
      {"motion", "slow_speed_std_mps", 0.1, 100.0, {1.3, 1.5, 1.5, 1.5, 1.5}, at<&M::motion, &K::slow_speed_std_mps>},
      {"motion",
       "along_acceleration_density_m2ps3",
       1e-4,
       100.0,
       {0.25, 0.5, 2.0, 1.5, 0.5},
       at<&M::motion, &K::along_acceleration_density_m2ps3>},
      {"motion",
       "across_acceleration_density_m2ps3",
       1e-4,
       100.0,
       {0.25, 0.3, 0.5, 0.4, 0.15},
       at<&M::motion, &K::across_acceleration_density_m2ps3>},
      {"count", "mean_at_30m", 0.01, 100.0, {0.85, 0.85, 1.7, 2.1, 3.0}, at<&M::count, &C::mean_at_30m>},
      {"count", "range_power", 0.0, 4.0, {0.85, 0.8, 0.8, 0.75, 0.65}, at<&M::count, &C::range_power>},
      {"count", "near_range_m", 0.1, 100.0, {8.0, 8.0, 8.0, 8.0, 8.0}, at<&M::count, &C::near_range_m>},
      {"count", "rear_factor", 0.01, 100.0, {1.0, 1.0, 0.85, 0.85, 0.85}, at<&M::count, &C::rear_factor>},
      {"count", "side_factor", 0.01, 100.0, {1.0, 1.0, 1.8, 1.8, 1.8}, at<&M::count, &C::side_factor>},
      {"count", "front_factor", 0.01, 100.0, {1.0, 1.0, 1.05, 1.05, 1.05}, at<&M::count, &C::front_factor>},
      {"count", "dispersion_shape", 0.1, 100.0, {3.0, 8.0, 4.0, 2.5, 1.8}, at<&M::count, &C::dispersion_shape>},
      {"places", "interior_share", 0.0, 1.0, {1.0, 1.0, 0.7, 0.75, 0.9}, at<&M::places, &P::interior_share>},
      {"places", "decay_m", 0.05, 100.0, {1.6, 1.6, 1.6, 2.2, 4.5}, at<&M::places, &P::decay_m>},
      {"places", "face_depth_m", 0.0, 5.0, {0.0, 0.0, 0.3, 0.3, 0.3}, at<&M::places, &P::face_depth_m>},
      {"places", "face_depth_std_m", 0.0, 5.0, {0.0, 0.0, 0.25, 0.25, 0.3}, at<&M::places, &P::face_depth_std_m>},
      {"places", "corner_radius_m", 0.01, 5.0, {0.3, 0.3, 0.3, 0.3, 0.3}, at<&M::places, &P::corner_radius_m>},
      {"places", "scan_correlation", 0.0, 0.99, {0.67, 0.67, 0.67, 0.67, 0.67}, at<&M::places, &P::scan_correlation>},
      {"places", "common_share", 0.0, 1.0, {0.0, 0.0, 0.1, 0.2, 0.5}, at<&M::places, &P::common_share>},
      {"places", "lasting_std_m", 0.0, 5.0, {0.05, 0.1, 0.2, 0.25, 0.5}, at<&M::places, &P::lasting_std_m>},
      {"micro_doppler",
       "body_std_mps",
       0.001,
       5.0,
       {0.22, 0.1, 0.03, 0.03, 0.03},
       at<&M::micro_doppler, &D::body_std_mps>},
      {"micro_doppler", "rear_share", 0.0, 0.99, {0.35, 0.04, 0.03, 0.03, 0.03}, at<&M::micro_doppler, &D::rear_share>},
      {"micro_doppler", "side_share", 0.0, 0.99, {0.35, 0.04, 0.48, 0.48, 0.58}, at<&M::micro_doppler, &D::side_share>},
      {"micro_doppler",
       "front_share",
       0.0,
       0.99,
       {0.35, 0.04, 0.06, 0.06, 0.06},
       at<&M::micro_doppler, &D::front_share>},
      {"micro_doppler", "large_share", 0.0, 0.99, {0.0, 0.0, 0.3, 0.3, 0.5}, at<&M::micro_doppler, &D::large_share>},
      {"micro_doppler",
       "small_std_mps",
       0.01,
       10.0,
       {0.6, 0.6, 0.8, 0.8, 0.8},
       at<&M::micro_doppler, &D::small_std_mps>},
      {"micro_doppler",
       "full_speed_mps",
       0.01,
       30.0,
       {0.5, 1.0, 2.0, 2.0, 2.0},
       at<&M::micro_doppler, &D::full_speed_mps>},
      {"micro_doppler",
       "ratio_mean",
       -5.0,
       5.0,
       {0.0, 0.0, -0.15, -0.15, -0.15},
       at<&M::micro_doppler, &D::ratio_mean>},
      {"micro_doppler", "ratio_std", 0.0, 5.0, {0.0, 0.0, 0.43, 0.43, 0.43}, at<&M::micro_doppler, &D::ratio_std>},
      {"strength", "mean_db", -50.0, 50.0, {-5.0, -8.0, -2.0, 0.0, 2.0}, at<&M::strength, &R::mean_db>},
      {"strength", "std_db", 0.1, 50.0, {7.0, 7.0, 9.0, 9.0, 9.0}, at<&M::strength, &R::std_db>},
  };
  return kFields;
}

std::string_view name_of(RoadUserClass c) {
  constexpr std::array<std::string_view, kRoadUserClasses> kNames = {"pedestrian", "two_wheeler", "car", "van",
                                                                     "truck"};
  return kNames[static_cast<std::size_t>(c)];
}

ObjectClassTable object_class_table_defaults() {
  ObjectClassTable table{};
  for (const ObjectClassField& field : object_class_fields()) {
    for (std::size_t i = 0; i < kRoadUserClasses; ++i) field.value_of(table[i]) = field.defaults[i];
  }
  return table;
}

}  // namespace boresight::extended_object
