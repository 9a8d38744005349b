#include "services/tracker/core/surroundings/road_edges.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::tracking {

namespace {

double probability(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace

RoadEdges::RoadEdges(const RoadEdgeParameters& parameters, double behind_m)
    : parameters_(parameters), behind_m_(behind_m), vote_(parameters), search_(parameters, behind_m) {}

void RoadEdges::clear() {
  for (Edge& e : edges_) e = {};
  driven_m_ = 0.0;
}

void RoadEdges::step(const StationaryMemory& memory, const EgoPath& path, const geometry::EgoStep& step, double yaw_rad,
                     double elapsed_s) {
  driven_m_ += step.translation_m.x();
  for (Edge& e : edges_) {
    if (e.id == 0) continue;
    e.line.predict(step, yaw_rad, parameters_);
    update(e, memory, elapsed_s);
    if (!is_alive(e)) e = {};
  }
  drop_doubles();
  if (!memory.places().empty()) start(memory, path);
}

void RoadEdges::update(Edge& e, const StationaryMemory& memory, double elapsed_s) {
  const double time_s = std::max(0.0, elapsed_s);
  e.age_s += time_s;
  e.since_update_s += time_s;
  const EdgeEvidence found = e.line.update(memory.scan(), e.side, e.densities, e.scatter_m2, parameters_);
  e.detections = found.detections;
  e.is_seen = found.is_seen;
  // The scatter is learnt from what the lines of sight measure well.
  const double keep = std::exp(-time_s / parameters_.scatter_memory_s);
  e.scatter_weight = keep * e.scatter_weight;
  if (found.weights > 0.0) {
    const double sum = e.scatter_weight + found.weights + 1.0;
    e.scatter_m2 = ((e.scatter_weight + 1.0) * e.scatter_m2 + found.squares_m2) / sum;
    const double least_m2 = 0.25 * parameters_.scatter_m * parameters_.scatter_m;
    const double most_m2 = parameters_.band_half_width_m * parameters_.band_half_width_m;
    e.scatter_m2 = std::clamp(e.scatter_m2, least_m2, most_m2);
    e.scatter_weight += found.weights;
  }
  count(e, memory, elapsed_s);
  judge(e);
}

void RoadEdges::count(Edge& e, const StationaryMemory& memory, double elapsed_s) {
  const double keep = std::exp(-std::max(0.0, elapsed_s) / parameters_.cell_memory_s);
  for (Cell& cell : e.cells) {
    cell.on *= keep;
    cell.inner *= keep;
    cell.outer *= keep;
  }
  const double band_m = parameters_.band_half_width_m;
  for (const StationaryPoint& p : memory.scan()) {
    const double x = p.position_m.x();
    if (x < -behind_m_ || x > parameters_.ahead_m) continue;
    const double outside_m = e.side * (p.position_m.y() - e.line.at(x));
    if (std::abs(outside_m) > 3.0 * band_m) continue;
    const auto place = static_cast<std::int64_t>(std::floor((driven_m_ + x) / parameters_.cell_m));
    Cell& cell = e.cells[static_cast<std::size_t>(place) % kCells];
    if (cell.place != place) cell = {place};
    (outside_m < -band_m ? cell.inner : outside_m > band_m ? cell.outer : cell.on) += 1.0;
  }
}

void RoadEdges::judge(Edge& e) {
  const auto first = static_cast<std::int64_t>(std::floor((driven_m_ - behind_m_) / parameters_.cell_m));
  const auto last = static_cast<std::int64_t>(std::floor((driven_m_ + parameters_.ahead_m) / parameters_.cell_m));
  double on = 0.0, inner = 0.0, outer = 0.0;
  e.log_odds = parameters_.prior_log_odds;
  // The longest run of winning segments whose gaps are short.
  double run_start_m = 0.0, run_end_m = 0.0;
  bool in_run = false, has_run = false;
  e.start_m = e.end_m = 0.0;
  for (std::int64_t place = first; place <= last; ++place) {
    const Cell& cell = e.cells[static_cast<std::size_t>(place) % kCells];
    if (cell.place != place) continue;
    e.log_odds += vote_.of(cell.on, cell.inner, cell.outer);
    on += cell.on;
    inner += cell.inner;
    outer += cell.outer;
    if (!vote_.is_win(cell.on, cell.inner, cell.outer)) continue;
    const double from_m = static_cast<double>(place) * parameters_.cell_m - driven_m_;
    if (!in_run || from_m - run_end_m > parameters_.longest_gap_m) run_start_m = from_m;
    in_run = true;
    run_end_m = from_m + parameters_.cell_m;
    if (!has_run || run_end_m - run_start_m > e.end_m - e.start_m) {
      e.start_m = run_start_m;
      e.end_m = std::min(run_end_m, parameters_.ahead_m);
      has_run = true;
    }
  }
  if (has_run && e.is_seen) e.since_update_s = 0.0;
  const double band_m = 2.0 * parameters_.band_half_width_m;
  e.densities.inner_per_m = inner / band_m + 0.1;
  e.densities.outer_per_m = outer / band_m + 0.1;
  e.densities.on = std::max(1.0, on - 0.5 * (inner + outer));
}

bool RoadEdges::is_alive(const Edge& e) const {
  return e.log_odds >= parameters_.end_log_odds && e.since_update_s <= parameters_.longest_coast_s &&
         e.side * e.line.at(0.0) >= 0.5 * parameters_.least_distance_m;
}

void RoadEdges::drop_doubles() {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      Edge &a = edges_[i], &b = edges_[k];
      if (i == k || a.id == 0 || b.id == 0 || a.side != b.side) continue;
      const double apart_m = std::abs(a.line.at(EdgeSearch::kReference_m) - b.line.at(EdgeSearch::kReference_m));
      if (apart_m < 0.5 * parameters_.separation_m && a.log_odds <= b.log_odds) a = {};
    }
  }
}

