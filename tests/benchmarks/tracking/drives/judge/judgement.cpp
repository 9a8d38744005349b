#include "tests/benchmarks/tracking/drives/judge/judgement.hpp"

#include <cmath>

#include "services/simulator/judge/track_judge.hpp"

namespace boresight::bench::tracking {

namespace {

double square(double value) {
  return value * value;
}

void add_errors(const TrackErrors& errors, ObjectTally& object) {
  if (!std::isnan(errors.mahalanobis_squared)) {
    object.errors_with_covariance += 1.0;
    object.errors_inside += errors.mahalanobis_squared <= judge::TrackJudge::kChiSquared95 ? 1.0 : 0.0;
  }
  if (!errors.is_near) return;
  ObjectTally::Near& near = object.near;
  near.lists += 1.0;
  near.along_m2 += square(errors.along_m);
  near.across_m2 += square(errors.across_m);
  near.length_m2 += square(errors.length_m);
  near.axis_rad2 += square(std::remainder(errors.heading_rad, M_PI));
  if (!errors.moves) return;
  near.lists_moving += 1.0;
  near.heading_rad2 += square(errors.heading_rad);
}

}  // namespace

void ObjectTally::add(const ObjectTally& other, double weight) {
  lists_in_view += weight * other.lists_in_view;
  lists_tracked += weight * other.lists_tracked;
  errors_with_covariance += weight * other.errors_with_covariance;
  errors_inside += weight * other.errors_inside;
  near.lists += weight * other.near.lists;
  near.along_m2 += weight * other.near.along_m2;
  near.across_m2 += weight * other.near.across_m2;
  near.length_m2 += weight * other.near.length_m2;
  near.axis_rad2 += weight * other.near.axis_rad2;
  near.lists_moving += weight * other.near.lists_moving;
  near.heading_rad2 += weight * other.near.heading_rad2;
}

void ListTally::add(const ListTally& other, double weight) {
  lists += weight * other.lists;
  false_tracks += weight * other.false_tracks;
  at_an_object += weight * other.at_an_object;
  assigned += weight * other.assigned;
  duplicates += weight * other.duplicates;
}

Judgement judge_drive(const ScoredDrive& drive, const Rule& rule) {
  Judgement judgement;
  judgement.objects.resize(drive.objects().size());
  for (std::size_t o = 0; o < drive.objects().size(); ++o) {
    judgement.objects[o].lists_in_view = drive.objects()[o].lists_in_view;
  }
  ListTally& tally = judgement.lists;
  tally.lists = static_cast<double>(drive.lists().size());
  for (const ScoredDrive::FalseTrack& track : drive.false_tracks()) {
    tally.false_tracks += rule.counts(track.score, track.confirmed) ? 1.0 : 0.0;
  }
  std::vector<std::size_t> list_of_object(drive.objects().size(), drive.lists().size());  // the latest with a track
  std::vector<bool> is_assigned;
  for (std::size_t i = 0; i < drive.lists().size(); ++i) {
    const ScoredDrive::List& list = drive.lists()[i];
    is_assigned.assign(list.tracks.size(), false);
    for (const ScoredDrive::Pair& pair : list.pairs) {
      const ScoredDrive::NearTrack& track = list.tracks[pair.track];
      if (is_assigned[pair.track] || list_of_object[pair.object] == i || !rule.counts(track.score, track.confirmed)) {
        continue;
      }
      is_assigned[pair.track] = true;
      list_of_object[pair.object] = i;
      if (!pair.is_scored) continue;
      judgement.objects[pair.object].lists_tracked += 1.0;
      add_errors(pair.errors, judgement.objects[pair.object]);
    }
    for (std::size_t k = 0; k < list.tracks.size(); ++k) {
      const ScoredDrive::NearTrack& track = list.tracks[k];
      if (!track.in_range || !rule.counts(track.score, track.confirmed)) continue;
      tally.at_an_object += 1.0;
      tally.assigned += is_assigned[k] ? 1.0 : 0.0;
      tally.duplicates += !is_assigned[k] && !track.stands ? 1.0 : 0.0;
    }
  }
  return judgement;
}

Judgement judge_drive(const ScoredDrive& drive, const OperatingPoint& point) {
  Judgement lower = judge_drive(drive, point.lower);
  if (point.weight_of_lower >= 1.0) return lower;
  const Judgement higher = judge_drive(drive, point.higher);
  Judgement mixed;
  mixed.objects.resize(lower.objects.size());
  for (std::size_t o = 0; o < mixed.objects.size(); ++o) {
    mixed.objects[o].add(lower.objects[o], point.weight_of_lower);
    mixed.objects[o].add(higher.objects[o], 1.0 - point.weight_of_lower);
  }
  mixed.lists.add(lower.lists, point.weight_of_lower);
  mixed.lists.add(higher.lists, 1.0 - point.weight_of_lower);
  return mixed;
}

}  // namespace boresight::bench::tracking
