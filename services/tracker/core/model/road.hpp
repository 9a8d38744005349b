// How vehicles drive along the road that the own vehicle drives on: as it does, or against it.
#pragma once

namespace boresight::tracking {

struct RoadParameters {
  double parallel_share = 0.35;    ///< start: of vehicles that drive as the own one does, and as many against it
  double parallel_std_rad = 0.15;  ///< of their headings about that
  double prior_s = 10.0;           ///< weight of the start in seconds of one vehicle
  double memory_s = 20.0;          ///< of what is learnt
};

/// Direction of a velocity.
struct Course {
  double rad = 0.0, variance_rad2 = 0.0;
};

struct Road {
  double heading_rad = 0.0;                       ///< of the own vehicle
  double along_share = 0.0, against_share = 0.0;  ///< of vehicles that drive as it does, and against it
};

/// The course of a moving object given the road, equation (T20): the moments of a mixture of headings along the road,
/// against it, and any other. `vehicle_probability`: that it is no pedestrian.
[[nodiscard]] Course on_road(const RoadParameters& parameters, const Road& road, const Course& course,
                             double vehicle_probability);

/// Learns the shares of vehicles that drive along the road: one step of expectation maximisation for each vehicle.
class ParallelTraffic {
 public:
  explicit ParallelTraffic(const RoadParameters& parameters) : parameters_(parameters) {}

  void clear() { along_s_ = against_s_ = seen_s_ = 0.0; }
  void forget(double elapsed_s);
  /// A vehicle was seen for `time_s` (with the weight of its probability) on this course. Courses that are not known as
  /// well as the road tells do not count: they would confirm the prior by itself.
  void add(const Course& course, double road_heading_rad, double time_s);
  [[nodiscard]] Road road(double heading_rad) const;

 private:
  RoadParameters parameters_;
  double along_s_ = 0.0, against_s_ = 0.0, seen_s_ = 0.0;
};

}  // namespace boresight::tracking
