// Whether a radar's scans arrive: in time, often enough, not too often, and without pauses.
#pragma once

#include <algorithm>
#include <cstdint>

#include "services/health/core/faults/status.hpp"
#include "services/health/core/rate_window.hpp"

namespace boresight::health {

struct DeliveryConfig {
  double min_rate_ratio = 0.7;    ///< a radar that delivers less than this share of its rate is RATE_REDUCED
  double max_rate_ratio = 1.3;    ///< one that delivers more than this share has a second sender (choice)
  double pauses_window_s = 5.0;   ///< in which pauses beyond the deadline are counted (choice)
  std::uint64_t most_pauses = 2;  ///< more of them are an intermittent radar, which is RATE_REDUCED (choice)
  double judged_scans = 10.0;     ///< scans that must be due before a rate is judged (choice: one is a tenth)
  double silence_scans = 7.0;  ///< mean intervals of an intermittent radar that are a silence (choice: 0.1 % by chance)
  double latency_budget_s = 0.15;  ///< from measurement to arrival, beside the radar's own latency (choice)
  double max_delayed_ratio = 0.2;  ///< a larger share of scans beyond the budget is DELAYED (choice)
};

/// Times are CLOCK_MONOTONIC, ns.
class DeliveryMonitor {
 public:
  DeliveryMonitor(const DeliveryConfig& config, double expected_rate_hz, double deadline_s, double latency_s,
                  double window_s, std::int64_t start_ns);

  /// A scan that arrived `age_ns` after its measurement; negative: not known.
  void observe(std::int64_t age_ns, std::int64_t now_ns);

  /// True if a scan arrived within the radar's deadline.
  [[nodiscard]] bool delivers(std::int64_t now_ns) const { return scans_ > 0 && now_ns - last_ns_ <= deadline_ns_; }
  /// Nothing for longer than the deadline; for an intermittent radar, than its pauses explain. After a silence it
  /// passes only with a known rate: otherwise a radar that loses most scans would seem sound in between.
  [[nodiscard]] TestResult silent(std::int64_t now_ns);
  [[nodiscard]] TestResult rate_reduced(std::int64_t now_ns);
  [[nodiscard]] TestResult rate_too_high(std::int64_t now_ns);
  [[nodiscard]] TestResult delayed(std::int64_t now_ns);

  /// Scans per second since the last silence; 0 while the radar is silent.
  [[nodiscard]] double rate_hz(std::int64_t now_ns) { return delivers(now_ns) ? rate_.rate_hz(now_ns) : 0.0; }
  [[nodiscard]] double expected_rate_hz() const { return expected_rate_hz_; }
  /// Seconds since the last scan; negative if there was none.
  [[nodiscard]] double last_seen_s(std::int64_t now_ns) const;
  [[nodiscard]] std::uint64_t scans() const { return scans_; }

 private:
  [[nodiscard]] std::int64_t silence_limit_ns(std::int64_t now_ns);
  /// Since the last silence, enough scans were due.
  [[nodiscard]] bool is_rate_known(std::int64_t now_ns) {
    return rate_.age_s(now_ns) * expected_rate_hz_ >= config_.judged_scans;
  }
  [[nodiscard]] bool is_intermittent(std::int64_t now_ns) { return pauses_.sum(now_ns) > config_.most_pauses; }

  DeliveryConfig config_;
  double expected_rate_hz_;
  std::int64_t deadline_ns_;
  std::int64_t silence_limit_ns_;  // since the last scan
  std::int64_t budget_ns_;
  std::int64_t start_ns_;
  std::int64_t last_ns_ = 0;
  std::uint64_t scans_ = 0;
  RateWindow rate_;      // begins anew after each silence
  RateWindow arrivals_;  // in the window of the pauses
  RateWindow pauses_;    // that ended in it
  RateWindow dated_;     // scans of known age
  RateWindow delayed_;   //
};

}  // namespace boresight::health