void RoadEdges::start(const StationaryMemory& memory, const EgoPath& path) {
  // One of two sides and three curvatures a time.
  constexpr std::uint32_t kBends = 3, kSides = 2;
  const std::uint32_t turn = turn_++ % (kBends * kSides);
  const double side = turn % kSides == 0 ? 1.0 : -1.0;
  const double bend_per_m = (static_cast<double>(turn / kSides) - 1.0) * parameters_.curvature_step_per_m;
  const auto distance_m = [&path](const Edge& e) {
    const double x = EdgeSearch::kReference_m;
    return e.side * (e.line.at(x) - 0.5 * path.curvature_per_m * x * x);
  };
  const auto is_taken = [&](double aside_m) {
    return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& e) {
      return e.id != 0 && e.side == side && std::abs(distance_m(e) - aside_m) < parameters_.separation_m;
    });
  };
  const FoundEdge found = search_.search(memory.places(), path, side, bend_per_m, is_taken);
  if (!found.is_found) return;
  // Two places for each side; the outermost makes room.
  const std::size_t first = side > 0.0 ? 0 : kMaxRoadEdges / 2;
  Edge* free = &edges_[first];
  for (std::size_t k = first + 1; k < first + kMaxRoadEdges / 2; ++k) {
    if (free->id != 0 && (edges_[k].id == 0 || distance_m(edges_[k]) > distance_m(*free))) free = &edges_[k];
  }
  if (free->id != 0 && distance_m(*free) < side * found.c(0)) return;
  *free = {};
  free->id = next_id_++;
  if (next_id_ == 0) next_id_ = 1;
  free->side = side;
  free->line.c = found.c;
  const Eigen::Vector3d start_std(parameters_.band_half_width_m, parameters_.slope_step,
                                  parameters_.curvature_step_per_m);
  free->line.covariance = start_std.cwiseAbs2().asDiagonal();
  free->densities = {found.on, found.inner_per_m + 0.1, found.outer_per_m + 0.1};
  free->scatter_m2 = parameters_.scatter_m * parameters_.scatter_m;
  free->log_odds = parameters_.prior_log_odds + found.votes;
  free->end_m = parameters_.cell_m;
  // The memory shows the line's segments at once.
  for (const Eigen::Vector2d& p : memory.places()) {
    const double outside_m = side * (p.y() - free->line.at(p.x())), band_m = parameters_.band_half_width_m;
    if (p.x() < -behind_m_ || p.x() > parameters_.ahead_m || std::abs(outside_m) > 3.0 * band_m) continue;
    const auto place = static_cast<std::int64_t>(std::floor((driven_m_ + p.x()) / parameters_.cell_m));
    Cell& cell = free->cells[static_cast<std::size_t>(place) % kCells];
    if (cell.place != place) cell = {place};
    (outside_m < -band_m ? cell.inner : outside_m > band_m ? cell.outer : cell.on) += 1.0;
  }
}

