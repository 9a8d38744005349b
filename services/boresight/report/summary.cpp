#include "services/boresight/report/summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::report {

namespace {

using monitor::RadarSnapshot;
using monitor::Snapshot;

/// Sum of a counter that may have restarted at zero.
class Counter {
 public:
  void see(std::uint64_t value) {
    if (value < last_) finished_ += last_;
    last_ = value;
  }
  [[nodiscard]] std::uint64_t total() const { return finished_ + last_; }

 private:
  std::uint64_t finished_ = 0;
  std::uint64_t last_ = 0;
};

/// Sums over the drive.
struct RadarSums {
  Counter scans;
  Counter lost;
  std::array<Counter, 6> classified;
  Counter rejected, scans_with_labels, without_tracks;
  double nees = 0.0;
  int known_nees = 0;
};

void see_labels(const monitor::LabelCounts& labels, RadarSums& sums) {
  for (std::size_t i = 0; i < labels.classified.size(); ++i) sums.classified[i].see(labels.classified[i]);
  sums.rejected.see(labels.rejected);
  sums.scans_with_labels.see(labels.scans);
  sums.without_tracks.see(labels.scans_without_tracks);
}

monitor::LabelCounts labels_of(const RadarSums& sums) {
  monitor::LabelCounts labels;
  for (std::size_t i = 0; i < labels.classified.size(); ++i) labels.classified[i] = sums.classified[i].total();
  labels.rejected = sums.rejected.total();
  labels.scans = sums.scans_with_labels.total();
  labels.scans_without_tracks = sums.without_tracks.total();
  return labels;
}

void add_labels(const monitor::LabelCounts& labels, monitor::LabelCounts& sum) {
  for (std::size_t i = 0; i < labels.classified.size(); ++i) sum.classified[i] += labels.classified[i];
  sum.rejected += labels.rejected;
  sum.scans += labels.scans;
  sum.scans_without_tracks += labels.scans_without_tracks;
}

std::uint64_t number_of_scans(const Snapshot& snapshot) {
  std::uint64_t scans = 0;
  for (const RadarSnapshot& radar : snapshot.radars) scans += radar.scans;
  return scans;
}

/// Latencies of the whole run: the last histogram before each restart of the monitor, and the last of all.
void add_latencies(const std::vector<Snapshot>& snapshots, Summary& summary) {
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    const bool last = i + 1 == snapshots.size();
    for (std::size_t k = 0; k < monitor::kNumberOfLatencies; ++k) {
      const bool restarts = !last && snapshots[i + 1].latencies[k].total() < snapshots[i].latencies[k].total();
      if (last || restarts) summary.latencies[k].merge(snapshots[i].latencies[k]);
    }
  }
}

void add_services(const std::vector<Snapshot>& snapshots, Summary& summary) {
  for (std::size_t k = 0; k < snapshots.back().services.size(); ++k) {
    monitor::ServiceSnapshot sum = snapshots.back().services[k];
    std::array<Counter, kNumberOfFaults> faults;
    for (const Snapshot& snapshot : snapshots) {
      if (k >= snapshot.services.size()) continue;
      const monitor::ServiceSnapshot& seen = snapshot.services[k];
      for (std::size_t f = 0; f < kNumberOfFaults; ++f) faults[f].see(seen.faults[f]);
      sum.processing_max_us = std::max(sum.processing_max_us, seen.processing_max_us);
      sum.heap_allocations = std::max(sum.heap_allocations, seen.heap_allocations);
      sum.restarts = std::max(sum.restarts, seen.restarts);
    }
    for (std::size_t f = 0; f < kNumberOfFaults; ++f) sum.faults[f] = faults[f].total();
    summary.services.push_back(sum);
  }
}

void add_tracks(const std::vector<Snapshot>& snapshots, Summary& summary) {
  std::set<std::uint32_t> ids;
  for (const Snapshot& snapshot : snapshots) {
    std::size_t confirmed = 0;
    for (const auto& track : snapshot.tracks) {
      if (!track.confirmed) continue;
      ++confirmed;
      ids.insert(track.id);
    }
    summary.most_confirmed_tracks = std::max(summary.most_confirmed_tracks, confirmed);
  }
  summary.distinct_confirmed_tracks = ids.size();
}

