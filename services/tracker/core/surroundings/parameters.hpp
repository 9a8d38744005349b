// Settings of the stationary surroundings of the vehicle. Equations: docs/algorithms/surroundings.md.
#pragma once

namespace boresight::tracking {

/// Which stationary detections are used, and for how long they are remembered.
struct StationaryParameters {
  double memory_s = 1.0;             ///< of detections
  double least_probability = 0.5;    ///< of being a direct reflection of something stationary
  double behind_m = 10.0;            ///< part of the surroundings that is remembered
  double ahead_m = 80.0;             //
  double aside_m = 18.0;             //
  double lowest_m = -0.5;            ///< height of a detection, where elevation is measured
  double highest_m = 2.5;            ///< above it is a structure that the vehicle passes under
  double mounting_std_rad = 0.0015;  ///< error of all azimuths of a radar that its alignment leaves
  int scans_per_look = 2;            ///< the memory is looked at in each such scan
};

struct RoadEdgeParameters {
  double gate_sigma = 3.0;               ///< detections farther from a line are beside it
  double ahead_m = 40.0;                 ///< detections farther ahead are not used
  double band_half_width_m = 0.4;        ///< of the line, and of the bands beside it with which it is compared
  double cell_m = 2.5;                   ///< length of a segment that is compared with the bands beside it
  double contrast_probability = 0.7;     ///< that a segment of an edge has more detections than both bands beside it
  double cell_memory_s = 2.0;            ///< of the detections of a segment
  double least_cell_detections = 3.0;    ///< a segment with fewer in all three bands does not count
  double prior_log_odds = -5.0;          ///< of an edge at a place
  double start_log_odds = 2.0;           ///< from here on a line is tracked
  double end_log_odds = -1.0;            ///< below it a line is dropped
  double slope_step = 0.02;              ///< of the search about the path
  double curvature_step_per_m = 0.004;   //
  double least_distance_m = 1.2;         ///< from the path: nothing nearer is an edge
  double separation_m = 1.2;             ///< lines of one side that are nearer to each other are one
  double longest_gap_m = 10.0;           ///< between segments of one edge
  double longest_coast_s = 1.0;          ///< without a segment
  double scatter_m = 0.1;                ///< start: standard deviation of reflections across the line
  double scatter_memory_s = 2.0;         ///< of the learnt one
  double least_weight = 0.05;            ///< a detection that is less likely on the line tells nothing of the line
  double repeat_factor = 8.0;            ///< detections of one reflector that count as one measurement of the line
  double offset_density_m2pm = 1e-4;     ///< how the line departs from a parabola, by metre driven
  double slope_density_pm = 1e-6;        //
  double curvature_density_pm3 = 1e-7;   //
  double curvature_rate_std_pm2 = 3e-5;  ///< of roads, per metre: the farther, the less the parabola holds
  double report_existence = 0.9;         ///< below it an edge is not published
  double course_existence = 0.9;         ///< of an edge that tells where the road leads
  double course_beyond_m = 10.0;         ///< it is believed so far beyond its end
};

struct ObstacleParameters {
  double corridor_m = 1.3;  ///< half width about the path within which detections count: the swept path and a margin
  double cluster_radius_m = 1.0;   ///< DBSCAN
  double least_detections = 6.0;   ///< of a cluster in the memory
  double gate_m = 1.3;             ///< detections are an obstacle's up to this distance from its place
  double count = 1.3;              ///< detections of a vehicle in a scan, `count_range_m` away
  double count_range_m = 20.0;     //
  double count_power = 0.6;        ///< by which they become fewer with the range
  double background_count = 0.25;  ///< at least as many of something small that reflects
  double background_factor =
      1.5;  ///< of the usual density in the swept path at that distance: reflectors come in groups
  double background_memory_s = 1.5;     ///< of that density
  double excess_db = 7.0;               ///< strength of a vehicle over the radar's usual stationary detection
  double excess_std_db = 12.0;          ///< of both about their means
  double level_memory_s = 30.0;         ///< of the usual strength
  double level_range_m = 15.0;          ///< width of the range intervals that have a level of their own
  double most_of_scan = 4.0;            ///< log likelihood of a scan at most: its detections have causes in common
  double evidence_share = 0.25;         ///< of a scan's log likelihood: successive scans are not independent
  double prior_log_odds = -3.5;         ///< of an obstacle at a cluster
  double most_log_odds = 6.0;           ///< evidence beyond it is not kept
  double end_log_odds = -8.0;           ///< below it an obstacle is dropped
  double position_density_m2ps = 0.01;  ///< errors of the ego motion
  double centre_std_m = 0.6;            ///< of a detection about the obstacle's centre
  double extent_memory_s = 1.0;         ///< of the extent
  double life_s = 1.5;                  ///< without detections
  int looks_per_search = 3;             ///< new obstacles are looked for in each such look at the memory
};

struct CollisionParameters {
  double front_m = 3.8;                     ///< outline of the vehicle: rear axle to front
  double width_m = 1.9;                     //
  double lateral_jerk_density_m2ps5 = 0.3;  ///< what the driver's steering may change
  double road_share = 0.5;                  ///< of drivers that follow the road; the others keep their circle
  double lane_std_m = 0.4;                  ///< of a vehicle that follows the road about its place in the lane
  double least_speed_mps = 1.0;             ///< below it nothing is warned of
  double horizon_s = 6.0;                   ///< objects that are reached later are not listed
  double warning_time_s = 2.7;              ///< a warning is given only if the object is reached sooner
  double warning_probability = 0.35;        ///< and the vehicle meets it with this probability
  double oncoming_probability = 0.95;       ///< or with this one if it comes towards the vehicle
  double oncoming_speed_mps = 2.0;          ///< along the path, from which on it does
  double warning_deceleration_mps2 = 1.5;   ///< and braking must be at least this hard
  double warning_lateral_mps2 = 0.45;       ///< and steering past it, too
  double hold_s = 0.15;                     ///< and all that lasts: of a track
  double obstacle_hold_s = 0.5;             ///< and of an obstacle, which stands for longer
  double least_existence = 0.75;            ///< of an object that is warned of
  double report_probability = 0.05;         ///< objects that are met less likely are not listed
};

struct SurroundingsParameters {
  StationaryParameters stationary;
  RoadEdgeParameters road_edge;
  ObstacleParameters obstacle;
  CollisionParameters collision;
};

}  // namespace boresight::tracking
