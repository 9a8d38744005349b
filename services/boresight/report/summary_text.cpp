// The results of a run as text, for the terminal and for the cells of the page.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/report/summary.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::report {

namespace {

using monitor::RadarSnapshot;

/// Of the column with the names of the radars; longer names widen it.
std::size_t name_columns(const Summary& summary) {
  constexpr std::size_t kLeastNameColumns = 14;
  std::size_t width = kLeastNameColumns;
  for (const RadarSummary& radar : summary.radars) width = std::max(width, text::columns(radar.last.name) + 1);
  return width;
}

std::string render_radars(const Summary& summary) {
  std::string text =
      "  mounting error in yaw and speed scale (true / signalled speed) of each radar, with the σ that the estimator "
      "states\n";
  const std::size_t name_width = name_columns(summary);
  constexpr const char* kRow = "  {}{:>7}{:>6}   {:<20}{:<11}{}\n";
  text += fmt::format(fmt::runtime(kRow), text::padded("radar", name_width), "scans", "lost", "yaw error ± σ", "truth",
                      "speed scale ± σ");
  for (const RadarSummary& radar : summary.radars) {
    const RadarSnapshot& last = radar.last;
    text += fmt::format(fmt::runtime(kRow), text::padded(last.name, name_width), last.scans, last.lost, yaw_text(last),
                        true_yaw_text(radar), speed_scale_text(last));
  }
  return text;
}

/// The error of every parameter, and whether it agrees with its σ; nothing where no truth is known.
std::string render_truth(const Summary& summary) {
  std::string text;
  const std::size_t name_width = name_columns(summary);
  constexpr const char* kRow = "  {}{:<22}{:<19}{:<19}{:<19}{:>6}{:>6}\n";
  for (const RadarSummary& radar : summary.radars) {
    if (!radar.true_vehicle_rad || !has_estimate(radar.last)) continue;
    const monitor::AlignmentDetails& d = radar.last.details;
    const std::array<double, 3>& truth = *radar.true_vehicle_rad;
    text += fmt::format(fmt::runtime(kRow), text::padded(radar.last.name, name_width), speed_scale_error_text(radar),
                        error_text(d.yaw, truth[0]), error_text(d.pitch, truth[1]), error_text(d.roll, truth[2]),
                        text::fixed(d.nees, 2), text::fixed(radar.mean_nees, 2));
  }
  if (text.empty()) return text;
  return "  error = estimate - truth, about the vehicle's axes; in parentheses relative to the stated σ\n" +
         fmt::format(fmt::runtime(kRow), text::padded("radar", name_width), "speed scale", "yaw", "pitch", "roll",
                     "NEES", "mean") +
         text +
         "  NEES: squared errors relative to the stated covariance, per parameter; 1 on average if σ is right (mean: "
         "of the drive)\n\n";
}

/// From the arrival of a scan to the output of stage `i` of monitor::kLatencyNames; 0 if it is not known.
double longest_since_arrival_us(const Summary& summary, std::size_t i) {
  constexpr std::array kStages = {catalogue::Service::kIngestGateway, catalogue::Service::kDetectionCorrector,
                                  catalogue::Service::kGhostFilter, catalogue::Service::kTracker};
  for (const monitor::ServiceSnapshot& service : summary.services) {
    if (i < kStages.size() && service.service == kStages[i]) return service.latency_max_us;
  }
  return 0.0;
}

std::string render_latency_rows(const Summary& summary) {
  std::string text = fmt::format("\n  {:<20}{:>10}{:>10}{:>10}   {}\n", "latency of a scan", "p50, µs", "p99, µs",
                                 "max, µs", "max since its arrival, µs");
  for (std::size_t i = 0; i < monitor::kNumberOfLatencies; ++i) {
    const auto& h = summary.latencies[i];
    text += fmt::format("  {:<20}{:>10.0f}{:>10.0f}{:>10.0f}", monitor::kLatencyNames[i], h.percentile_us(0.5),
                        h.percentile_us(0.99), h.max_us());
    const double since_arrival_us = longest_since_arrival_us(summary, i);
    text += since_arrival_us > 0.0 ? fmt::format("{:>28.0f}\n", since_arrival_us) : "\n";
  }
  return text;
}

std::string render_faults(const Summary& summary) {
  std::string text;
  for (const auto& service : summary.services) {
    for (std::size_t f = 0; f < kNumberOfFaults; ++f) {
      if (service.faults[f] == 0) continue;
      text += fmt::format("    {}: {} × {}\n", catalogue::name_of(service.service), service.faults[f],
                          name_of(static_cast<Fault>(f)));
    }
  }
  return text.empty() ? "  faults reported by services: none\n" : "  faults reported by services:\n" + text;
}

}  // namespace

std::string error_text(const monitor::AngleEstimate& estimate, std::optional<double> truth_rad) {
  if (!truth_rad) return std::string(text::kUnknown);
  if (!estimate.observable) return "not observable";
  return text::error_in_stds((estimate.value_rad - *truth_rad) * kDegreesPerRadian,
                             estimate.std_rad * kDegreesPerRadian, "°");
}

std::string speed_scale_error_text(const RadarSummary& radar) {
  if (!radar.true_speed_scale || !has_estimate(radar.last)) return std::string(text::kUnknown);
  return text::error_in_stds(radar.last.speed_scale - *radar.true_speed_scale, radar.last.speed_scale_std);
}