void add_radars(const std::vector<Snapshot>& snapshots, const Truth& truth, Summary& summary) {
  const auto first = std::find_if(snapshots.begin(), snapshots.end(), number_of_scans);
  const std::int64_t begin_ns = first == snapshots.end() ? snapshots.back().time_ns : first->time_ns;
  std::map<std::uint32_t, RadarSums> sums;
  std::map<std::uint32_t, RadarSummary> radars;
  std::uint64_t scans_before = 0;
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    const Snapshot& snapshot = snapshots[i];
    // The health reports after the last scan of the drive (NO_DATA) are no verdict on the drive.
    const bool goes_on = i + 1 < snapshots.size() && number_of_scans(snapshots[i + 1]) != number_of_scans(snapshot);
    const double t_s = static_cast<double>(snapshot.time_ns - begin_ns) * 1e-9;
    for (const RadarSnapshot& seen : snapshot.radars) {
      RadarSummary& radar = radars[seen.id];
      RadarSums& sum = sums[seen.id];
      sum.scans.see(seen.scans);
      sum.lost.see(seen.lost);
      see_labels(seen.labels, sum);
      if (goes_on && std::isfinite(seen.details.nees)) {
        sum.nees += seen.details.nees;
        ++sum.known_nees;
      }
      const bool misaligned = seen.extended_qualifier == ExtendedQualifier::kMisaligned;
      if (misaligned && radar.first_misaligned_s < 0) radar.first_misaligned_s = t_s;
      if (goes_on || radar.last.scans == 0) {
        radar.last = seen;
        radar.misaligned = misaligned;
      }
    }
    if (number_of_scans(snapshot) != scans_before) summary.duration_s = t_s;
    scans_before = number_of_scans(snapshot);
  }
  for (auto& [id, radar] : radars) {
    const RadarSums& sum = sums[id];
    radar.last.scans = sum.scans.total();
    radar.last.lost = sum.lost.total();
    radar.last.labels = labels_of(sum);
    add_labels(radar.last.labels, summary.labels);
    if (sum.known_nees > 0) radar.mean_nees = sum.nees / sum.known_nees;
    if (const auto found = truth.speed_scales.find(id); found != truth.speed_scales.end()) {
      radar.true_speed_scale = found->second;
    }
    if (const auto found = truth.vehicle_rad.find(id); found != truth.vehicle_rad.end()) {
      radar.true_vehicle_rad = found->second;
    }
    if (const auto found = truth.yaw_rad.find(id); found != truth.yaw_rad.end()) {
      radar.true_yaw_rad = found->second;
      radar.expected_to_be_misaligned = std::abs(found->second) > radar.last.yaw_tolerance_rad;
      radar.expected_to_be_aligned = !radar.expected_to_be_misaligned;
    }
    if (const auto found = truth.misaligned.find(id); found != truth.misaligned.end()) {
      radar.expected_to_be_misaligned = found->second.at_end;
      radar.expected_to_be_aligned = !found->second.ever;
    }
    summary.radars.push_back(radar);
  }
}

