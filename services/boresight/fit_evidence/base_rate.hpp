// What a filter without evidence could state.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>

namespace boresight::fit_evidence {

/// Share of real ones among a radar's moving detections of the past, with exponential memory. It gets the labels of the
/// past, which no product has.
class BaseRate {
 public:
  /// For a scan of the radar at `t_s`, before its detections are added. Times of a radar rise.
  [[nodiscard]] double at(std::uint32_t radar, double t_s) {
    Sums& s = sums_[radar];
    const double keep = std::exp(-(t_s - s.t_s) / kMemory_s);
    s.t_s = t_s;
    s.real *= keep;
    s.all *= keep;
    return (s.real + 0.5 * kPrior) / (s.all + kPrior);
  }
  void add(std::uint32_t radar, bool is_real) {
    Sums& s = sums_[radar];
    s.real += is_real ? 1.0 : 0.0;
    s.all += 1.0;
  }

  static constexpr double kMemory_s = 30.0;
  static constexpr double kPrior = 1.0;  ///< detections, half of them real

 private:
  struct Sums {
    double real = 0.0, all = 0.0, t_s = 0.0;
  };
  std::map<std::uint32_t, Sums> sums_;
};

}  // namespace boresight::fit_evidence
