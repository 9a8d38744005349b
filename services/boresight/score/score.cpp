#include "services/boresight/score/score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "services/boresight/score/detection_truth.hpp"
#include "services/boresight/score/mounting_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "services/boresight/score/run_folder.hpp"
#include "services/boresight/score/truth_clock.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/judge/detection_judge.hpp"
#include "services/simulator/judge/track_judge.hpp"

namespace boresight::score {

namespace fs = std::filesystem;

namespace {

/// The scans of a run with their detections and track lists, beside the truth.
class DriveJudge {
 public:
  DriveJudge(const Input& input, Score& result)
      : input_(input), result_(result), clock_(input.truth), scans_(input.run) {}

  void run() {
    RunScan scan;
    if (!scans_.next(scan)) {
      result_.finding = "the run has no scan";
      return;
    }
    open(scan);
    begin_s_ = end_s_ = scan.t_s;
    std::uint64_t count = 0;
    do {
      end_s_ = std::max(end_s_, scan.t_s);
      judge_scan(scan);
      constexpr std::uint64_t kScansBetweenReports = 256;
      if (++count % kScansBetweenReports == 0 && input_.progress) input_.progress(scan.t_s);
    } while (scans_.next(scan));
    result_.figures.add("run.scans", static_cast<double>(count));
    result_.figures.add("run.seconds", end_s_ - begin_s_, "s");
    write();
  }

  [[nodiscard]] std::int64_t origin_ns() const { return clock_.origin_ns(); }
  [[nodiscard]] bool judged_something() const { return detections_judge_.scans() + tracks_judge_.lists() > 0; }
  [[nodiscard]] std::string intervals() const {
    return fmt::format("the run lasts from {:.3f} to {:.3f} s on the truth's clock, the truth begins at {:.3f} s",
                       first_on_truth_s_, first_on_truth_s_ + end_s_ - begin_s_, clock_.first_s());
  }

 private:
  void open(const RunScan& first) {
    const bool has_summary = fs::exists(input_.run / "run.json");
    const std::optional<std::int64_t> stated_ns =
        has_summary ? read_run_summary(input_.run).truth_begin_ns : std::nullopt;
    if (stated_ns) {
      clock_.begin_at(*stated_ns);
    } else {
      clock_.begin(first.time_ns, first.t_s);
    }
    first_on_truth_s_ = clock_.time_s(first.time_ns);
    if (!input_.truth.objects.empty() && fs::exists(input_.run / "tracks.csv")) {
      tracks_.emplace(input_.run);
      objects_.emplace(input_.truth.objects, input_.truth.objects_are_boxes, input_.truth.visibility);
    } else {
      result_.notes.emplace_back(input_.truth.objects.empty() ? "tracks: not judged, the truth has no table of objects"
                                                              : "tracks: not judged, the run has no tracks.csv");
    }
    if (!input_.truth.detections.empty() && fs::exists(input_.run / "detections.csv")) {
      detections_.emplace(input_.run);
      origins_.emplace(input_.truth.detections, input_.truth.detections_are_labels);
    } else {
      result_.notes.emplace_back(input_.truth.detections.empty()
                                     ? "detections: not judged, the truth has no origins of detections"
                                     : "detections: not judged, the run has no detections.csv");
    }
  }

  void judge_scan(const RunScan& scan) {
    const double t_s = clock_.measured_s(scan.radar, scan.time_ns);
    if (tracks_) {
      tracks_->take(scan, track_list_);
      if (objects_->at(t_s, object_list_)) {
        tracks_judge_.add(t_s, track_list_, object_list_);
      } else {
        ++lists_without_truth_;
      }
    }
    if (detections_) {
      detections_->take(scan, detection_list_);
      const std::vector<TrueOrigin>* const origins = origins_->find(scan.radar, t_s, scan.scan, detection_list_.size());
      if (origins == nullptr) {
        ++scans_without_truth_;
      } else {
        judge_detections(*origins);
      }
    }
  }

  void judge_detections(const std::vector<TrueOrigin>& origins) {
    judged_.clear();
    for (std::size_t i = 0; i < detection_list_.size(); ++i) {
      const TrueOrigin origin = i < origins.size() ? origins[i] : TrueOrigin{};
      const RunDetection& detection = detection_list_[i];
      judged_.push_back({origin.provenance, origin.cause, detection.origin, detection.rejected, detection.p_moving});
    }
    detections_judge_.add_scan(judged_);
  }

  void write() {
    result_.figures.add("detections.scans_without_truth",
                        detections_ ? static_cast<double>(scans_without_truth_) : kNaN);
    result_.figures.add("tracks.lists_without_truth", tracks_ ? static_cast<double>(lists_without_truth_) : kNaN);
    detections_judge_.write(result_.figures);
    tracks_judge_.finish();
    tracks_judge_.write(result_.figures);
    if (tracks_ && input_.truth.visibility.empty()) {
      result_.notes.emplace_back(
          "tracks: visibility not known, the truth has no truth_visibility.csv; all objects within 100 m that are not "
          "parked count as in view, also those hidden from every radar");
    }
    for (const auto& [radar, offset_s] : clock_.car().stamp_offsets_s) {
      result_.notes.push_back(
          fmt::format("stamps of radar {} are {:+.1f} ms off in the truth: its scans are judged at the time of "
                      "measurement",
                      radar, 1e3 * offset_s));
    }
  }