void add_checks(const Truth& truth, Summary& summary) {
  std::uint64_t lost = 0;
  bool all_heard = !summary.radars.empty();
  for (const RadarSummary& radar : summary.radars) {
    lost += radar.last.lost;
    all_heard = all_heard && radar.last.scans > 0;
  }
  std::uint64_t lost_inputs = 0;
  std::uint64_t restarts = 0;
  for (const auto& service : summary.services) {
    lost_inputs += service.faults[static_cast<std::size_t>(Fault::kInputLost)];
    restarts += service.restarts;
  }
  const auto check = [&summary](std::string what, bool passed) {
    summary.checks.push_back({std::move(what), passed, false});
  };
  check("every radar delivered scans", all_heard);
  if (!summary.is_offline) {
    check(fmt::format("no scan was lost (monitor: {} scans, services: {} inputs)", lost, lost_inputs),
          lost + lost_inputs == 0);
  }
  check(fmt::format("objects were tracked ({} in total, up to {} at the same time)", summary.distinct_confirmed_tracks,
                    summary.most_confirmed_tracks),
        summary.distinct_confirmed_tracks > 0);
  if (!summary.is_offline) {
    check(fmt::format("no service had to be restarted ({} restarts)", restarts), restarts == 0);
  }
  for (const RadarSummary& radar : summary.radars) {
    const auto sent = truth.scans.find(radar.last.id);
    if (sent == truth.scans.end()) continue;
    check(fmt::format("{}: {} of {} sent scans arrived", radar.last.name, radar.last.scans, sent->second),
          radar.last.scans == sent->second);
  }
  if (!truth.known()) return;
  for (const RadarSummary& radar : summary.radars) {
    if (radar.expected_to_be_misaligned) {
      check(radar.last.name + " is misaligned in the truth and was reported as MISALIGNED", radar.misaligned);
    } else if (radar.expected_to_be_aligned) {
      check(radar.last.name + " is within tolerance in the truth and was never reported as MISALIGNED",
            radar.first_misaligned_s < 0);
    }
  }
}

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

std::string render_latency_rows(const Summary& summary) {
  std::string text =
      fmt::format("\n  {:<20}{:>10}{:>10}{:>10}\n", "latency of a scan", "p50, µs", "p99, µs", "max, µs");
  for (std::size_t i = 0; i < monitor::kNumberOfLatencies; ++i) {
    const auto& h = summary.latencies[i];
    text += fmt::format("  {:<20}{:>10.0f}{:>10.0f}{:>10.0f}\n", monitor::kLatencyNames[i], h.percentile_us(0.5),
                        h.percentile_us(0.99), h.max_us());
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

bool Summary::all_passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed || check.aim; });
}

std::size_t Summary::missed_aims() const {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(), [](const Check& check) { return check.aim && !check.passed; }));
}

Check record_check(const std::string& record, const monitor::DamagedLines& damaged) {
  std::string what = fmt::format("every line of the {} could be read ({} damaged", record, damaged.count);
  if (damaged.count > 0) what += fmt::format("; {}{}", damaged.count > 1 ? "first: " : "", damaged.first);
  return {what + ")", damaged.count == 0, false};
}

const char* word_of(const Check& check) {
  if (check.passed) return "ok";
  return check.aim ? "MISSED" : "FAILED";
}

Summary summarise(const std::vector<Snapshot>& snapshots, const Truth& truth) {
  Summary summary;
  if (snapshots.empty()) {
    summary.checks.push_back({"the monitor received messages of the running system", false, false});
    return summary;
  }
  summary.is_offline = snapshots.back().services.empty();
  add_radars(snapshots, truth, summary);
  add_tracks(snapshots, summary);
  add_latencies(snapshots, summary);
  add_services(snapshots, summary);
  add_checks(truth, summary);
  return summary;
}

bool has_estimate(const RadarSnapshot& radar) {
  return radar.yaw.observable &&
         (radar.state == AlignmentState::kConverged || radar.state == AlignmentState::kConverging);
}

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
  if (radar.misaligned) {
    return fmt::format("{}: MISALIGNED, yaw {}, beyond the tolerance of {:.1f}°", last.name, yaw_text(last),
                       tolerance_deg);
  }
  if (last.extended_qualifier != ExtendedQualifier::kNormal) {
    return fmt::format("{}: {} ({})", last.name, qualifier, name_of(last.extended_qualifier));
  }
  if (!has_estimate(last)) return fmt::format("{}: {}, no alignment estimate", last.name, qualifier);
  const bool within = std::abs(last.yaw.value_rad) <= last.yaw_tolerance_rad;
  return fmt::format("{}: {}, yaw {}, {} the tolerance of {:.1f}°", last.name, qualifier, yaw_text(last),
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
