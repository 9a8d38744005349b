#include "tests/benchmarks/tracking/drives/judge/evaluation.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "services/common/estimation/unknown.hpp"
#include "services/simulator/judge/track_judge.hpp"

namespace boresight::bench::tracking {

namespace {

template <typename Value>
void append_to(std::vector<Value>& values, const std::vector<Value>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

/// Objects that the first contestant's lists show for long enough. Judgements of the others are looked up by id.
std::vector<JudgedObject> judged_objects(const Contestant& contestant) {
  std::vector<JudgedObject> objects;
  for (std::size_t d = 0; d < contestant.drives.size(); ++d) {
    for (const ScoredDrive::Object& object : contestant.drives[d].objects()) {
      if (object.in_view_s < judge::TrackJudge::kShortestView_s) continue;
      objects.push_back({d, object.id, object.object_class});
    }
  }
  return objects;
}

/// `Choice`: Rule or OperatingPoint.
template <typename Choice>
Outcome outcome_of(const Contestant& contestant, const std::vector<JudgedObject>& objects, const Choice& choice,
                   std::string shown) {
  Outcome outcome;
  outcome.rule = std::move(shown);
  std::vector<std::map<std::uint32_t, ObjectTally>> tallies(contestant.drives.size());
  for (std::size_t d = 0; d < contestant.drives.size(); ++d) {
    const Judgement judgement = judge_drive(contestant.drives[d], choice);
    outcome.lists.add(judgement.lists, 1.0);
    outcome.lists_of_drives.push_back(judgement.lists);
    for (std::size_t o = 0; o < judgement.objects.size(); ++o) {
      tallies[d][contestant.drives[d].objects()[o].id] = judgement.objects[o];
    }
  }
  for (const JudgedObject& object : objects) outcome.objects.push_back(tallies[object.drive][object.id]);
  return outcome;
}

std::string shown(const OperatingPoint& point) {
  if (std::isinf(point.lower.least_score)) return "all tracks";
  const std::string text = fmt::format("≥ {:.4g}", point.lower.least_score);
  if (point.weight_of_lower >= 0.995) return text;
  return fmt::format("{} ({:.0f} %), above", text, 100.0 * point.weight_of_lower);
}

Outcome at_false_tracks(const Contestant& contestant, const std::vector<JudgedObject>& objects, double wanted) {
  std::vector<float> scores;
  std::size_t lists = 0;
  for (const ScoredDrive& drive : contestant.drives) {
    lists += drive.lists().size();
    for (const ScoredDrive::FalseTrack& track : drive.false_tracks()) scores.push_back(track.score);
  }
  const OperatingPoint point = operating_point(std::move(scores), lists, wanted);
  return outcome_of(contestant, objects, point, shown(point));
}

TrackerResult result_of(const Contestant& contestant, const std::vector<JudgedObject>& objects) {
  TrackerResult result;
  result.name = contestant.name;
  result.is_baseline = contestant.is_baseline;
  result.origins = contestant.origins;
  for (std::size_t i = 0; i < kFixedRules.size(); ++i) {
    // A baseline has no existence.
    if (contestant.is_baseline && i != kConfirmed) continue;
    result.fixed[i] = outcome_of(contestant, objects, kFixedRules[i].rule, kFixedRules[i].name);
  }
  for (const ScoredDrive& drive : contestant.drives) {
    if (!contestant.is_baseline) result.reliability += drive.reliability();
    result.long_false_tracks.push_back(drive.long_false_tracks());
  }
  for (std::size_t i = 0; i < kCurveFalseTracks.size(); ++i) {
    result.curve[i] = at_false_tracks(contestant, objects, kCurveFalseTracks[i]);
  }
  result.ms_per_scan = contestant.ms_per_scan;
  for (const std::vector<double>& of_drive : contestant.steps_ms) append_to(result.step_ms, of_drive);
  return result;
}

/// Thresholds differ from profile to profile.
std::string pooled_rule(const std::string& a, const std::string& b) {
  return a == b ? a : "by profile";
}

}  // namespace

void Outcome::append(const Outcome& other) {
  rule = objects.empty() ? other.rule : pooled_rule(rule, other.rule);
  append_to(objects, other.objects);
  append_to(lists_of_drives, other.lists_of_drives);
  lists.add(other.lists, 1.0);
}

void TrackerResult::append(const TrackerResult& other) {
  name = other.name;
  is_baseline = other.is_baseline;
  origins = other.origins;
  for (std::size_t i = 0; i < kFalseTracks.size(); ++i) at_false_tracks[i].append(other.at_false_tracks[i]);
  for (std::size_t i = 0; i < kCurveFalseTracks.size(); ++i) curve[i].append(other.curve[i]);
  for (std::size_t i = 0; i < kFixedRules.size(); ++i) fixed[i].append(other.fixed[i]);
  reliability += other.reliability;
  append_to(long_false_tracks, other.long_false_tracks);
  append_to(ms_per_scan, other.ms_per_scan);
  append_to(step_ms, other.step_ms);
}

void Evaluation::append(const Evaluation& other) {
  for (JudgedObject object : other.objects) {
    object.drive += drives;
    objects.push_back(object);
  }
  drives += other.drives;
  trackers.resize(other.trackers.size());
  for (std::size_t i = 0; i < trackers.size(); ++i) trackers[i].append(other.trackers[i]);
  baselines.resize(other.baselines.size());
  for (std::size_t i = 0; i < baselines.size(); ++i) baselines[i].append(other.baselines[i]);
  for (std::size_t i = 0; i < kFalseTracks.size(); ++i) better_baseline[i].append(other.better_baseline[i]);
}

double mean_share(const std::vector<ObjectTally>& objects) {
  double sum = 0.0;
  for (const ObjectTally& object : objects) sum += object.share();
  return objects.empty() ? kNaN : sum / static_cast<double>(objects.size());
}

Evaluation evaluate(std::string name, const std::vector<Contestant>& contestants) {
  Evaluation evaluation;
  evaluation.name = std::move(name);
  if (contestants.empty()) return evaluation;
  evaluation.drives = contestants.front().drives.size();
  evaluation.objects = judged_objects(contestants.front());
  const std::vector<JudgedObject>& objects = evaluation.objects;
  for (const Contestant& contestant : contestants) {
    TrackerResult result = result_of(contestant, objects);
    (contestant.is_baseline ? evaluation.baselines : evaluation.trackers).push_back(std::move(result));
  }
  for (std::size_t i = 0; i < kFalseTracks.size(); ++i) {
    double most_false = kFalseTracks[i];
    const TrackerResult* better = nullptr;
    for (std::size_t c = 0, b = 0; c < contestants.size(); ++c) {
      if (!contestants[c].is_baseline) continue;
      TrackerResult& baseline = evaluation.baselines[b++];
      baseline.at_false_tracks[i] = at_false_tracks(contestants[c], objects, kFalseTracks[i]);
      if (better != nullptr &&
          mean_share(baseline.at_false_tracks[i].objects) <= mean_share(better->at_false_tracks[i].objects)) {
        continue;
      }
      better = &baseline;
    }
    if (better != nullptr) {
      evaluation.better_baseline[i] = better->at_false_tracks[i];
      evaluation.better_baseline[i].rule = better->name + ": " + evaluation.better_baseline[i].rule;
      most_false = std::min(most_false, evaluation.better_baseline[i].false_tracks());
    }
    for (std::size_t c = 0, t = 0; c < contestants.size(); ++c) {
      if (contestants[c].is_baseline) continue;
      evaluation.trackers[t++].at_false_tracks[i] = at_false_tracks(contestants[c], objects, most_false);
    }
  }
  return evaluation;
}

}  // namespace boresight::bench::tracking
