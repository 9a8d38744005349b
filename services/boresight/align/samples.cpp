#include "services/boresight/align/samples.hpp"

#include <algorithm>
#include <limits>

#include "services/boresight/align/stds.hpp"

namespace boresight::align {

namespace {

/// k_v of the vehicle: the mean of the radars' k_v, weighted by variance, if each radar has its own. The errors have a
/// common part, so the smallest std is used undivided.
void share_speed_scale(Sample& sample) {
  double sum = 0.0, weights = 0.0, best_std = std::numeric_limits<double>::infinity();
  for (const Sample::Radar& radar : sample.radars) {
    if ((radar.observable & alignment_axis::kSpeedScale) == 0) continue;
    const double weight = 1.0 / std::max(1e-18, radar.stds[0] * radar.stds[0]);
    sum += weight * radar.values[0];
    weights += weight;
    best_std = std::min(best_std, radar.stds[0]);
  }
  if (weights > 0.0) {
    sample.speed_scale = sum / weights;
    sample.speed_scale_std = best_std;
  } else if (!sample.radars.empty()) {
    sample.speed_scale = sample.radars.front().values[0];
    sample.speed_scale_std = sample.radars.front().stds[0];
  }
}

}  // namespace

Sample sample_of(const VehicleConfig& vehicle, double time_s, const std::vector<alignment::RadarEstimate>& estimates) {
  Sample sample;
  sample.x = time_s;
  for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
    const alignment::RadarEstimate& e = estimates[i];
    const alignment::VehicleForm form = alignment::vehicle_form(vehicle.radars[i], e);
    sample.radars.push_back({e.state, e.observable, to_array(form.values), stds_of(form)});
    // Shared by all radars, or known to one of them: the smallest std counts.
    const auto has_smaller_std = [](double std, double than) { return std > 0.0 && (than == 0.0 || std < than); };
    if (has_smaller_std(e.yaw_rate_bias_std_radps, sample.yaw_rate_bias_std_radps)) {
      sample.yaw_rate_bias_radps = e.yaw_rate_bias_radps;
      sample.yaw_rate_bias_std_radps = e.yaw_rate_bias_std_radps;
    }
    if (has_smaller_std(e.slip_coefficient_std_radps2pm, sample.slip_coefficient_std_radps2pm)) {
      sample.slip_coefficient_radps2pm = e.slip_coefficient_radps2pm;
      sample.slip_coefficient_std_radps2pm = e.slip_coefficient_std_radps2pm;
    }
  }
  share_speed_scale(sample);
  return sample;
}

}  // namespace boresight::align
