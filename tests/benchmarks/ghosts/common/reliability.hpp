// Whether a probability is one: of all that were given 80 %, 80 % must be so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace boresight::bench {

class Reliability {
 public:
  /// Finer where a decision is sure: there a method claims most.
  static constexpr std::array<double, 15> kEdges = {0.0, 0.01, 0.05, 0.1, 0.2,  0.3,  0.4, 0.5,
                                                    0.6, 0.7,  0.8,  0.9, 0.95, 0.99, 1.0};
  static constexpr std::size_t kBins = kEdges.size() - 1;

  struct Bin {
    std::uint64_t count = 0, so = 0;
    double told = 0.0;  ///< sum
    [[nodiscard]] double mean_told() const { return told / static_cast<double>(count); }
    [[nodiscard]] double share() const { return static_cast<double>(so) / static_cast<double>(count); }
  };

  /// One that is not a number, or not in 0…1, counts as the worst possible.
  void add(double probability, bool is_so);
  void add(const Reliability& other);

  [[nodiscard]] const std::array<Bin, kBins>& bins() const { return bins_; }
  [[nodiscard]] std::uint64_t count() const;
  /// Mean |told − share| over the bins, weighted by their counts; NaN of nothing.
  [[nodiscard]] double calibration_error() const;
  /// Mean squared difference between what was told and what was so (Brier 1950); NaN of nothing.
  [[nodiscard]] double brier_score() const { return squares_ / static_cast<double>(count()); }

 private:
  std::array<Bin, kBins> bins_{};
  double squares_ = 0.0;
};

}  // namespace boresight::bench
