#include "services/boresight/report/ghost_findings.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "interfaces/messages/names.hpp"
#include "services/boresight/report/recorded_scans.hpp"
#include "services/common/text/measured.hpp"
#include "services/simulator/judge/matching.hpp"

namespace boresight::report {

namespace {

/// A scan of the record is a scan of the truth if their times differ by less: far below the cycle time of any radar,
/// far above the variation of the gateway's mapping from the sensor's clock to the ECU's.
constexpr double kSameTime_s = 0.01;
constexpr std::int64_t kView_ns = 100'000'000;  // scans that are shown together: two cycles of 50 ms

/// The scan of the truth at that time with as many detections, or null.
const judge::TrueScan* scan_at(const judge::TrueScans& truth, std::uint32_t radar, double t_s, std::size_t detections) {
  const auto of_radar = truth.find(radar);
  if (of_radar == truth.end()) return nullptr;
  const std::vector<judge::TrueScan>& scans = of_radar->second;
  auto found = std::lower_bound(scans.begin(), scans.end(), t_s - kSameTime_s,
                                [](const judge::TrueScan& scan, double time) { return scan.t_s < time; });
  for (; found != scans.end() && found->t_s <= t_s + kSameTime_s; ++found) {
    if (found->detections.size() == detections) return &*found;
  }
  return nullptr;
}

/// The ECU time at which the drive began. Stamps do not state where a replay began, and sequence numbers would be wrong
/// by every lost scan. Each scan of the truth that may be the first recorded one is tried; the one that lets most of
/// the other recorded scans find theirs is taken.
std::optional<std::int64_t> beginning(const std::vector<score::RunScan>& seen, const judge::TrueScans& truth) {
  if (seen.empty()) return std::nullopt;
  const auto of_radar = truth.find(seen.front().radar);
  if (of_radar == truth.end()) return std::nullopt;
  constexpr std::size_t kTried = 400;  // of the scans: enough to distinguish one place from every other
  const std::size_t step = std::max<std::size_t>(1, seen.size() / kTried);
  std::int64_t best_ns = 0;
  std::size_t most = 0;
  for (const judge::TrueScan& first : of_radar->second) {
    if (first.detections.size() != seen.front().detections) continue;
    const std::int64_t begin_ns = seen.front().time_ns - static_cast<std::int64_t>(first.t_s * 1e9);
    std::size_t found = 0;
    for (std::size_t i = 0; i < seen.size(); i += step) {
      const double t_s = static_cast<double>(seen[i].time_ns - begin_ns) * 1e-9;
      found += scan_at(truth, seen[i].radar, t_s, seen[i].detections) != nullptr ? 1 : 0;
    }
    if (found > most) {
      most = found;
      best_ns = begin_ns;
    }
  }
  if (most == 0) return std::nullopt;
  return best_ns;
}

bool is_ghost(Provenance provenance) {
  return provenance == Provenance::kGhostType1 || provenance == Provenance::kGhostType2;
}

/// The latest scan of a radar with its truth.
struct Recent {
  std::unique_ptr<ClassifiedScan> scan;
  const judge::TrueScan* truth = nullptr;
  std::size_t ghosts = 0;
  std::size_t mistakes = 0;
};

class Finder {
 public:
  Finder(const DetectionTruths* truth, std::optional<std::int64_t> begin_ns) : truth_(truth), begin_ns_(begin_ns) {
    if (truth_ != nullptr) out_.confusion.emplace();
  }
  void take(const ClassifiedScan& scan, const TrackList& list) {
    ++out_.scans;
    const std::int64_t time_ns = scan.header.measurement_time_ns;
    out_.first_scan_ns = out_.scans == 1 ? time_ns : std::min(out_.first_scan_ns, time_ns);
    *tracks_ = list;
    const std::size_t count = scan.number_of_valid_detections;
    Recent& recent = recent_[scan.header.source_id];
    if (!recent.scan) recent.scan = std::make_unique<ClassifiedScan>();
    *recent.scan = scan;
    recent.ghosts = recent.mistakes = 0;
    recent.truth = truth_ != nullptr && begin_ns_
                       ? scan_at(truth_->scans, scan.header.source_id, seconds(time_ns), count)
                       : nullptr;
    if (truth_ != nullptr && count > 0) ++(recent.truth != nullptr ? out_.compared_scans : out_.unknown_scans);
    for (std::size_t i = 0; i < count; ++i) {
      const bool rejected = (scan.detection_flags[i] & corrected_flag::kRejected) != 0;
      if (is_ghost(scan.provenance[i])) ++recent.ghosts;
      if (recent.truth == nullptr) continue;
      const Provenance is = recent.truth->detections[i].provenance;
      out_.confusion->add(is, scan.provenance[i], rejected);
      if (!rejected && is != scan.provenance[i]) ++recent.mistakes;
    }
    if (recent.truth != nullptr) {
      const judge::Matching matching =
          judge::match(list, list.number_of_confirmed_tracks, truth_->objects.at(seconds(time_ns)));
      false_tracks_.add(static_cast<double>(time_ns) * 1e-9, scan, recent.truth->detections, list, matching);
    }
    look(time_ns);
  }
  [[nodiscard]] GhostFindings finish() {
    out_.ghost_tracks = false_tracks_.long_ghost_tracks();
    out_.other_false_tracks = false_tracks_.long_other_tracks();
    return std::move(out_);
  }

