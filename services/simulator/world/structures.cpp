#include "services/simulator/world/structures.hpp"

#include <algorithm>
#include <cmath>

#include "services/simulator/random.hpp"

namespace boresight::simulator {

namespace {

constexpr double kSagitta_m = 0.02;  // of a curved mirror over the plane mirror that approximates it
constexpr double kShortestChord_m = 1.0, kLongestChord_m = 25.0;

/// The line of a structure: along the road, or straight off the road.
class Line {
 public:
  Line(const StructureSpec& spec, const Road& road, double lateral_m)
      : road_(road), spec_(spec), lateral_m_(lateral_m) {
    const double heading = road.at(spec.from_m).heading_rad + spec.heading_rad;
    direction_ = {std::cos(heading), std::sin(heading)};
    origin_ = road.place(spec.from_m, lateral_m);
  }
  [[nodiscard]] bool is_straight() const { return spec_.heading_rad != 0.0; }
  [[nodiscard]] Eigen::Vector2d place(double at_m, double aside_m) const {
    if (!is_straight()) return road_.place(at_m, lateral_m_ + aside_m);
    return origin_ + (at_m - spec_.from_m) * direction_ + aside_m * Eigen::Vector2d(-direction_.y(), direction_.x());
  }
  [[nodiscard]] double arc_of(double at_m) const { return is_straight() ? spec_.from_m : at_m; }
  /// Length of the plane mirror that begins here.
  [[nodiscard]] double chord_m(double at_m) const {
    if (is_straight()) return kLongestChord_m;
    double curvature = 0.0;
    for (const double ahead_m : {0.0, 4.0, 8.0, 16.0}) {
      const double k = road_.at(at_m + ahead_m).curvature_per_m;
      curvature = std::max(curvature, std::abs(k / std::max(0.1, 1.0 - k * lateral_m_)));
    }
    return std::clamp(std::sqrt(8.0 * kSagitta_m / std::max(1e-9, curvature)), kShortestChord_m, kLongestChord_m);
  }

