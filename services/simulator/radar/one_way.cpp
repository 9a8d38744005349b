#include "services/simulator/radar/one_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/simulator/radar/ground.hpp"
#include "services/simulator/radar/key.hpp"

namespace boresight::simulator::radar {

namespace {

/// A corner of a path: an end or a specular point, and the velocity of the sensor, mirror or target there.
struct Corner {
  Eigen::Vector3d position, velocity;
};

/// Length of the path and its time derivative. By Fermat's principle, the motion of a specular point along its mirror
/// does not change the length to first order. Only the motion of the ends and the mirrors' motion along their normals
/// count, so any tangential velocity of the specular points will do.
template <std::size_t N>
void measure(const std::array<Corner, N>& corners, OneWay& path) {
  path.length_m = path.rate_mps = 0.0;
  for (std::size_t i = 1; i < N; ++i) {
    const Eigen::Vector3d leg = corners[i].position - corners[i - 1].position;
    const double length = leg.norm();
    const Eigen::Vector3d direction = leg / length;
    if (i == 1) path.direction = direction;
    path.incidence = -direction;
    path.length_m += length;
    path.rate_mps += direction.dot(corners[i].velocity - corners[i - 1].velocity);
  }
}

}  // namespace

void Propagation::add_mirrors(const Scene& scene) {
  mirrors_.clear();
  if (!spec_.on || spec_.max_bounces < 2) return;
  const Eigen::Vector2d here = view_.position_m.head<2>();
  std::uint32_t of_body = 0;
  std::uint64_t side = 0;
  for (const MirrorSurface& surface : scene.surfaces) {
    // Keys: a body's sides are numbered in their order, since the body moves; structures are named by their place.
    side = surface.body_id == of_body ? side + 1 : 0;
    of_body = surface.body_id;
    const Eigen::Vector2d along = surface.to_m - surface.from_m;
    const double length2 = along.squaredNorm();
    if (!(length2 > 1e-6) || surface.high_m <= surface.low_m) continue;
    const double u = std::clamp((here - surface.from_m).dot(along) / length2, 0.0, 1.0);
    if ((surface.from_m + u * along - here).norm() > range_max_m_) continue;
    const Body* body = nullptr;
    if (surface.body_id != 0) {
      const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                      [&](const Body& b) { return b.id == surface.body_id; });
      if (found != scene.bodies.end()) body = &*found;
    }
    mirrors_.push_back(make_mirror(surface, body));
    mirrors_.back().key = of_body == 0 ? key_of(Eigen::Vector3d(surface.from_m.x(), surface.from_m.y(), surface.low_m))
                                       : key_of(of_body, side);
  }
}

bool Propagation::sees(const Source& source, const Mirror& mirror) const {
  if (source.mirror < 0) return mirror.faces(mirror.across(source.position));
  const Mirror& first = mirrors_[static_cast<std::size_t>(source.mirror)];
  if (&first == &mirror || !mirror.faces(mirror.across(source.position))) return false;
  // Rays from the sensor's mirror image that pass through the first mirror fill a wedge on the sensor's side. Some part
  // of the other mirror must lie inside this wedge.
  const double sign = first.across(view_.position_m) > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d from = source.position.head<2>();
  const Eigen::Vector2d a = first.origin_m - from, b = a + first.length_m * first.tangent;
  const double turn = a.x() * b.y() - a.y() * b.x() > 0.0 ? 1.0 : -1.0;
  const std::array<Eigen::Vector2d, 3> inward = {sign * first.normal, turn * Eigen::Vector2d(-a.y(), a.x()),
                                                 -turn * Eigen::Vector2d(-b.y(), b.x())};
  const std::array<Eigen::Vector2d, 3> through = {first.origin_m, from, from};
  double low = 0.0, high = mirror.length_m;
  for (std::size_t i = 0; i < inward.size(); ++i) {
    const double at = inward[i].dot(mirror.origin_m - through[i]), slope = inward[i].dot(mirror.tangent);
    if (std::abs(slope) < 1e-12) {
      if (at < 0.0) return false;
      continue;
    }
    if (slope > 0.0) {
      low = std::max(low, -at / slope);
    } else {
      high = std::min(high, -at / slope);
    }
  }
  return low < high;
}

void Propagation::add_pairs() {
  sources_.clear();
  pairs_.clear();
  sources_.push_back({view_.position_m, -1});
  if (spec_.max_bounces >= 3) {
    for (std::size_t m = 0; m < mirrors_.size(); ++m) {
      if (!mirrors_[m].faces(mirrors_[m].across(view_.position_m))) continue;
      const Eigen::Vector3d image = mirrors_[m].image(view_.position_m);
      if ((image - view_.position_m).norm() > 2.0 * range_max_m_) continue;
      sources_.push_back({image, static_cast<int>(m)});
    }
  }
  for (std::uint32_t s = 0; s < sources_.size(); ++s) {
    for (std::uint32_t m = 0; m < mirrors_.size(); ++m) {
      if (sees(sources_[s], mirrors_[m])) pairs_.push_back({s, m});
    }
  }
}

