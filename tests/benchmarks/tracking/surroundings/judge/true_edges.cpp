#include "tests/benchmarks/tracking/surroundings/judge/true_edges.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::surroundings {

namespace {

using simulator::ScatterKind;
using simulator::StructureKind;

constexpr double kBehind_m = 10.0, kAhead_m = 60.0, kSampleStep_m = 1.0;
constexpr double kFewestParked_per_m = 0.1;  // a row has gaps of a few cars at most
constexpr double kWidestRow_m = 1.0;         // of poles
constexpr double kHalfParkedWidth_m = 0.9;   // of the cars that are parked

bool is_gap(const simulator::StructureSpec& s, double arc_m) {
  for (const simulator::Gap& gap : s.gaps) {
    if (arc_m >= gap.from_m && arc_m <= gap.to_m) return true;
  }
  if (s.gap_every_m <= 0.0) return false;
  const double since_m = std::fmod(arc_m - s.from_m, s.gap_every_m);
  return arc_m - s.from_m >= s.gap_every_m && since_m <= s.gap_length_m;
}

}  // namespace

std::optional<double> TrueEdge::at(double x_m) const {
  for (std::size_t k = 1; k < places_vehicle_m.size(); ++k) {
    const Eigen::Vector2d &a = places_vehicle_m[k - 1], &b = places_vehicle_m[k];
    if ((a.x() <= x_m) == (b.x() <= x_m)) continue;
    return a.y() + (x_m - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
  }
  return std::nullopt;
}

std::vector<TrueEdge> true_edges(const simulator::Scenario& scenario, const simulator::World& world,
                                 const simulator::EgoState& ego) {
  std::vector<TrueEdge> edges;
  Eigen::Matrix2d to_vehicle;
  to_vehicle << std::cos(ego.heading_rad), std::sin(ego.heading_rad), -std::sin(ego.heading_rad),
      std::cos(ego.heading_rad);
  const auto add = [&](double from_m, double to_m, double lateral_m, const auto& is_open, bool is_loose = false,
                       bool hides = false) {
    TrueEdge edge{lateral_m > 0.0, is_loose, hides, {}};
    const auto finish = [&] {
      if (edge.places_vehicle_m.size() > 1) edges.push_back(edge);
      edge.places_vehicle_m.clear();
    };
    for (double arc = std::max(from_m, ego.arc_m - kBehind_m); arc <= std::min(to_m, ego.arc_m + kAhead_m);
         arc += kSampleStep_m) {
      if (is_open(arc)) {
        finish();
        continue;
      }
      edge.places_vehicle_m.emplace_back(to_vehicle * (world.road().place(arc, lateral_m) - ego.position_m));
    }
    finish();
  };
  const auto closed = [](double) { return false; };
  for (const simulator::StructureSpec& s : scenario.structures) {
    if (s.heading_rad != 0.0 || s.kind == StructureKind::kPillars) continue;
    const auto gaps = [&s](double arc_m) { return is_gap(s, arc_m); };
    add(s.from_m, s.to_m, s.lateral_m, gaps);
    if (s.kind == StructureKind::kTunnel) add(s.from_m, s.to_m, s.lateral_m - s.width_m, gaps);
  }
  for (const simulator::ScatterSpec& s : scenario.scatter) {
    const bool is_row = s.kind == ScatterKind::kParkedCars && s.per_m >= kFewestParked_per_m;
    const bool is_poles = s.kind == ScatterKind::kColumns && s.lateral_max_m - s.lateral_min_m <= kWidestRow_m;
    if (s.kind != ScatterKind::kKerb && !is_row && !is_poles) continue;
    const bool is_loose = is_row || is_poles;
    const double middle_m = 0.5 * (s.lateral_min_m + s.lateral_max_m);
    const double inward_m = is_row ? std::copysign(kHalfParkedWidth_m, middle_m) : 0.0;
    add(s.from_m, s.to_m, middle_m - inward_m, closed, is_loose, is_row);
    if (s.both_sides) add(s.from_m, s.to_m, inward_m - middle_m, closed, is_loose, is_row);
  }
  return edges;
}

}  // namespace boresight::bench::surroundings
