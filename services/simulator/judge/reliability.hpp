// Calibration of a probability: of all cases given 80 %, 80 % must be so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::judge {

class Reliability {
 public:
  /// Finer near 0 and 1, where most probabilities lie.
  static constexpr std::array<double, 15> kEdges = {0.0, 0.01, 0.05, 0.1, 0.2,  0.3,  0.4, 0.5,
                                                    0.6, 0.7,  0.8,  0.9, 0.95, 0.99, 1.0};
  static constexpr std::size_t kBins = kEdges.size() - 1;

  struct Bin {
    std::uint64_t count = 0, so = 0;
    double probability_sum = 0.0;  ///< sum
    [[nodiscard]] double mean_probability() const { return probability_sum / static_cast<double>(count); }
    [[nodiscard]] double share() const { return static_cast<double>(so) / static_cast<double>(count); }
  };

  /// A value that is not a number, or not in 0…1, counts as the worst possible probability.
  void add(double probability, bool is_so);
  void add(const Reliability& other);

  [[nodiscard]] const std::array<Bin, kBins>& bins() const { return bins_; }
  [[nodiscard]] std::uint64_t count() const;
  /// Expected calibration error: mean |mean probability − share| over the bins, weighted by their counts; NaN without
  /// data.
  [[nodiscard]] double calibration_error() const;
  /// Mean squared difference between probability and outcome (Brier 1950); NaN without data.
  [[nodiscard]] double brier_score() const { return squares_ / static_cast<double>(count()); }

 private:
  std::array<Bin, kBins> bins_{};
  double squares_ = 0.0;
};

}  // namespace boresight::judge
