// Numbers of the classical chain: clusters, gates, start, confirmation and end of a track, motion by class.
#pragma once

#include <array>
#include <cstddef>

#include "services/common/extended_object/object_classes.hpp"
#include "services/tracker/core/classical/heading/doppler_heading.hpp"
#include "services/tracker/core/classical/heading/heading.hpp"
#include "services/tracker/core/classical/heading/l_shape.hpp"
#include "services/tracker/core/classical/looks.hpp"
#include "services/tracker/core/filters/motion_filter.hpp"

namespace boresight::tracking::classical {

/// One value for each class: pedestrian, two_wheeler, car, van, truck.
template <typename Value>
using ByClass = std::array<Value, extended_object::kRoadUserClasses>;

struct ClusterParameters {
  double radius_m = 2.5;            ///< detections of one cluster are linked within it
  double range_rate_gap_mps = 1.0;  ///< a gap in the range rates of a cluster that divides it
  double least_weight = 0.1;        ///< of a core point's neighbourhood: sum of the probabilities of being moving
};

struct GateParameters {
  double place_chi2 = 13.816;      ///< squared distance of a place, two degrees of freedom: 0.999
  double range_rate_chi2 = 10.83;  ///< squared distance of a range rate, one degree of freedom: 0.999
};

struct StartParameters {
  int points = 1;              ///< detections of a cluster that begins a track
  double strength_db = -30.0;  ///< least mean strength over the radar's usual detection
  double existence = 0.005;    ///< least probability that the cluster is an object or a lasting source
};

/// Rules of a track's life; a look is a scan of a radar that should detect the object.
struct LifeParameters {
  ByClass<int> confirm_hits{3, 3, 3, 3, 3};          ///< m: hits that confirm …
  ByClass<int> confirm_looks{5, 5, 5, 5, 5};         ///< … of n looks
  ByClass<int> delete_misses{32, 32, 32, 32, 32};    ///< k: misses that end a track …
  ByClass<int> delete_looks{32, 32, 32, 32, 32};     ///< … of t looks
  ByClass<double> coast_s{3.0, 3.0, 3.0, 3.0, 3.0};  ///< longest prediction without a detection
  double least_detection_probability = 0.5;          ///< of a scan that is a look
  double least_existence = 0.003;                    ///< a track below it ends
};

struct MotionNoise {
  ByClass<double> jerk_density_m2ps5{0.5, 1.0, 2.0, 2.0, 1.0};   ///< of white jerk
  ByClass<double> acceleration_time_s{1.0, 1.0, 1.0, 1.0, 1.0};  ///< accelerations fade with it (Singer 1970)
  double first_acceleration_std_mps2 = 1.0;                      ///< of a new track
};

struct HeadingParameters {
  double history_s = 0.5;       ///< detections that are older do not count
  double known_std_rad = 0.35;  ///< of a course by which the outline tells its long side
  DopplerParameters doppler;
  ShapeParameters shape;
};

struct Parameters {
  filters::FilterKind filter = filters::FilterKind::kKalman;
  ClusterParameters cluster;
  GateParameters gate;
  StartParameters start;
  LifeParameters life;
  MotionNoise motion;
  HeadingParameters heading;
  double join_existence = 0.95;    ///< tracks above it may be parts of one object
  double report_existence = 0.02;  ///< tracks below it are not reported
};

}  // namespace boresight::tracking::classical
