// Numbers of the radar model. Levels that differ from radar to radar are learnt; these are where learning starts.
#pragma once

#include <array>

#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/model/box_estimator.hpp"

namespace boresight::tracking {

struct DetectionParameters {
  double detection_probability = 0.95;  ///< of an object in view (measured: radar-statistics R)
  double view_edge_rad = 0.06;          ///< softness of the edges of the field of view
  double range_edge_m = 2.0;
  double stationary_sigma = 4.0;         ///< what deviates less from a stationary reflector looks like one
  double motion_std_mps = 0.05;          ///< of the sensor's own velocity, in that test
  double body_range_rate_std_mps = 0.3;  ///< of an object's parts whose heading is not known, beside the sensor's noise
  double spread = 0.25;                  ///< covariance of reflections relative to the extent
  double held_factor = 5.0;  ///< places of reflections are held for some scans: their mean is that much worse
  double count = 1.5;        ///< mean detections a scan at `count_range_m`
  double count_shape = 2.0;  ///< of the gamma over objects
  double count_range_m = 30.0;
  double count_least = 0.3, count_most = 3.0;  ///< bounds of the mean relative to that at `count_range_m`
  double count_power = 0.8;                    ///< the mean falls with range^−power
};

/// Undetected objects of one kind of motion: density, and each component of the velocity.
struct BirthKind {
  double density_per_m2 = 1e-5;
  double speed_std_mps = 10.0;
  bool with_traffic = false;  ///< about the own vehicle's velocity instead of about zero
};

struct BirthParameters {
  BirthKind slow{3e-6, 1.5, false};              ///< people
  BirthKind any{2e-5, 10.0, false};              ///< vehicles of all directions
  BirthKind traffic{2e-5, 4.0, true};            ///< vehicles that drive as the own one
  double extent_dof = 9.0;                       ///< of a new object's inverse Wishart: how sure its extent is
  double half_length_m = 1.5;                    ///< of a new object
  double place_std_m = 30.0;                     ///< of a new object before its detections: wide against its cell
  double gap_along_m = 1.0, gap_across_m = 0.5;  ///< no other object is nearer to the box of one
  double headway_s = 0.5;                        ///< few drivers keep a shorter one …
  double close_share = 0.03;                     ///< … this share of them
  double person_m = 0.6;                         ///< the same of objects whose heading is not known, in any direction
  double neighbour_density_per_m2 = 5e-3;        ///< of other vehicles about a vehicle
  double company_density_per_m2 = 0.1;           ///< of other people about a person
  double neighbour_speed_std_mps = 1.5;          ///< of each component of their velocities about its own
  double part_odds = 10.0;       ///< from here on two objects are one: a lost object costs more than a double one
  double same_speed_chi2 = 9.0;  ///< squared distance of velocities up to which two objects move alike
  double link_distance_m = 2.5;  ///< detections of one new object are nearer
  double link_range_rate_mps = 1.0;
};

struct ClutterParameters {
  double memory_s = 3.0;     ///< of the learnt intensity
  double table_scans = 4.0;  ///< weight of the starting table
  // The starting table: intensity between edges of the range, times a factor between edges of the |range rate|.
  std::array<double, 4> table_range_edges_m{10.0, 25.0, 50.0, 75.0};            ///< from 0 to the largest range
  std::array<double, 5> table_by_range{1.6e-4, 9e-5, 3.5e-5, 1.2e-5, 6e-6};     ///< per m² and m/s
  std::array<double, 6> table_rate_edges_mps{1.0, 2.0, 5.0, 10.0, 20.0, 60.0};  ///< from 0
  std::array<double, 6> table_by_rate{4.9, 4.9, 2.3, 1.1, 1.1, 0.3};
  double least_range_rate_mps = 0.3;  ///< over ground: slower detections are classified as stationary
  double pace_mps = 1.0;              ///< largest |measured range rate| of an echo that keeps pace
  double pace_over_ground_mps = 2.0;  ///< and its least one over ground: else the own vehicle hardly moves
  double pace_cell_m = 10.0;          ///< size along the range of a cell of such echoes
  double with_ego_factor = 8.0;       ///< start level of echoes that keep pace with the own vehicle
  double origin_offset = -0.8;        ///< added to the ghost filter's log-likelihood ratio
  double origin_weight = 1.5;         ///< of the ghost filter's log-likelihood ratio of a moving object's detection
  double origin_limit = 10.0;         ///< largest magnitude of this ratio that counts: evidence must saturate
  double level_memory_s = 10.0;       ///< of the radar's strength, and of its share of wide range rates
};

struct SourceParameters {
  double share = 0.15;                        ///< of clutter that comes from sources that last
  double life_s = 0.3;                        ///< of such a source
  double wander_m = 0.3;                      ///< of its place about that which its motion predicts
  double more = 0.25;                         ///< chance of one more detection of it in a scan
  double lasting_share = 0.05;                ///< of these sources that last as long as objects
  double other_radar = 0.3;                   ///< chance that another radar detects the source, too
  double side_lobes = 1.5;                    ///< detections a scan that an object gives at other azimuths
  double parent_existence = 0.5;              ///< objects below it have neither side lobes nor wide range rates
  double side_lobe_range_std_m = 1.0;         ///< of a side lobe's range about its object's
  double side_lobe_range_rate_std_mps = 0.4;  ///< of a side lobe's range rate about its object's
  double side_lobe_nearest_m = 3.0;           ///< at nearer objects the ring of side lobes is no shorter
  double side_lobe_chi2 = 9.0;                ///< squared distance up to which a detection may be a side lobe
  double main_lobe_rad = 0.07;                ///< half its width: side lobes are beside it
  double side_lobe_least_deviations = 2.5;    ///< nearer to the object, in its own deviations, detections are its own
  double ambiguity_share = 0.04;              ///< of an object's detections that have a wrong Doppler ambiguity
  double ambiguity_width_mps = 100.0;         ///< their range rates are anywhere in so much
  double wide_chi2 = 9.0;                     ///< squared deviation of a range rate that is not the body's
  double wide_prior = 2.0;                    ///< expected detections that the table's level of these counts as
  double side_lobe_birth = 0.1;               ///< of these that begin a source which lasts
  double side_lobe_shape = 0.5;               ///< of the gamma of lasting side lobes over objects: few give most
  double side_lobe_strength_db = -13.0;       ///< of a side lobe over its object
  double side_lobe_strength_std_db = 10.0;
  double object_strength_std_db = 7.0;  ///< of mean strengths over objects
  double strength_std_db = 7.5;         ///< of one detection about the object's mean
  double strength_memory_s = 3.0;       ///< of an object's mean strength
};

struct RadarModelParameters {
  DetectionParameters detection;
  BirthParameters birth;
  ClutterParameters clutter;
  SourceParameters source;
  BoxParameters box;
  extended_object::ObjectClassTable classes = extended_object::object_class_table_defaults();
  MotionParameters motion{2.0, 1.0, 1.0, 2.0, 8.0};
  double object_life_s = 8.0;  ///< mean time that an object stays in the scene
  double longest_gap_s = 2.0;  ///< after a longer one all tracks are dropped
  double latest_scan_s = 0.3;  ///< a scan that is later than this is a jump of the clock
};

}  // namespace boresight::tracking
