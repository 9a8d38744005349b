// A step of a quantity that all radars share: the body's pitch by load, or the scale of the speed signal.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "services/alignment_estimator/core/windows/change_monitor.hpp"

namespace boresight::alignment::windows {

struct CommonStep {
  double size = 0.0, std = 0.0;
  std::size_t blocks_ago = 0;  ///< number of blocks since the step
};

/// Likelihood ratio of a step against none, over the time of the step. The blocks scatter around their mean with a
/// variance and a correlation from block to block that are learnt from themselves.
class CommonWatch {
 public:
  explicit CommonWatch(const CommonConfig& config) : config_(config) {}

  /// Adds what a block says. Returns the likeliest step, if it is large enough; then only the blocks since it are kept.
  [[nodiscard]] std::optional<CommonStep> add(double value);
  void restart() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  static constexpr std::size_t kMaxAfter = 30, kMinBefore = 15, kHistory = 90;
  CommonConfig config_;
  std::array<double, kHistory> values_{};  ///< oldest first
  std::size_t size_ = 0;
};

/// Mean over the radars of what their latest blocks say about one quantity, each with its std and a spread between
/// radars; none if fewer than two do.
[[nodiscard]] std::optional<double> common_mean(const std::vector<double>& values, const std::vector<double>& stds,
                                                double spread);

}  // namespace boresight::alignment::windows
