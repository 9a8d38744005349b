#include "services/simulator/radar/occlusion.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::simulator::radar {

namespace {

constexpr double kSkin_m = 0.01;  // boxes are smaller by this, so that points on their sides are outside
constexpr std::uint32_t kEgo = 0xFFFFFFFFu;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

void Occlusion::prepare(const Scene& scene, const Eigen::Vector2d& centre_m, double reach_m, const EgoBox& ego) {
  boxes_.clear();
  sheets_.clear();
  const auto add = [&](const Eigen::Vector2d& centre, double heading, const Eigen::Vector2d& size, double low,
                       double high, std::uint32_t id) {
    const Eigen::Vector2d half = 0.5 * size - Eigen::Vector2d::Constant(kSkin_m);
    if (half.minCoeff() <= 0.0) return;
    boxes_.push_back({centre, {std::cos(heading), std::sin(heading)}, half, half.norm(), low, high, id});
  };
  const double c = std::cos(scene.ego.heading_rad), s = std::sin(scene.ego.heading_rad);
  const Eigen::Vector2d middle = 0.5 * (ego.low_m + ego.high_m);
  add(scene.ego.position_m + Eigen::Vector2d(c * middle.x() - s * middle.y(), s * middle.x() + c * middle.y()),
      scene.ego.heading_rad, ego.high_m - ego.low_m, ego.clearance_m, ego.height_m, kEgo);
  for (const Body& body : scene.bodies) {
    if ((body.position_m - centre_m).norm() > reach_m + body.length_m) continue;
    add(body.position_m, body.heading_rad, {body.length_m, body.width_m}, body.clearance_m, body.height_m, body.id);
  }
  for (const MirrorSurface& surface : scene.surfaces) {
    // A body's side is a part of its box.
    if (!surface.opaque || surface.body_id != 0) continue;
    const Eigen::Vector2d along = surface.to_m - surface.from_m;
    const double length = along.norm();
    if (length <= 0.0) continue;
    const double u = std::clamp((centre_m - surface.from_m).dot(along) / (length * length), 0.0, 1.0);
    if ((surface.from_m + u * along - centre_m).norm() > reach_m) continue;
    sheets_.push_back(
        {surface.from_m, along, Eigen::Vector2d(-along.y(), along.x()) / length, surface.low_m, surface.high_m});
  }
}

bool Occlusion::blocks(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector2d d = from.head<2>() - box.centre, e = to.head<2>() - from.head<2>();
  const Eigen::Vector2d start(box.axis.dot(d), cross(box.axis, d)), along(box.axis.dot(e), cross(box.axis, e));
  double enter = 0.0, leave = 1.0;
  for (Eigen::Index i = 0; i < 2; ++i) {
    if (std::abs(along(i)) < 1e-12) {
      if (std::abs(start(i)) > box.half(i)) return false;
      continue;
    }
    double t0 = (-box.half(i) - start(i)) / along(i), t1 = (box.half(i) - start(i)) / along(i);
    if (t0 > t1) std::swap(t0, t1);
    enter = std::max(enter, t0);
    leave = std::min(leave, t1);
  }
  if (enter >= leave) return false;
  const double z0 = from.z() + enter * (to.z() - from.z()), z1 = from.z() + leave * (to.z() - from.z());
  return std::max(z0, z1) > box.low && std::min(z0, z1) < box.high;
}

bool Occlusion::blocks(const Sheet& sheet, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double embedded_m) {
  const Eigen::Vector2d d = from.head<2>() - sheet.from, e = to.head<2>() - sheet.from;
  const double side_from = sheet.normal.dot(d), side_to = sheet.normal.dot(e);
  // Paths that begin or end on the surface do not cross it.
  if (side_from * side_to >= 0.0 || std::abs(side_from) < kSkin_m || std::abs(side_to) < embedded_m) return false;
  const double t = side_from / (side_from - side_to);
  const Eigen::Vector2d at = d + t * (e - d);
  const double u = at.dot(sheet.along);
  if (u < 0.0 || u > sheet.along.squaredNorm()) return false;
  const double z = from.z() + t * (to.z() - from.z());
  return z > sheet.low && z < sheet.high;
}

bool Occlusion::clear(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, std::uint32_t own_body,
                      double embedded_m) const {
  const Eigen::Vector2d from = from_m.head<2>(), along = to_m.head<2>() - from;
  const double length2 = std::max(1e-12, along.squaredNorm());
  for (const Box& box : boxes_) {
    if (box.body_id == own_body) continue;
    const double u = std::clamp((box.centre - from).dot(along) / length2, 0.0, 1.0);
    if ((from + u * along - box.centre).squaredNorm() > box.radius * box.radius) continue;
    if (blocks(box, from_m, to_m)) return false;
  }
  for (const Sheet& sheet : sheets_) {
    if (blocks(sheet, from_m, to_m, embedded_m)) return false;
  }
  return true;
}

}  // namespace boresight::simulator::radar