 private:
  [[nodiscard]] double seconds(std::int64_t time_ns) const { return static_cast<double>(time_ns - *begin_ns_) * 1e-9; }
  /// The latest scan of each radar within kView_ns of the time.
  [[nodiscard]] std::vector<const Recent*> together(std::int64_t now_ns) const {
    std::vector<const Recent*> scans;
    for (const auto& [radar, recent] : recent_) {
      if (std::abs(now_ns - recent.scan->header.measurement_time_ns) < kView_ns) scans.push_back(&recent);
    }
    return scans;
  }
  void look(std::int64_t now_ns) {
    const std::vector<const Recent*> scans = together(now_ns);
    std::size_t ghosts = 0, mistakes = 0;
    for (const Recent* recent : scans) {
      ghosts += recent->ghosts;
      mistakes += recent->mistakes;
    }
    if (ghosts > most_ghosts_) {
      most_ghosts_ = ghosts;
      out_.most_ghosts = view(scans);
    }
    const bool settled = static_cast<double>(now_ns - out_.first_scan_ns) * 1e-9 >= GhostFindings::kFirstMoments_s;
    if (settled && mistakes > most_mistakes_) {
      most_mistakes_ = mistakes;
      out_.most_mistakes = view(scans);
    }
  }
  [[nodiscard]] PlanView view(const std::vector<const Recent*>& scans) const {
    PlanView view;
    const ClassifiedScan* latest = scans.front()->scan.get();
    for (const Recent* recent : scans) {
      if (recent->scan->header.measurement_time_ns > latest->header.measurement_time_ns) latest = recent->scan.get();
    }
    view.time_ns = latest->header.measurement_time_ns;
    const auto age_s = [&view](const MessageHeader& header) {
      return static_cast<double>(view.time_ns - header.measurement_time_ns) * 1e-9;
    };
    for (const Recent* recent : scans) {
      const ClassifiedScan& scan = *recent->scan;
      const std::uint32_t radar = scan.header.source_id;
      const auto& sensor = scan.geometry.sensor_position_vehicle_m;
      view.sensors.push_back({radar, sensor[0], sensor[1], age_s(scan.header)});
      for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
        view.detections.push_back(
            {radar, scan.x_vehicle_m[i], scan.y_vehicle_m[i], scan.range_rate_over_ground_mps[i],
             scan.ghost_probability(i), scan.provenance[i], (scan.detection_flags[i] & corrected_flag::kRejected) != 0,
             recent->truth == nullptr ? std::optional<Provenance>() : recent->truth->detections[i].provenance});
      }
    }
    view.segments.assign(latest->reflector_segments.begin(),
                         latest->reflector_segments.begin() + latest->number_of_reflector_segments);
    view.tracks_age_s = age_s(tracks_->header);
    for (std::size_t k = 0; k < tracks_->number_of_confirmed_tracks; ++k) {
      const Track& t = tracks_->tracks[k];
      view.tracks.push_back(
          {t.tracking_id, t.position_vehicle_m[0], t.position_vehicle_m[1], t.heading_rad, t.length_m, t.width_m});
    }
    if (truth_ != nullptr && begin_ns_) view.objects = truth_->objects.at(seconds(view.time_ns));
    return view;
  }

