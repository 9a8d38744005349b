#include "services/common/extended_object/object_classes.hpp"

namespace boresight::extended_object {

namespace {

using M = ObjectClassModel;
/// One value for each class: pedestrian, two-wheeler, car, van, truck.
using Row = std::array<double, kRoadUserClasses>;

template <typename Group>
void set(ObjectClassTable& table, Group M::*group, double Group::*value, const Row& row) {
  for (std::size_t i = 0; i < kRoadUserClasses; ++i) table[i].*group.*value = row[i];
}

// Origins. "§" is a section of radar-statistics.md, "R" and "N" its columns.
// - measured: the value stands there.
// - fit: chosen so that the model, over a mix of traffic, shows the named figures (PublishedFigures in
//   tests/unit/extended_object).
// - boxes: literature, mean sizes of the boxes of nuScenes (Caesar et al. 2020) as detectors publish them for anchors.
// - choice: not measured.

void set_size(ObjectClassTable& t) {
  using S = SizePrior;
  // m, boxes: 0.73, 1.68 (bicycle) … 2.10 (motorcycle), 4.61, 6.7 (truck) … 12.0 (trailer); van choice
  set(t, &M::size, &S::length_mean_m, {0.73, 1.8, 4.6, 5.6, 10.5});
  // m, choice: cars mostly 4.0 … 5.2; trucks 6 … 16.5, the longest in the EU (Directive 96/53/EC)
  set(t, &M::size, &S::length_std_m, {0.2, 0.2, 0.4, 0.6, 3.5});
  // m, boxes: 0.66, 0.60 … 0.76, 1.95 (1.85 without mirrors, choice), 2.46; 2.55 is the widest in the EU; van choice
  set(t, &M::size, &S::width_mean_m, {0.67, 0.7, 1.85, 2.0, 2.5});
  // m, choice
  set(t, &M::size, &S::width_std_m, {0.15, 0.15, 0.1, 0.1, 0.1});
  // m, boxes: 1.76, 1.72 (1.6 with fewer sport utility vehicles, choice), 2.7 … 3.8; two-wheeler with rider, van choice
  set(t, &M::size, &S::height_m, {1.75, 1.7, 1.6, 2.4, 3.3});
}

void set_motion(ObjectClassTable& t) {
  using K = MotionPrior;
  // m/s, choice: walking, cycling, town to main road (R's drives are at 3 … 25)
  set(t, &M::motion, &K::typical_speed_mps, {1.4, 5.0, 13.0, 13.0, 13.0});
  // m/s, choice: running; a moped, or a bicycle downhill; motorway without limit; margin over a truck's limiter at 25
  set(t, &M::motion, &K::largest_speed_mps, {5.0, 15.0, 70.0, 50.0, 32.0});
  // m/s, choice: about the typical speed; 10 worked on the drives of R. Less hides fast objects, more admits clutter
  set(t, &M::motion, &K::birth_speed_std_mps, {1.3, 4.0, 10.0, 10.0, 9.0});
  // 1, m/s, choice: vehicles in jams and at junctions
  set(t, &M::motion, &K::slow_share, {0.0, 0.1, 0.2, 0.2, 0.2});
  set(t, &M::motion, &K::slow_speed_std_mps, {1.3, 1.5, 1.5, 1.5, 1.5});
  // m²/s³, choice: q = σ² · 1 s of accelerations of 0.5, 0.7, 1.4, 1.2, 0.7 m/s². Less is smoother and later in
  // manoeuvres
  set(t, &M::motion, &K::along_acceleration_density_m2ps3, {0.25, 0.5, 2.0, 1.5, 0.5});
  // m²/s³, choice: likewise of 0.5, 0.55, 0.7, 0.6, 0.4 m/s²; pedestrians turn as they brake
  set(t, &M::motion, &K::across_acceleration_density_m2ps3, {0.25, 0.3, 0.5, 0.4, 0.15});
}

void set_count(ObjectClassTable& t) {
  using C = DetectionCount;
  // 1, fit: R §1, means of pedestrian (1.4, 0.9 at 10–20, 20–30 m), two-wheeler (0.75 at 20–50 m), car (3.1 … 0.64 at
  // 10 … 100 m), truck (5.1 … 1.6); van choice
  set(t, &M::count, &C::mean_at_30m, {0.85, 0.85, 1.7, 2.1, 3.0});
  // 1, fit: R §1, slope of the same means; two-wheeler choice, as car; van choice
  set(t, &M::count, &C::range_power, {0.85, 0.8, 0.8, 0.75, 0.65});
  // m, choice: bounds the count beside the sensor
  set(t, &M::count, &C::near_range_m, {8.0, 8.0, 8.0, 8.0, 8.0});
  // 1, fit: R §1, means of 1.3, 4.7, 1.7 from behind, abeam, ahead (car, under 60 m), mostly because objects abeam are
  // nearer; people and cycles choice
  set(t, &M::count, &C::rear_factor, {1.0, 1.0, 0.85, 0.85, 0.85});
  set(t, &M::count, &C::side_factor, {1.0, 1.0, 1.8, 1.8, 1.8});
  set(t, &M::count, &C::front_factor, {1.0, 1.0, 1.05, 1.05, 1.05});
  // 1, fit: R §1, shares without detection of the same objects, 29 and 46, 47, 18 … 53, 6 … 42 %; van choice
  set(t, &M::count, &C::dispersion_shape, {3.0, 8.0, 4.0, 2.5, 1.8});
}

void set_places(ObjectClassTable& t) {
  using P = ReflectionPlaces;
  // 1, fit: N §2, over 0.7 m inside 15 % (car), 43 % (truck); van choice; people and cycles have no faces (choice)
  set(t, &M::places, &P::interior_share, {1.0, 1.0, 0.7, 0.75, 0.9});
  // m, fit: R §2, over 1, 2, 3 m behind the nearest 47, 17, 5 % (car), over 2, 5, 8 m 57, 16, 4 % (truck); rest choice
  set(t, &M::places, &P::decay_m, {1.6, 1.6, 1.6, 2.2, 4.5});
  // m, fit: N §2, median 0.24 … 0.36 of a car; van and truck choice
  set(t, &M::places, &P::face_depth_m, {0.0, 0.0, 0.3, 0.3, 0.3});
  // m, fit: N §2, p10 … p90 of a car less the noise; van and truck choice
  set(t, &M::places, &P::face_depth_std_m, {0.0, 0.0, 0.25, 0.25, 0.3});
  // m, choice: rounded corners
  set(t, &M::places, &P::corner_radius_m, {0.3, 0.3, 0.3, 0.3, 0.3});
  // 1, measured: §7, positions last about 2–3 scans
  set(t, &M::places, &P::scan_correlation, {0.67, 0.67, 0.67, 0.67, 0.67});
  // 1, choice: a scan shows a long vehicle in one spot (R §2: half of the scans 4.2 m or less) or all over
  set(t, &M::places, &P::common_share, {0.0, 0.0, 0.1, 0.2, 0.5});
  // m, choice: a sixth to a quarter of the mean depth
  set(t, &M::places, &P::lasting_std_m, {0.05, 0.1, 0.2, 0.25, 0.5});
}

void set_micro_doppler(ObjectClassTable& t) {
  using D = MicroDoppler;
  // m/s, fit: R §3, robust sd with the radar's noise 0.28 (pedestrian, limbs included), 0.049 (car), 0.037 (truck);
  // rest choice
  set(t, &M::micro_doppler, &D::body_std_mps, {0.22, 0.1, 0.03, 0.03, 0.03});
  // 1 (large_share too) and m/s, fit: R §3, deviations over 0.5, 1, 2 m/s: pedestrian 18, 3.4, 0 %; two-wheeler 1.5,
  // 0.5, 0 % (few); car from behind 2.2, 1.1, 0.4, abeam 24, 11, 3, from ahead 4.0, 2.1, 1.5 %; truck abeam 31, 16, 10
  // %; van as car (choice)
  set(t, &M::micro_doppler, &D::rear_share, {0.35, 0.04, 0.03, 0.03, 0.03});
  set(t, &M::micro_doppler, &D::side_share, {0.35, 0.04, 0.48, 0.48, 0.58});
  set(t, &M::micro_doppler, &D::front_share, {0.35, 0.04, 0.06, 0.06, 0.06});
  set(t, &M::micro_doppler, &D::large_share, {0.0, 0.0, 0.3, 0.3, 0.5});
  set(t, &M::micro_doppler, &D::small_std_mps, {0.6, 0.6, 0.8, 0.8, 0.8});
  // m/s, choice: no deviation at rest
  set(t, &M::micro_doppler, &D::full_speed_mps, {0.5, 1.0, 2.0, 2.0, 2.0});
  // 1, measured: R §3, ratio to the radial speed, median −0.11, p5 … p95 −0.88 … 0.52
  set(t, &M::micro_doppler, &D::ratio_mean, {0.0, 0.0, -0.15, -0.15, -0.15});
  set(t, &M::micro_doppler, &D::ratio_std, {0.0, 0.0, 0.43, 0.43, 0.43});
}

void set_strength(ObjectClassTable& t) {
  using S = RelativeStrength;
  // dB, measured: §4, medians less those of vehicles: pedestrian 0 … −10 (R), −5 (N), two-wheeler −2 … −12 (R), −6 (N).
  // A truck is 3 … 4 dB over a car by R's shares of weak scans, and the level is that of both; van choice
  set(t, &M::strength, &S::mean_db, {-5.0, -8.0, -2.0, 0.0, 2.0});
  // dB, measured: §4, one detection in a range bin 7 … 13 (R)
  set(t, &M::strength, &S::std_db, {7.0, 7.0, 9.0, 9.0, 9.0});
}

}  // namespace

std::string_view name_of(RoadUserClass c) {
  constexpr std::array<std::string_view, kRoadUserClasses> kNames = {"pedestrian", "two_wheeler", "car", "van",
                                                                     "truck"};
  return kNames[static_cast<std::size_t>(c)];
}

ObjectClassTable object_class_table_defaults() {
  ObjectClassTable table{};
  set_size(table);
  set_motion(table);
  set_count(table);
  set_places(table);
  set_micro_doppler(table);
  set_strength(table);
  // 1, choice: near the numbers of boxes in nuScenes (Caesar et al. 2020), which is town; main roads have fewer people
  constexpr Row kPriorShare = {0.2, 0.05, 0.55, 0.05, 0.15};
  for (std::size_t i = 0; i < kRoadUserClasses; ++i) table[i].prior_share = kPriorShare[i];
  return table;
}

}  // namespace boresight::extended_object
