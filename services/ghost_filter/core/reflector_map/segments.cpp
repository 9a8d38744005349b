#include "services/ghost_filter/core/reflector_map/segments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace boresight::ghosts {

namespace {

constexpr double kChordSag_m = 0.2;  // by which an arc leaves its chords at most

void write_stretch(const Reflector& r, double begin, double end, const Odometry& odometry, ClassifiedScan& out) {
  const double longest = std::abs(r.curve.curvature_per_m) < 1e-5
                             ? end - begin
                             : std::sqrt(8.0 * kChordSag_m / std::abs(r.curve.curvature_per_m));
  const int pieces = std::clamp(static_cast<int>(std::ceil((end - begin) / std::max(1.0, longest))), 1, 16);
  for (int k = 0; k < pieces && out.number_of_reflector_segments < kMaxReflectorSegments; ++k) {
    const auto at = [&](int n) -> std::array<float, 2> {
      const double arc = begin + (end - begin) * n / pieces;
      const Eigen::Vector2f p = odometry.point_to_vehicle(r.curve.at(arc)).cast<float>();
      return {p.x(), p.y()};
    };
    out.reflector_segments[out.number_of_reflector_segments++] = {at(k), at(k + 1), static_cast<float>(r.residual_m),
                                                                  r.detections};
  }
}

}  // namespace

void write_segments(std::span<const Reflector> reflectors, const Odometry& odometry, ClassifiedScan& out) {
  out.number_of_reflector_segments = 0;
  std::array<const Reflector*, kMaxReflectorSegments> order;
  std::size_t number = 0;
  for (const Reflector& r : reflectors) {
    if (r.log_odds > 0.0 && number < order.size()) order[number++] = &r;
  }
  const auto last = order.begin() + static_cast<std::ptrdiff_t>(number);
  std::sort(order.begin(), last, [](const Reflector* a, const Reflector* b) { return a->detections > b->detections; });
  for (std::size_t i = 0; i < number; ++i) {
    const Reflector& r = *order[i];
    const Occupancy& o = r.occupancy;
    std::int32_t begin = o.first();
    for (std::int32_t bin = o.first(); bin <= o.last() + 1; ++bin) {
      if (bin <= o.last() && !o.is_open(bin)) continue;
      if (bin > begin) {
        write_stretch(r, begin * o.bin_m() - r.arc_shift_m, bin * o.bin_m() - r.arc_shift_m, odometry, out);
      }
      begin = bin + 1;
    }
  }
}

}  // namespace boresight::ghosts
