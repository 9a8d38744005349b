#include "tests/benchmarks/tracking/surroundings/judge/warning_judge.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace boresight::bench::surroundings {

namespace {

constexpr double kLookStep_s = 0.05;  // of the extrapolation
constexpr double kCheck_s = 0.1;      // between looks for the shortest time
constexpr double kReach_m = 200.0;    // bodies farther away are not met within the horizon

struct Box {
  Eigen::Vector2d centre_m;
  double heading_rad, length_m, width_m;
};

/// By the four directions of the sides (separating axes).
bool overlap(const Box& a, const Box& b) {
  const Eigen::Vector2d apart = b.centre_m - a.centre_m;
  for (const double heading : {a.heading_rad, a.heading_rad + 0.5 * M_PI, b.heading_rad, b.heading_rad + 0.5 * M_PI}) {
    const Eigen::Vector2d axis(std::cos(heading), std::sin(heading));
    double reach = 0.0;
    for (const Box* const box : {&a, &b}) {
      reach += 0.5 * box->length_m * std::abs(std::cos(box->heading_rad - heading)) +
               0.5 * box->width_m * std::abs(std::sin(box->heading_rad - heading));
    }
    if (std::abs(axis.dot(apart)) > reach) return false;
  }
  return true;
}

}  // namespace

std::optional<double> time_to_contact_s(const simulator::Drive& drive, double t_s) {
  const simulator::EgoState ego = drive.ego(t_s);
  const simulator::EgoSpec& spec = drive.scenario().ego;
  const simulator::Road& road = drive.world().road();
  const simulator::RoadPoint here = road.at(ego.arc_m);
  const Eigen::Vector2d left(-std::sin(here.heading_rad), std::cos(here.heading_rad));
  const double lateral_m = left.dot(ego.position_m - here.position_m);
  const double middle_m = 0.5 * spec.length_m - spec.rear_overhang_m;  // of the box, ahead of the rear axle
  for (double later = 0.0; later <= kHorizon_s; later += kLookStep_s) {
    const double arc_m = ego.arc_m + later * ego.speed_mps;
    const double heading = road.at(arc_m).heading_rad;
    const Box own{road.place(arc_m, lateral_m) + middle_m * Eigen::Vector2d(std::cos(heading), std::sin(heading)),
                  heading, spec.length_m, spec.width_m};
    for (std::size_t k = 0; k < drive.world().number_of_bodies(); ++k) {
      const simulator::Body body = drive.world().body(k, t_s);
      if ((body.position_m - ego.position_m).norm() > kReach_m) continue;
      const Box other{body.position_m + later * body.velocity_mps, body.heading_rad, body.length_m, body.width_m};
      if (overlap(own, other)) return later;
    }
  }
  return std::nullopt;
}

void WarningJudge::add(const TrackList& list, const simulator::Drive& drive, double t_s) {
  if (t_s - checked_s_ >= kCheck_s) {
    checked_s_ = t_s;
    const std::optional<double> contact_s = time_to_contact_s(drive, t_s);
    if (contact_s && (!shortest_s_ || *contact_s < *shortest_s_)) shortest_s_ = contact_s;
  }
  if (list.number_of_collision_warnings == 0) return;
  if (!warnings_.empty() && t_s - warnings_.back().end_s <= kPause_s) {
    warnings_.back().end_s = t_s;
    return;
  }
  warnings_.push_back({t_s, t_s, time_to_contact_s(drive, t_s), list.path_objects[0]});
}

}  // namespace boresight::bench::surroundings