std::string yaw_text(const RadarSnapshot& radar) {
  if (!has_estimate(radar)) return std::string(text::kUnknown);
  return text::with_std(radar.yaw.value_rad * kDegreesPerRadian, radar.yaw.std_rad * kDegreesPerRadian, "°",
                        text::Sign::kAlways);
}

std::string true_yaw_text(const RadarSummary& radar) {
  if (!radar.true_yaw_rad) return std::string(text::kUnknown);
  const double std_rad = has_estimate(radar.last) ? radar.last.yaw.std_rad : 0.0;
  return text::rounded(*radar.true_yaw_rad * kDegreesPerRadian, std_rad * kDegreesPerRadian, "°", text::Sign::kAlways);
}

std::string speed_scale_text(const RadarSnapshot& radar) {
  if (!has_estimate(radar)) return std::string(text::kUnknown);
  return text::with_std(radar.speed_scale, radar.speed_scale_std);
}

std::string verdict_line(const RadarSummary& radar) {
  const RadarSnapshot& last = radar.last;
  const std::string_view qualifier = name_of(last.data_qualifier);
  const double tolerance_deg = last.yaw_tolerance_rad * kDegreesPerRadian;
  if (radar.misaligned && !last.explanation.empty())
    return fmt::format("{}: MISALIGNED, {}", last.name, last.explanation);
  if (radar.misaligned && !(std::abs(last.yaw.value_rad) > last.yaw_tolerance_rad)) {
    return fmt::format("{}: MISALIGNED, an axis other than yaw is beyond its tolerance", last.name);
  }
  if (radar.misaligned) {
    return fmt::format("{}: MISALIGNED, yaw {}, beyond the tolerance of {:.3g}°", last.name, yaw_text(last),
                       tolerance_deg);
  }
  if (last.extended_qualifier != ExtendedQualifier::kNormal) {
    return fmt::format("{}: {} ({}){}{}", last.name, qualifier, name_of(last.extended_qualifier),
                       last.explanation.empty() ? "" : ", ", last.explanation);
  }
  if (!has_estimate(last)) {
    return fmt::format("{}: {}, no alignment estimate{}{}", last.name, qualifier, last.explanation.empty() ? "" : ": ",
                       last.explanation);
  }
  const bool within = std::abs(last.yaw.value_rad) <= last.yaw_tolerance_rad;
  return fmt::format("{}: {}, yaw {}, {} the tolerance of {:.3g}°", last.name, qualifier, yaw_text(last),
                     within ? "within" : "not significantly beyond", tolerance_deg);
}

std::string labels_text(const monitor::LabelCounts& labels) {
  const std::uint64_t all = labels.detections();
  if (all == 0) return {};
  std::string text;
  const auto put = [&text, all](std::string_view what, std::uint64_t count) {
    text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ", what,
                        100.0 * static_cast<double>(count) / static_cast<double>(all));
  };
  for (const Provenance label : {Provenance::kMoving, Provenance::kStationary, Provenance::kGhostType1,
                                 Provenance::kGhostType2, Provenance::kClutter}) {
    const bool ghost = label == Provenance::kGhostType1 || label == Provenance::kGhostType2;
    put((ghost ? "ghost " : "") + std::string(name_of(label)), labels.of(label));
  }
  if (labels.of(Provenance::kAmbiguity) > 0) put(name_of(Provenance::kAmbiguity), labels.of(Provenance::kAmbiguity));
  if (labels.of(Provenance::kUnknown) > 0) put("not classified", labels.of(Provenance::kUnknown));
  if (labels.rejected > 0) put("rejected by the corrector", labels.rejected);
  return text;
}

std::string render_summary(const Summary& summary) {
  std::string text = summary.pace.empty() ? fmt::format("\nSummary of {:.0f} s of driving\n\n", summary.duration_s)
                                          : fmt::format("\nSummary of a drive, played in {:.0f} s ({})\n\n",
                                                        summary.duration_s, summary.pace);
  text += render_radars(summary) + "\n" + render_truth(summary);
  for (const RadarSummary& radar : summary.radars) text += "  " + verdict_line(radar) + "\n";
  if (!summary.is_offline) text += render_latency_rows(summary);
  if (!summary.pace.empty()) text += "  Not played in real time: latencies, rates and times have no verdict.\n";
  const std::string labels = labels_text(summary.labels);
  if (!labels.empty()) {
    text += fmt::format("\n  {} detections classified: {}\n", text::grouped(summary.labels.detections()), labels);
    text += fmt::format("  {} of {} scans were classified without tracks\n",
                        text::grouped(summary.labels.scans_without_tracks), text::grouped(summary.labels.scans));
  }
  text += "\n" + (!summary.is_offline ? render_faults(summary) + "\n" : "");
  for (const Check& check : summary.checks) {
    text += fmt::format("  [{}] {}\n", word_of(check), check.what);
  }
  return text + "\n  " + result_text(summary) + "\n";
}

std::string result_text(const Summary& summary) {
  std::size_t checks = 0, failed = 0;
  for (const Check& check : summary.checks) {
    if (check.aim) continue;
    ++checks;
    failed += check.passed ? 0 : 1;
  }
  const std::size_t aims = summary.checks.size() - checks, missed = summary.missed_aims();
  std::string text =
      failed == 0 ? fmt::format("All {} checks passed", checks) : fmt::format("{} of {} checks FAILED", failed, checks);
  if (aims > 0 && missed == 0) text += fmt::format(", all {} aims were reached", aims);
  if (missed > 0) text += fmt::format(", {} of {} aims {} missed", missed, aims, missed == 1 ? "was" : "were");
  return text + ".";
}

}  // namespace boresight::report