void Propagation::prepare(const Scene& scene, const Viewpoint& view, const EgoBox& ego) {
  view_ = view;
  occlusion_.prepare(scene, view.position_m.head<2>(), range_max_m_, ego);
  add_mirrors(scene);
  add_pairs();
}

void Propagation::direct(const Target& target, double embedded_m, std::vector<OneWay>& paths) const {
  if (!target.seen_from(view_.position_m)) return;
  const Eigen::Vector3d& sensor = view_.position_m;
  OneWay path{};
  const auto over_ground = [&](const Eigen::Vector3d& p) {
    const double distance = (p - sensor).head<2>().norm(), part = sensor.z() / (sensor.z() + p.z());
    const Eigen::Vector2d flat = sensor.head<2>() + part * (p - sensor).head<2>();
    return std::pair(Eigen::Vector3d(flat.x(), flat.y(), 0.0), distance);
  };
  const bool clear = occlusion_.clear(sensor, target.position_m, target.body_id, embedded_m);
  const bool with_ground = spec_.ground_bounce && sensor.z() > 0.05 && target.position_m.z() > 0.05;
  bool ground_clear = false;
  std::pair<Eigen::Vector3d, double> ground;
  if (with_ground) {
    ground = over_ground(target.position_m);
    ground_clear = ground.second > 1.0 && occlusion_.clear(sensor, ground.first, target.body_id) &&
                   occlusion_.clear(ground.first, target.position_m, target.body_id, embedded_m);
  }
  if (clear) {
    measure(std::array<Corner, 2>{{{sensor, view_.velocity_mps}, {target.position_m, target.velocity_mps}}}, path);
    if (ground_clear) {
      const GroundEffect effect = two_rays(ground.second, sensor.z(), target.position_m.z());
      path.loss_db = -effect.gain_db;
      const Eigen::Vector2d flat = path.direction.head<2>().normalized() * std::cos(effect.elevation_rad);
      path.direction = {flat.x(), flat.y(), std::sin(effect.elevation_rad)};
    }
    paths.push_back(path);
  } else if (ground_clear) {
    measure(std::array<Corner, 3>{{{sensor, view_.velocity_mps},
                                   {ground.first, Eigen::Vector3d::Zero()},
                                   {target.position_m, target.velocity_mps}}},
            path);
    path.loss_db = -20.0 * std::log10(ground_reflection((sensor.z() + target.position_m.z()) / path.length_m));
    path.key = 1;
    paths.push_back(path);
  }
}

void Propagation::choose(const Eigen::Vector3d& centre_m, double radius_m) {
  chosen_.clear();
  for (const Pair& pair : pairs_) {
    if (may_bounce(mirrors_[pair.mirror], sources_[pair.source].position, centre_m, radius_m)) chosen_.push_back(pair);
  }
}

void Propagation::mirrored(const Target& target, std::vector<OneWay>& paths) const {
  for (const Pair& pair : chosen_) {
    const Source& source = sources_[pair.source];
    const Mirror& last = mirrors_[pair.mirror];
    if (target.body_id != 0 && last.body_id == target.body_id) continue;
    Eigen::Vector3d at;
    if (!bounce(last, source.position, target.position_m, at) || !target.seen_from(at)) continue;
    const Corner sensor{view_.position_m, view_.velocity_mps}, end{target.position_m, target.velocity_mps};
    const Corner corner{at, last.velocity_at(at)};
    OneWay path{};
    if (source.mirror < 0) {
      measure(std::array<Corner, 3>{sensor, corner, end}, path);
      if (path.length_m > 2.0 * range_max_m_ || !occlusion_.clear(sensor.position, at) ||
          !occlusion_.clear(at, target.position_m, target.body_id)) {
        continue;
      }
      path.loss_db = last.loss_db + spec_.extra_loss_db;
      path.mirrors = 1;
      path.mirror_body = last.body_id;
      path.key = key_of(2, last.key);
    } else {
      const Mirror& first = mirrors_[static_cast<std::size_t>(source.mirror)];
      if (target.body_id != 0 && first.body_id == target.body_id) continue;
      Eigen::Vector3d before;
      if (!bounce(first, view_.position_m, at, before)) continue;
      // The specular point on the first mirror and the target must lie on the same face of the last mirror.
      if (last.across(before) * last.across(target.position_m) <= 0.0) continue;
      measure(std::array<Corner, 4>{sensor, {before, first.velocity_at(before)}, corner, end}, path);
      if (path.length_m > 2.0 * range_max_m_ || !occlusion_.clear(sensor.position, before) ||
          !occlusion_.clear(before, at) || !occlusion_.clear(at, target.position_m, target.body_id)) {
        continue;
      }
      path.loss_db = first.loss_db + last.loss_db + 2.0 * spec_.extra_loss_db;
      path.mirrors = 2;
      path.mirror_body = first.body_id;
      path.key = key_of(first.key, last.key);
    }
    paths.push_back(path);
  }
}

}  // namespace boresight::simulator::radar
