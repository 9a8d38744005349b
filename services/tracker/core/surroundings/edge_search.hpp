// Search for lines along which stationary detections concentrate. Equations (W7), (W8).
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "services/tracker/core/surroundings/ego_path.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"

namespace boresight::tracking {

/// Evidence of a piece of a line: log likelihood ratio of an edge against a place like any other. The piece wins if it
/// holds more detections than the bands on both of its sides.
class ContrastVote {
 public:
  explicit ContrastVote(const RoadEdgeParameters& parameters);
  [[nodiscard]] double of(double on, double inner, double outer) const {
    if (on + inner + outer < least_) return 0.0;
    return on > inner && on > outer ? win_ : loss_;
  }
  [[nodiscard]] bool is_win(double on, double inner, double outer) const {
    return on + inner + outer >= least_ && on > inner && on > outer;
  }

 private:
  double least_, win_, loss_;
};

struct FoundEdge {
  bool is_found = false;
  Eigen::Vector3d c{0.0, 0.0, 0.0};
  double votes = 0.0;  ///< sum of the log likelihood ratios of its pieces
  double on = 0.0;     ///< detections on the line less those expected there without it
  double inner_per_m = 0.0, outer_per_m = 0.0;
};

class EdgeSearch {
 public:
  explicit EdgeSearch(const RoadEdgeParameters& parameters);

  /// The innermost line of one side, +1 left or −1 right, about the path with its curvature changed by `bend_per_m`.
  /// Places where `is_taken` (distance from the path, at `kReference_m` ahead) are left out.
  template <typename Taken>
  FoundEdge search(std::span<const Eigen::Vector2d> places, const EgoPath& path, double side, double bend_per_m,
                   const Taken& is_taken) {
    fill(places, path.curvature_per_m + bend_per_m, side);
    return best(path.curvature_per_m + bend_per_m, side, is_taken);
  }
  static constexpr double kReference_m = 10.0;

 private:
  static constexpr std::size_t kPieces = 20, kBins = 72;
  static constexpr int kSlopes = 3;  // to either side
  static constexpr int kBand = 3;    // bins of a band
  void fill(std::span<const Eigen::Vector2d> places, double curvature_per_m, double side);
  /// Number in the bins [first, first + kBand) of a piece.
  [[nodiscard]] double count(std::size_t piece, int first) const {
    const auto& sums = sums_[piece];
    const auto at = [&sums](int b) {
      return sums[static_cast<std::size_t>(std::clamp(b, 0, static_cast<int>(kBins)))];
    };
    return at(first + kBand) - at(first);
  }
  [[nodiscard]] double middle_m(std::size_t piece) const;
  FoundEdge evaluate(int bin, double slope, double curvature_per_m, double side) const;

  template <typename Taken>
  FoundEdge best(double curvature_per_m, double side, const Taken& is_taken) const {
    const double least = parameters_.start_log_odds - parameters_.prior_log_odds;
    const auto first = static_cast<int>(parameters_.least_distance_m / bin_m_);
    const auto separate = static_cast<int>(parameters_.separation_m / bin_m_);
    FoundEdge found;
    for (int b = first, last = static_cast<int>(kBins) - kBand; b < last; ++b) {
      for (int k = -kSlopes; k <= kSlopes; ++k) {
        const FoundEdge edge = evaluate(b, k * parameters_.slope_step, curvature_per_m, side);
        if (edge.votes < least || edge.votes <= found.votes) continue;
        if (is_taken(side * (edge.c(0) + edge.c(1) * kReference_m))) continue;
        found = edge;
        found.is_found = true;
        last = std::min(last, b + separate);  // what is farther out is another line
      }
    }
    return found;
  }

  RoadEdgeParameters parameters_;
  ContrastVote vote_;
  double bin_m_;
  std::array<std::array<float, kBins + 1>, kPieces> sums_{};  // by piece: detections before a bin
};

}  // namespace boresight::tracking
