// Search for lines along which stationary detections concentrate. Equations (W7), (W8).
#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "services/tracker/core/surroundings/ego_path.hpp"
#include "services/tracker/core/surroundings/parameters.hpp"

namespace boresight::tracking {

/// Evidence of a segment of a line: log likelihood ratio of an edge against a place like any other. The segment wins if
/// it holds more detections than the bands on both of its sides.
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
  double votes = 0.0;  ///< sum of the log likelihood ratios of its segments
  double on = 0.0;     ///< detections on the line less those expected there without it
  double inner_per_m = 0.0, outer_per_m = 0.0;
};

class EdgeSearch {
 public:
  /// From `behind_m` behind the vehicle on.
  EdgeSearch(const RoadEdgeParameters& parameters, double behind_m);

  /// The innermost line of one side, +1 left or −1 right, about the path with its curvature changed by `bend_per_m`.
  /// Places where `is_taken` (distance from the path, at `kReference_m` ahead) are not searched.
  template <typename Taken>
  FoundEdge search(std::span<const Eigen::Vector2d> places, const EgoPath& path, double side, double bend_per_m,
                   const Taken& is_taken) {
    fill(places, path.curvature_per_m + bend_per_m, side);
    return best(path.curvature_per_m + bend_per_m, side, is_taken);
  }
  static constexpr double kReference_m = 10.0;

 private:
  static constexpr std::size_t kSegments = 20, kBins = 72;
  static constexpr int kSlopes = 3;  // to either side
  static constexpr int kBand = 3;    // bins of a band
  void fill(std::span<const Eigen::Vector2d> places, double curvature_per_m, double side);
  /// Number in the bins [first, first + kBand) of a segment.
  [[nodiscard]] double count(std::size_t segment, int first) const {
    const auto& sums = sums_[segment];
    const auto at = [&sums](int b) {
      return sums[static_cast<std::size_t>(std::clamp(b, 0, static_cast<int>(kBins)))];
    };
    return at(first + kBand) - at(first);
  }
  [[nodiscard]] double middle_m(std::size_t segment) const;
  /// Sum of the votes of a line that begins with that bin at the vehicle.
  [[nodiscard]] double votes(int bin, double slope) const;
  [[nodiscard]] FoundEdge line(int bin, double slope, double curvature_per_m) const;

  template <typename Taken>
  FoundEdge best(double curvature_per_m, double side, const Taken& is_taken) const {
    const double least = parameters_.start_log_odds - parameters_.prior_log_odds;
    const auto first = static_cast<int>(parameters_.least_distance_m / bin_m_);
    const auto separate = static_cast<int>(parameters_.separation_m / bin_m_);
    FoundEdge found;
    for (int b = first, last = static_cast<int>(kBins) - kBand; b < last; ++b) {
      for (int k = -kSlopes; k <= kSlopes; ++k) {
        const double slope = k * parameters_.slope_step;
        const double sum = votes(b, slope);
        if (sum < least || sum <= found.votes) continue;
        if (is_taken((b + 0.5 * kBand) * bin_m_ + slope * kReference_m)) continue;
        found = line(b, slope, curvature_per_m);
        last = std::min(last, b + separate);  // what is farther out is another line
      }
    }
    found.c(0) *= side;
    found.c(1) *= side;
    return found;
  }

  RoadEdgeParameters parameters_;
  ContrastVote vote_;
  double bin_m_, behind_m_;
  std::array<std::array<float, kBins + 1>, kSegments> sums_{};  // by segment: detections before a bin
  std::array<std::array<float, kBins>, kSegments> votes_{};     // by segment: of the line whose band begins with a bin
};

}  // namespace boresight::tracking