RoadCourse RoadEdges::course(const Eigen::Vector2d& place_m) const {
  RoadCourse best;
  const double x = place_m.x();
  for (const Edge& e : edges_) {
    if (e.id == 0 || probability(e.log_odds) < parameters_.course_existence) continue;
    if (x > e.end_m + parameters_.course_beyond_m || x < e.start_m) continue;
    const double departs_m = parameters_.curvature_rate_std_pm2 * x * x * x / 6.0;
    const Eigen::Vector3d change = EdgeLine::basis(x) - EdgeLine::basis(0.0);
    const double variance_m2 = change.dot(e.line.covariance * change) + departs_m * departs_m;
    if (best.is_known && best.variance_m2 <= variance_m2) continue;
    best.is_known = true;
    best.aside_m = (place_m.y() - e.line.at(x)) * std::cos(std::atan(e.line.slope(x))) +
                   e.line.at(0.0) * std::cos(std::atan(e.line.slope(0.0)));
    best.variance_m2 = variance_m2;
  }
  return best;
}

void RoadEdges::write(TrackList& out) const {
  out.number_of_road_edges = 0;
  for (const Edge& e : edges_) {
    const double existence = probability(e.log_odds);
    if (e.id == 0 || existence < parameters_.report_existence) continue;
    RoadEdge& r = out.road_edges[out.number_of_road_edges++];
    r = {};
    r.edge_id = e.id;
    r.side = e.side > 0.0 ? RoadSide::kLeft : RoadSide::kRight;
    r.update = e.is_seen ? TrackUpdate::kMeasured : TrackUpdate::kPredicted;
    r.age_s = static_cast<float>(e.age_s);
    r.time_since_update_s = static_cast<float>(e.since_update_s);
    r.existence_probability = static_cast<float>(existence);
    r.start_x_m = static_cast<float>(e.start_m);
    r.end_x_m = static_cast<float>(e.end_m);
    r.scatter_std_m = static_cast<float>(std::sqrt(e.scatter_m2));
    r.number_of_detections = static_cast<std::uint32_t>(std::lround(e.detections));
    for (Eigen::Index i = 0; i < 3; ++i) {
      r.coefficients[static_cast<std::size_t>(i)] = static_cast<float>(e.line.c(i));
      for (Eigen::Index k = 0; k < 3; ++k) {
        r.covariance[static_cast<std::size_t>(3 * i + k)] = static_cast<float>(e.line.covariance(i, k));
      }
    }
  }
  std::sort(out.road_edges.begin(), out.road_edges.begin() + out.number_of_road_edges,
            [](const RoadEdge& a, const RoadEdge& b) {
              return std::abs(a.coefficients[0]) != std::abs(b.coefficients[0])
                         ? std::abs(a.coefficients[0]) < std::abs(b.coefficients[0])
                         : a.edge_id < b.edge_id;
            });
}

}  // namespace boresight::tracking
