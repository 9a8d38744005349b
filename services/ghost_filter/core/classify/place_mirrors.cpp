#include "services/ghost_filter/core/classify/place_mirrors.hpp"

#include <algorithm>
#include <cmath>

#include "services/ghost_filter/core/classify/mirror_trials.hpp"
#include "services/ghost_filter/core/density/normal.hpp"

namespace boresight::ghosts {

namespace {

constexpr double kLengthStd_m = 0.6;  // of a track's length
constexpr double kUnseenEnd_m = 0.5;  // a flank's far corner does not look to the sensor
constexpr double kIntact = 0.8;       // share of long vehicles whose faces mirror
constexpr double kLeastLong = 0.25;   // probability of being long enough, from which on sides are thought of as mirrors
constexpr double kVans = 0.2;         // share of vehicles that mirror: vans, trucks
constexpr double kLeastVehicle_m = 3.0;  // what is shorter has no end that mirrors
constexpr double kLeastVan_m = 3.75;     // a van alongside may be tracked with this length
/// Where only the end is seen, cosine of the angle to the axis, the length is not; farther away few rays meet an end.
constexpr double kAlongAxis = 0.97, kFarEnd_m = 25.0;

void add_reflectors(std::span<const Reflector> reflectors, const Odometry& odometry, double doubt,
                    std::vector<Mirror>& mirrors) {
  for (const Reflector& r : reflectors) {
    Mirror m;
    m.curve = {odometry.point_to_vehicle(r.curve.origin_m), odometry.vector_to_vehicle(r.curve.tangent),
               r.curve.curvature_per_m};
    m.covariance = r.covariance;
    m.covariance(0, 0) += 0.03 * 0.03;  // a rail is not a line
    m.begin_m = r.begin_m();
    m.end_m = r.end_m();
    const double age_s = static_cast<double>(odometry.now_ns() - r.born_ns) * 1e-9;
    const double is_none = 1.0 / (1.0 + std::exp(r.mirrors + mirrors_by_length(r.length_m(), age_s)));
    m.existence = r.existence() * (1.0 - doubt * is_none);
    m.occupancy = &r.occupancy;
    m.arc_shift_m = r.arc_shift_m;
    m.hidden_before_m = r.hidden_before_m;
    m.hidden_after_m = r.hidden_after_m;
    mirrors.push_back(m);
  }
}

void add_sides(std::span<const Object> objects, const Eigen::Vector2d& sensor_m, double min_length_m,
               std::vector<Mirror>& mirrors) {
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const Object& o = objects[i];
    const double length_m = 2.0 * o.half_length_m;
    const double may_be_long = below((length_m - min_length_m) / kLengthStd_m);
    // How long a vehicle is shows late, and alongside, where its flank has no range rate, hardly: what may be a van is
    // one as often as vans are.
    const Eigen::Vector2d sight = o.position_m - sensor_m;
    const bool is_near = sight.squaredNorm() < kFarEnd_m * kFarEnd_m;
    const double is_long = is_near && length_m > kLeastVan_m ? std::max(may_be_long, kVans)
                           : may_be_long < kLeastLong        ? 0.0
                                                             : may_be_long;
    // From behind or from ahead it is not seen at all.
    const bool may_be_van =
        length_m > kLeastVehicle_m && is_near && std::abs(sight.dot(o.axis)) > kAlongAxis * sight.norm();
    const double has_end = may_be_van ? std::max(is_long, kVans) : is_long;
    if (o.own || o.weight < 0.5 || has_end <= 0.0) continue;
    const Eigen::Vector2d left(-o.axis.y(), o.axis.x());
    const auto add_side = [&](const Eigen::Vector2d& along, double half, const Eigen::Vector2d& across, double depth,
                              double beyond_m, double is_mirror) {
      const double side = across.dot(sensor_m - o.position_m);
      if (std::abs(side) <= depth || mirrors.size() == mirrors.capacity()) return;
      Mirror m;
      m.curve = {o.position_m + std::copysign(depth, side) * across, along, 0.0};
      m.covariance =
          Eigen::Vector3d(0.2 * 0.2 + across.dot(o.position_covariance * across), 0.04 * 0.04, 0.0).asDiagonal();
      m.begin_m = -half - beyond_m;
      m.end_m = half + beyond_m;
      const double odds = kIntact * is_mirror / (1.0 - kIntact * is_mirror) * std::exp(o.mirrors);
      m.existence = o.weight * odds / (1.0 + odds);
      m.velocity_mps = o.velocity_mps;
      m.body = i;
      mirrors.push_back(m);
    };
    if (is_long > 0.0) add_side(o.axis, o.half_length_m, left, o.half_width_m, kUnseenEnd_m, is_long);
    add_side(left, o.half_width_m, o.axis, o.half_length_m, 0.0, has_end);
  }
}

}  // namespace

void place_mirrors(std::span<const Reflector> reflectors, const Odometry& odometry, std::span<const Object> objects,
                   const Eigen::Vector2d& sensor_m, const ClassConfig& config, std::vector<Mirror>& mirrors) {
  mirrors.clear();
  add_reflectors(reflectors, odometry, config.mirror_doubt, mirrors);
  add_sides(objects, sensor_m, config.min_mirror_length_m, mirrors);
  for (Mirror& m : mirrors) {
    m.least_range_m = std::abs(m.curve.distance(sensor_m));
    m.beam = Beam(m, sensor_m);
  }
}

}  // namespace boresight::ghosts