 private:
  const Road& road_;
  const StructureSpec& spec_;
  double lateral_m_;
  Eigen::Vector2d direction_;
  Eigen::Vector2d origin_;
};

/// The extent of the structure without its gaps.
std::vector<Gap> stretches(const StructureSpec& spec, Gap extent) {
  const bool straight = spec.heading_rad != 0.0;
  const double shift_m = straight ? spec.from_m : 0.0;
  const Gap whole = straight ? Gap{spec.from_m, spec.to_m}
                             : Gap{std::max(spec.from_m, extent.from_m), std::min(spec.to_m, extent.to_m)};
  std::vector<Gap> gaps;
  for (const Gap& gap : spec.gaps) gaps.push_back({gap.from_m + shift_m, gap.to_m + shift_m});
  if (spec.gap_every_m > 0.0) {
    const double first = std::max(1.0, std::floor((whole.from_m - spec.from_m) / spec.gap_every_m));
    for (double at = spec.from_m + first * spec.gap_every_m; at < whole.to_m; at += spec.gap_every_m) {
      gaps.push_back({at, at + spec.gap_length_m});
    }
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) { return a.from_m < b.from_m; });
  std::vector<Gap> solid;
  double from_m = whole.from_m;
  for (const Gap& gap : gaps) {
    if (gap.from_m > from_m) solid.push_back({from_m, std::min(gap.from_m, whole.to_m)});
    from_m = std::max(from_m, gap.to_m);
  }
  if (from_m < whole.to_m) solid.push_back({from_m, whole.to_m});
  std::erase_if(solid, [](const Gap& s) { return s.to_m <= s.from_m; });
  return solid;
}

MirrorSurface mirror(const StructureSpec& spec, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return {from, to, spec.low_m, spec.high_m, spec.loss_db, Eigen::Vector2d::Zero(), 0, spec.opaque};
}

void add_mirrors(const StructureSpec& spec, const Line& line, Gap stretch, Roadside& roadside) {
  for (double at = stretch.from_m; at < stretch.to_m - 1e-6;) {
    double next = std::min(stretch.to_m, at + line.chord_m(at));
    if (stretch.to_m - next < 0.5) next = stretch.to_m;
    roadside.surfaces.push_back(
        {line.arc_of(0.5 * (at + next)), mirror(spec, line.place(at, 0.0), line.place(next, 0.0))});
    at = next;
  }
}

/// Multiples of the spacing within a stretch.
template <typename Visit>
void for_spots(const StructureSpec& spec, Gap stretch, const Visit& visit) {
  const double first = std::ceil((stretch.from_m - spec.from_m) / spec.spacing_m);
  for (auto k = static_cast<std::uint64_t>(std::max(0.0, first));; ++k) {
    const double at = spec.from_m + static_cast<double>(k) * spec.spacing_m;
    if (at >= stretch.to_m) return;
    visit(k, at);
  }
}

void add_spots(const StructureSpec& spec, const Line& line, Gap stretch, std::uint64_t seed, std::uint64_t index,
               Roadside& roadside) {
  for_spots(spec, stretch, [&](std::uint64_t k, double at) {
    Stream draw(seed, "structure", index, k);
    const double along = std::clamp(at + draw.uniform(-0.15, 0.15) * spec.spacing_m, stretch.from_m, stretch.to_m);
    const Eigen::Vector2d p = line.place(along, spec.roughness_m * draw.gaussian());
    const double z = draw.uniform(spec.low_m, spec.high_m);
    roadside.scatterers.push_back(
        {line.arc_of(along), {{p.x(), p.y(), z}, draw.uniform(spec.rcs_min_dbsm, spec.rcs_max_dbsm)}});
  });
}

void add_ceiling(const StructureSpec& spec, const Line& line, Gap stretch, std::uint64_t seed, std::uint64_t index,
                 Roadside& roadside) {
  for_spots(spec, stretch, [&](std::uint64_t k, double at) {
    Stream draw(seed, "ceiling", index, k);
    const double along = at + draw.uniform(-0.5, 0.5) * spec.spacing_m;
    const Eigen::Vector2d p = line.place(along, -draw.uniform(0.0, spec.width_m));
    roadside.scatterers.push_back(
        {line.arc_of(along), {{p.x(), p.y(), spec.high_m}, draw.uniform(spec.rcs_min_dbsm, spec.rcs_max_dbsm)}});
  });
}

void add_pillars(const StructureSpec& spec, const Line& line, Gap stretch, std::uint64_t seed, std::uint64_t index,
                 Roadside& roadside) {
  for_spots(spec, stretch, [&](std::uint64_t k, double at) {
    Stream draw(seed, "pillar", index, k);
    const double half = 0.5 * spec.width_m;
    const Eigen::Vector2d corners[] = {line.place(at - half, half), line.place(at + half, half),
                                       line.place(at + half, -half), line.place(at - half, -half)};
    for (std::size_t i = 0; i < 4; ++i) {
      roadside.surfaces.push_back({line.arc_of(at), mirror(spec, corners[i], corners[(i + 1) % 4])});
      roadside.scatterers.push_back({line.arc_of(at),
                                     {{corners[i].x(), corners[i].y(), draw.uniform(0.3, spec.high_m)},
                                      draw.uniform(spec.rcs_min_dbsm, spec.rcs_max_dbsm)}});
    }
  });
}

}  // namespace

void add_structure(const StructureSpec& spec, std::uint64_t index, const Road& road, Gap extent, std::uint64_t seed,
                   Roadside& roadside) {
  const Line line(spec, road, spec.lateral_m);
  const std::size_t first = roadside.scatterers.size();
  for (const Gap& stretch : stretches(spec, extent)) {
    if (spec.kind == StructureKind::kPillars) {
      add_pillars(spec, line, stretch, seed, index, roadside);
      continue;
    }
    add_mirrors(spec, line, stretch, roadside);
    add_spots(spec, line, stretch, seed, 2 * index, roadside);
    if (spec.kind != StructureKind::kTunnel) continue;
    const Line right(spec, road, spec.lateral_m - spec.width_m);
    add_mirrors(spec, right, stretch, roadside);
    add_spots(spec, right, stretch, seed, 2 * index + 1, roadside);
    add_ceiling(spec, line, stretch, seed, index, roadside);
  }
  for (std::size_t i = first; i < roadside.scatterers.size(); ++i) {
    roadside.scatterers[i].scatterer.origin = {Origin::Kind::kStructure, static_cast<std::uint32_t>(index)};
  }
}

double most_parts(const StructureSpec& spec, Gap extent) {
  const double length_m = spec.heading_rad != 0.0
                              ? spec.to_m - spec.from_m
                              : std::max(0.0, std::min(spec.to_m, extent.to_m) - std::max(spec.from_m, extent.from_m));
  if (spec.kind == StructureKind::kPillars) return 8.0 * length_m / spec.spacing_m;
  const double lines = spec.kind == StructureKind::kTunnel ? 3.0 : 1.0;
  return lines * length_m * (1.0 / spec.spacing_m + 1.0 / kShortestChord_m);
}

}  // namespace boresight::simulator
