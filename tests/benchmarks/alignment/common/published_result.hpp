// Outcome of a method on drives like those of Burza's tables, over seeds and radars, with the quantities of the tables.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/benchmarks/alignment/common/runner.hpp"

namespace boresight::bench {

inline constexpr std::array<const char*, 4> kSensorParameters = {"k_v", "α", "β", "γ"};

struct PublishedResult {
  std::array<double, 4> iterations{};  ///< until 95 % of the initial error is removed: median
  std::array<double, 4> bias{};        ///< mean of |error averaged over the last fifth|; 1, degrees
  Moments corrected, uncorrected;
};

/// Error of (k_v, α, β, γ) by place; 1, degrees.
[[nodiscard]] double published_error(const RadarError& radar, std::size_t parameter);

/// A converged estimate still varies; Burza's tables call its mean error over the last fifth of the drive the bias.
[[nodiscard]] PublishedResult published_result(const std::vector<Run>& runs, double duration_s);

/// Cells for the header below: name, iterations, biases, residuals.
[[nodiscard]] std::vector<std::string> published_row(const std::string& name, const PublishedResult& result);
[[nodiscard]] std::vector<std::string> published_header(const std::string& first);

/// The specification of the set-up, once for each seed.
[[nodiscard]] std::vector<simulator::AlignmentSpec> of_seeds(const simulator::AlignmentSpec& spec, std::size_t seeds,
                                                             double duration_s);

}  // namespace boresight::bench