  const Input& input_;
  Score& result_;
  TruthClock clock_;
  RunScans scans_;
  double first_on_truth_s_ = 0.0, begin_s_ = 0.0, end_s_ = 0.0;
  std::optional<RunTracks> tracks_;
  std::optional<ObjectTruth> objects_;
  std::optional<RunDetections> detections_;
  std::optional<DetectionTruth> origins_;
  std::vector<judge::ScoredTrack> track_list_;
  std::vector<judge::TrueObject> object_list_;
  std::vector<RunDetection> detection_list_;
  std::vector<judge::JudgedDetection> judged_;
  judge::DetectionJudge detections_judge_;
  judge::TrackJudge tracks_judge_;
  std::uint64_t lists_without_truth_ = 0, scans_without_truth_ = 0;
};

/// What the truth of the mountings and speed scales contains.
void note_mounting_truth(const Input& input, Score& result) {
  const CarTruth car = read_car_truth(input.truth.drive);
  if (car.load_pitch_rad != 0.0) {
    result.notes.push_back(
        car.load_time_s > 0.0
            ? fmt::format(
                  "alignment: the load from {:g} s on, which pitches the car by {:+g}°, is judged as load_pitch; "
                  "the true mountings and health are judged without it",
                  car.load_time_s, car.load_pitch_rad * kDegreesPerRadian)
            : fmt::format(
                  "alignment: the true mountings include the load, which pitches the car by {:+g}° from the start; "
                  "health is judged without it",
                  car.load_pitch_rad * kDegreesPerRadian));
  }
  for (const auto& [radar, scale] : car.range_rate_scales) {
    result.notes.push_back(fmt::format(
        "alignment: the true speed scale of radar {} includes its own scale of range rates, {:.6f}", radar, scale));
  }
  if (car.side_slip_std_rad != 0.0) {
    result.notes.push_back(
        fmt::format("alignment: the side slip of the car, {:g}° (σ), turns its direction of travel; the true mountings "
                    "do not include it",
                    car.side_slip_std_rad * kDegreesPerRadian));
  }
}

/// Whether anything was judged.
bool judge_alignment(const Input& input, std::int64_t origin_ns, Score& result) {
  judge::AlignmentJudge alignment_judge;
  bool judged = false;
  const bool has_truth = !input.truth.sensors.empty() || !input.truth.drive.empty();
  if (input.vehicle == nullptr) {
    result.notes.emplace_back("alignment and health: not judged without a vehicle (--vehicle)");
  } else if (!has_truth) {
    result.notes.emplace_back("alignment and health: not judged, the truth has no truth.csv and no truth_sensors.csv");
  } else if (!fs::exists(input.run / "alignment.csv")) {
    result.notes.emplace_back("alignment: not judged, the run has no alignment.csv");
  } else {
    RunAlignment estimates(input.run);
    MountingTruthReader truth(input.truth, *input.vehicle);
    judge::AlignmentSample sample;
    for (std::int64_t time_ns = 0; estimates.next(sample, time_ns); judged = true) {
      alignment_judge.add(sample, truth.at(sample.radar, 1e-9 * static_cast<double>(time_ns - origin_ns)));
    }
    note_mounting_truth(input, result);
  }
  alignment_judge.write(result.figures);
  return judged;
}

bool judge_health(const Input& input, std::int64_t origin_ns, Score& result) {
  judge::HealthJudge health_judge;
  bool judged = false;
  const bool has_truth = !input.truth.sensors.empty() || !input.truth.drive.empty();
  if (input.vehicle != nullptr && has_truth && fs::exists(input.run / "health.jsonl")) {
    RunHealth health(input.run);
    MountingTruthReader truth(input.truth, *input.vehicle);
    for (RunVerdicts verdicts; health.next(verdicts);) {
      const double t_s = 1e-9 * static_cast<double>(verdicts.time_ns - origin_ns);
      for (const RunVerdicts::Radar& radar : verdicts.radars) {
        const std::optional<bool> is_misaligned = truth.is_misaligned(radar.radar, t_s);
        if (!is_misaligned) continue;
        health_judge.add(t_s, radar.radar, radar.misaligned, *is_misaligned);
        judged = true;
      }
    }
    for (const RadarConfig& radar : input.vehicle->radars) {
      const std::string name = fmt::format("health.radar_{}.tolerance_", radar.id);
      result.figures.add(name + "yaw_deg", radar.tolerance.yaw_rad * kDegreesPerRadian, "°");
      result.figures.add(name + "pitch_deg", radar.tolerance.pitch_rad * kDegreesPerRadian, "°");
      result.figures.add(name + "roll_deg", radar.tolerance.roll_rad * kDegreesPerRadian, "°");
    }
  } else if (input.vehicle != nullptr && has_truth) {
    result.notes.emplace_back("health: not judged, the run has no health.jsonl");
  }
  health_judge.write(result.figures);
  return judged;
}

void add_timing(const Input& input, Score& result) {
  if (!fs::exists(input.run / "run.json")) {
    result.notes.emplace_back("time per stage: not known, the run has no run.json");
    return;
  }
  for (const auto& [name, value] : read_run_summary(input.run).timing) {
    result.figures.add("timing." + name, value);
  }
}

}  // namespace

Score score(const Input& input) {
  Score result;
  DriveJudge drive(input, result);
  drive.run();
  if (!result.finding.empty()) return result;
  const bool has_alignment = judge_alignment(input, drive.origin_ns(), result);
  const bool has_health = judge_health(input, drive.origin_ns(), result);
  add_timing(input, result);
  const bool has_series = !input.truth.objects.empty() || !input.truth.detections.empty();
  if (!drive.judged_something() && (has_series || !(has_alignment || has_health))) {
    result.finding = "nothing could be judged: " + drive.intervals();
  }
  return result;
}

}  // namespace boresight::score
