#include "services/boresight/report/summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

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
  std::array<Counter, kNumberOfProvenances> classified;  ///< by Provenance
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
      sum.latency_max_us = std::max(sum.latency_max_us, seen.latency_max_us);
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
  std::uint64_t dropped_inputs = 0;
  std::uint64_t restarts = 0;
  for (const auto& service : summary.services) {
    lost_inputs += service.count(Fault::kInputLost);
    dropped_inputs += service.count(Fault::kInputDropped);
    restarts += service.restarts;
  }
  const auto check = [&summary](std::string what, bool passed) {
    summary.checks.push_back({std::move(what), passed, false});
  };
  check("every radar delivered scans", all_heard);
  if (!summary.is_offline) {
    // Dropping is what the services do on a computer that is busy for a moment: stated, but no failure.
    check(fmt::format("no scan was lost (monitor: {} scans, services: {} inputs; {} dropped for newer scans)", lost,
                      lost_inputs, dropped_inputs),
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

}  // namespace boresight::report
