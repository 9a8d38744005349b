#include "services/ghost_filter/core/reflector_map/shadows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace boresight::ghosts {

namespace {

constexpr double kFar_m = 1e3;  // beyond what is kept of any reflector

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

bool HiddenStretches::contains(double arc_m) const {
  return std::any_of(stretches_.begin(), stretches_.begin() + count_,
                     [arc_m](const Stretch& s) { return s.begin_m <= arc_m && arc_m <= s.end_m; });
}

double HiddenStretches::after(double arc_m, double most_m) const {
  double reach_m = 0.0;
  // Each round goes to the end of another stretch.
  for (std::size_t round = 0; round < count_ && reach_m < most_m; ++round) {
    const double at = arc_m + reach_m;
    for (std::size_t k = 0; k < count_; ++k) {
      const Stretch& s = stretches_[k];
      if (s.begin_m <= at && at <= s.end_m) reach_m = std::max(reach_m, s.end_m - arc_m);
    }
    if (arc_m + reach_m == at) break;
  }
  return std::min(reach_m, most_m);
}

double HiddenStretches::before(double arc_m, double most_m) const {
  HiddenStretches turned;
  for (std::size_t k = 0; k < count_; ++k) turned.add({-stretches_[k].end_m, -stretches_[k].begin_m});
  return turned.after(-arc_m, most_m);
}

void Shadows::begin(const Eigen::Vector2d& eye_m) {
  eye_m_ = eye_m;
  count_ = 0;
}

void Shadows::add(const Eigen::Vector2d& middle_m, const Eigen::Vector2d& axis, double half_length_m,
                  double half_width_m) {
  if (count_ == kMost) return;
  const Eigen::Vector2d across(-axis.y(), axis.x()), from_eye = middle_m - eye_m_;
  if (std::abs(from_eye.dot(axis)) <= half_length_m && std::abs(from_eye.dot(across)) <= half_width_m) return;
  std::array<Eigen::Vector2d, 4> corners;
  std::size_t n = 0;
  for (const double x : {-half_length_m, half_length_m}) {
    for (const double y : {-half_width_m, half_width_m}) corners[n++] = from_eye + x * axis + y * across;
  }
  // From outside all lie within half a turn, so that each is to the left of another one or to the right of it.
  Eigen::Vector2d right = corners[0], left = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    if (cross(right, corner) < 0.0) right = corner;
    if (cross(left, corner) > 0.0) left = corner;
  }
  const auto edge = [](const Eigen::Vector2d& corner) {
    const double distance_m = corner.norm();
    return Edge{corner / distance_m, distance_m};
  };
  shadows_[count_++] = {edge(right), edge(left)};
}

HiddenStretches Shadows::on(const Curve& curve) const {
  HiddenStretches hidden;
  // Where a ray past a corner meets the curve behind it; nothing if in front of it.
  struct Met {
    bool at_all;
    std::optional<double> arc_m;
  };
  const auto meet = [&](const Edge& edge) -> Met {
    const double there_m = curve.crossings(eye_m_, edge.direction)[0];
    if (there_m < 0.0) return {false, std::nullopt};
    if (there_m < edge.corner_m) return {true, std::nullopt};
    return {true, curve.arc(eye_m_ + there_m * edge.direction)};
  };
  // To which side the arc length grows as the ray turns to the left.
  const auto grows = [&](const Edge& edge, double arc_m) {
    return cross(edge.direction, curve.tangent_at(arc_m)) > 0.0;
  };
  for (std::size_t k = 0; k < count_; ++k) {
    const Met right = meet(shadows_[k].right), left = meet(shadows_[k].left);
    // From the right ray to the left one. If one of them never meets the curve, or that on the other side of a circle,
    // the shadow goes on as far as anything is known.
    const bool is_right = right.arc_m.has_value(), is_left = left.arc_m.has_value();
    const bool up_from_right = is_right && grows(shadows_[k].right, *right.arc_m);
    const bool up_to_left = is_left && grows(shadows_[k].left, *left.arc_m);
    if (is_right && is_left && (*left.arc_m > *right.arc_m) == up_from_right) {
      hidden.add({std::min(*right.arc_m, *left.arc_m), std::max(*right.arc_m, *left.arc_m)});
      continue;
    }
    if (is_right && (is_left || !left.at_all)) {
      hidden.add(up_from_right ? Stretch{*right.arc_m, kFar_m} : Stretch{-kFar_m, *right.arc_m});
    }
    if (is_left && (is_right || !right.at_all)) {
      hidden.add(up_to_left ? Stretch{-kFar_m, *left.arc_m} : Stretch{*left.arc_m, kFar_m});
    }
  }
  return hidden;
}

}  // namespace boresight::ghosts
