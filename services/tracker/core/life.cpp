#include "services/tracker/core/life.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace boresight::tracking {

namespace {

std::uint32_t window_mask(std::size_t scans) {
  return scans >= TrackedObject::kLongestWindow ? ~0u : (1u << scans) - 1u;
}

}  // namespace

void count_scan(TrackedObject& track, const RulesConfig& config, double wait_s) {
  constexpr double kDetection = 0.8, kHitGain = 0.5;
  const bool hit = track.detections > 0;
  track.history = track.history << 1 | (hit ? 1u : 0u);
  std::shift_right(track.evidence.begin(), track.evidence.end(), 1);
  track.evidence[0] = hit ? static_cast<float>(track.realness) : 0.0F;
  track.seen_scans = std::min<std::uint32_t>(track.seen_scans + 1, TrackedObject::kLongestWindow);
  track.existence = hit ? track.existence + kHitGain * track.realness * (0.999 - track.existence)
                        : track.existence * (1.0 - kDetection) / (1.0 - kDetection * track.existence);
  const std::uint32_t recent = track.history & window_mask(config.confirm_window);
  const auto window = track.evidence.begin() + static_cast<std::ptrdiff_t>(config.confirm_window);
  const double evidence = std::accumulate(track.evidence.begin(), window, 0.0);
  const bool often = std::popcount(recent) >= static_cast<int>(config.confirm_hits);
  const double speed_mps = track.state.mean.segment<2>(2).norm();
  const bool weak = track.extent.is_too_weak(speed_mps);
  wait_s = std::max(config.confirm_age_s, wait_s);
  if (weak) wait_s = std::max(wait_s, config.confirm_weak_age_s);
  const bool long_enough = track.age_s > wait_s - 1e-6;
  if (often && long_enough && evidence >= config.confirm_evidence) track.confirmed = true;
  // What was taken for a person and goes faster than they do waits after all.
  if (weak && !long_enough && track.extent.was_small && Extent::outruns_people(speed_mps)) track.confirmed = false;
}

bool is_dead(const TrackedObject& track, const RulesConfig& config) {
  if (track.since_update_s > config.coast_s || !track.state.mean.allFinite() || !track.state.covariance.allFinite() ||
      !std::isfinite(track.state.heading.rad)) {
    return true;
  }
  const std::uint32_t seen = window_mask(track.seen_scans);
  const std::uint32_t misses = ~track.history & seen & window_mask(config.delete_window);
  // Several radars at one instant are one look, and what hides an object or makes it faint does so for many scans.
  const bool long_enough = !track.confirmed || track.since_update_s > config.delete_age_s - 1e-6;
  if (long_enough && std::popcount(misses) >= static_cast<int>(config.delete_misses)) return true;
  // A tentative track that can no longer be confirmed in its window gives up its place.
  const std::uint32_t window = seen & window_mask(config.confirm_window);
  const std::size_t early_misses = static_cast<std::size_t>(std::popcount(~track.history & window));
  return !track.confirmed && early_misses > config.confirm_window - config.confirm_hits;
}

}  // namespace boresight::tracking
