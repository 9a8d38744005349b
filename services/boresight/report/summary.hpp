// Results of a run: estimates of each radar, compared with the truth where it is known, and checks.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "services/boresight/monitor/damaged_lines.hpp"
#include "services/boresight/monitor/snapshot.hpp"

namespace boresight::report {

/// Whether a true angle of a radar is beyond its tolerance, as health judges it.
struct TrueMisalignment {
  bool ever = false;
  bool at_end = false;
};

/// The truth of a drive; empty where it is not known.
struct Truth {
  std::map<std::uint32_t, double> yaw_rad;                     ///< by radar id: actual − nominal mounting
  std::map<std::uint32_t, double> speed_scales;                ///< by radar id, as the radar sees it (DriveTruth)
  std::map<std::uint32_t, std::array<double, 3>> vehicle_rad;  ///< by radar id: yaw, pitch, roll of the rotation about
                                                               ///< the vehicle's axes, as AlignmentEstimate's
  std::map<std::uint32_t, std::uint64_t> scans;                ///< by radar id: how many the radar sent
  /// By radar id; a radar without an entry is judged by its yaw.
  std::map<std::uint32_t, TrueMisalignment> misaligned{};
  [[nodiscard]] bool known() const { return !yaw_rad.empty(); }
};

struct RadarSummary {
  monitor::RadarSnapshot last;  ///< while the radar was sending; counters are sums over the whole run
  std::optional<double> true_yaw_rad;
  std::optional<double> true_speed_scale;
  std::optional<std::array<double, 3>> true_vehicle_rad;
  double mean_nees = std::numeric_limits<double>::quiet_NaN();  ///< over the drive, where the truth is known
  bool misaligned = false;                 ///< verdict of the health service while the radar was sending
  bool expected_to_be_misaligned = false;  ///< in the truth, at the end of the drive
  bool expected_to_be_aligned = true;      ///< in the truth, during the whole drive
  double first_misaligned_s = -1.0;        ///< since the first scan of any radar; negative: never
};

/// A statement that must hold, or an aim: an aim that is missed is reported but fails nothing.
struct Check {
  std::string what;
  bool passed;
  bool aim = false;
};
/// That every line of a record ("record of scans") was whole.
[[nodiscard]] Check record_check(const std::string& record, const monitor::DamagedLines& damaged);
/// "ok", "FAILED", or "MISSED" of an aim.
[[nodiscard]] const char* word_of(const Check& check);

struct Summary {
  double duration_s = 0.0;  ///< from the first to the last scan seen
  std::string pace;         ///< "4 × real time"; empty: real time. Latencies and rates of another pace have no verdict
  std::vector<RadarSummary> radars;
  monitor::LabelCounts labels;  ///< of all radars
  std::size_t most_confirmed_tracks = 0;
  std::size_t distinct_confirmed_tracks = 0;
  bool is_offline = false;  ///< no services ran: no latencies, and no key figures of the estimator
  std::vector<monitor::ServiceSnapshot> services;
  std::array<LatencyHistogram, monitor::kNumberOfLatencies> latencies;
  std::vector<Check> checks;
  /// Checks only, without aims.
  [[nodiscard]] bool all_passed() const;
  [[nodiscard]] std::size_t missed_aims() const;
};

/// `snapshots` in the order of time. Counters may begin at zero again where the monitor was restarted.
[[nodiscard]] Summary summarise(const std::vector<monitor::Snapshot>& snapshots, const Truth& truth);

/// "front_right: MISALIGNED, " and the explanation of the health service, without one the yaw error.
[[nodiscard]] std::string verdict_line(const RadarSummary& radar);
/// "+2.512 ± 0.031°", or a dash without an estimate.
[[nodiscard]] std::string yaw_text(const monitor::RadarSnapshot& radar);
/// Whether there is an estimate to compare with a truth.
[[nodiscard]] bool has_estimate(const monitor::RadarSnapshot& radar);
/// The true yaw with the digits of the estimate, or a dash.
[[nodiscard]] std::string true_yaw_text(const RadarSummary& radar);
/// "1.01192 ± 0.00031", or a dash without an estimate.
[[nodiscard]] std::string speed_scale_text(const monitor::RadarSnapshot& radar);
/// "+0.021° (0.5 σ)": estimate − truth; "not observable", or a dash where the truth is not known.
[[nodiscard]] std::string error_text(const monitor::AngleEstimate& estimate, std::optional<double> truth_rad);
/// "+0.000012 (0.3 σ)", or a dash.
[[nodiscard]] std::string speed_scale_error_text(const RadarSummary& radar);
/// Shares of all detections: "moving 8.1 %, stationary 84.0 %, …"; empty without any detection.
[[nodiscard]] std::string labels_text(const monitor::LabelCounts& labels);
/// "All 19 checks passed, 1 of 4 aims was missed."
[[nodiscard]] std::string result_text(const Summary& summary);
/// For the terminal, several lines.
[[nodiscard]] std::string render_summary(const Summary& summary);

}  // namespace boresight::report
