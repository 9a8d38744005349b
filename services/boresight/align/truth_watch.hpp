// The truth of a simulated drive beside a radar's estimate: time to 95 %, errors and NEES.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "services/alignment_estimator/core/method.hpp"
#include "services/boresight/align/result.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::align {

class TruthWatch {
 public:
  TruthWatch(const std::optional<Truth>& truth, const RadarConfig& config);

  /// Whether the truth contains the radar; without it the others do nothing.
  [[nodiscard]] bool is_known() const { return !mountings_.empty(); }
  void observe(const RadarConfig& config, const alignment::RadarEstimate& estimate, double time_s);
  [[nodiscard]] TruthComparison compare(const RadarConfig& config, const RadarResult& result) const;

 private:
  std::vector<TruthComparison::Mounting> mountings_;
  std::size_t now_ = 0;
  std::array<double, kParameters> change_begin_{}, change_begin_s_{}, seconds_to_95_percent_{};
};

/// The truth of the vehicle's speed scale as sample_of() combines it: the mean of what each radar sees, with the
/// weights of the estimate.
[[nodiscard]] std::optional<double> true_speed_scale(const Truth& truth, const Result& result);

}  // namespace boresight::align