  const DetectionTruths* truth_;
  std::optional<std::int64_t> begin_ns_;
  GhostFindings out_;
  std::map<std::uint32_t, Recent> recent_;  // by radar
  std::unique_ptr<TrackList> tracks_ = std::make_unique<TrackList>();
  judge::FalseTracks false_tracks_;
  std::size_t most_ghosts_ = 0, most_mistakes_ = 0;
};

}  // namespace

GhostFindings find_ghosts(const std::filesystem::path& folder, const DetectionTruths* truth,
                          const std::function<void()>& look) {
  if (!std::filesystem::exists(folder / "scans.csv")) return {};
  constexpr std::uint64_t kScansBetweenLooks = 256;
  std::optional<std::int64_t> begin_ns;
  std::string problem;
  try {
    std::vector<score::RunScan> seen;
    if (truth != nullptr) {
      score::RunScans rows(folder);
      for (score::RunScan row; rows.next(row);) {
        if (row.detections > 0) seen.push_back(row);
      }
    }
    if (truth != nullptr) begin_ns = beginning(seen, truth->scans);
  } catch (const score::InputError& error) {
    problem = error.what();
  }
  Finder finder(truth, begin_ns);
  try {
    const auto scan = std::make_unique<ClassifiedScan>();
    const auto tracks = std::make_unique<TrackList>();
    RecordedScans scans(folder);
    for (std::uint64_t count = 1; scans.next(*scan, *tracks); ++count) {
      finder.take(*scan, *tracks);
      if (look && count % kScansBetweenLooks == 0) look();
    }
  } catch (const score::InputError& error) {
    if (problem.empty()) problem = error.what();
  }
  GhostFindings findings = finder.finish();
  findings.problem = problem;
  findings.is_recorded = true;
  findings.truth_begin_ns = begin_ns;
  return findings;
}

std::vector<Check> ghost_checks(const GhostFindings& findings) {
  std::vector<Check> checks;
  if (findings.is_recorded) {
    checks.push_back({findings.problem.empty()
                          ? "the tables of scans could be read to their end"
                          : "the tables of scans could not be read to their end: " + findings.problem,
                      findings.problem.empty(), false});
  }
  if (!findings.confusion) return checks;
  const judge::Confusion& c = *findings.confusion;
  const std::uint64_t scans = findings.compared_scans + findings.unknown_scans;
  const double compared =
      scans == 0 ? 0.0 : 100.0 * static_cast<double>(findings.compared_scans) / static_cast<double>(scans);
  checks.push_back(
      {fmt::format("{} of {} recorded scans were found in the truth (at least {:.0f} %)",
                   text::grouped(findings.compared_scans), text::grouped(scans), GhostBars::kScansCompared_percent),
       compared >= GhostBars::kScansCompared_percent, false});
  const double moving = c.percent(Provenance::kMoving, Provenance::kMoving);
  if (c.count(Provenance::kMoving) > 0) {
    checks.push_back(
        {fmt::format("{:.1f} % of {} detections of moving objects were classified as moving (aim: at least {:.0f} %)",
                     moving, text::grouped(c.count(Provenance::kMoving)), GhostBars::kMovingClassifiedMoving_percent),
         moving >= GhostBars::kMovingClassifiedMoving_percent, true});
  }
  for (const Provenance type : {Provenance::kGhostType1, Provenance::kGhostType2}) {
    if (c.count(type) == 0) continue;
    checks.push_back({fmt::format("{:.1f} % of {} ghosts of {} were classified as ghosts (aim: at least {:.0f} %)",
                                  c.percent_ghost(type), text::grouped(c.count(type)), name_of(type),
                                  GhostBars::kGhostsClassifiedGhosts_percent),
                      c.percent_ghost(type) >= GhostBars::kGhostsClassifiedGhosts_percent, true});
  }
  const std::size_t tracks = findings.ghost_tracks.size();
  checks.push_back({fmt::format("no confirmed track followed a ghost for more than {} scans ({} did)",
                                judge::FalseTracks::kMaxTolerated_scans, tracks),
                    tracks == 0, true});
  return checks;
}

}  // namespace boresight::report
