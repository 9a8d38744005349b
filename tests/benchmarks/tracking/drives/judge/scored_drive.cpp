#include "tests/benchmarks/tracking/drives/judge/scored_drive.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/LU>

#include "services/boresight/score/object_truth.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/simulator/judge/matching.hpp"
#include "services/simulator/judge/track_judge.hpp"

namespace boresight::bench::tracking {

namespace {

bool is_judged(const judge::TrueObject& object) {
  return object.in_view && !object.parked && judge::band_of(object.box.position_m).has_value();
}

bool is_at(const ListedTrack& track, const judge::TrueObject& object) {
  return (!object.parked || track.says_it_stands()) &&
         object.box.distance_m(track.position_m) <= judge::kMaxTrackDistance_m;
}

TrackErrors errors_of(const ListedTrack& track, const judge::TrueObject& object) {
  const judge::Object& box = object.box;
  const Eigen::Vector2d error = track.position_m - box.position_m;
  const double c = std::cos(box.heading_rad), s = std::sin(box.heading_rad);
  const Eigen::Matrix2d& p = track.position_covariance_m2;
  const bool has_covariance = p.allFinite() && p(0, 0) > 0.0 && p.determinant() > 0.0;
  TrackErrors errors;
  errors.along_m = static_cast<float>(c * error.x() + s * error.y());
  errors.across_m = static_cast<float>(-s * error.x() + c * error.y());
  errors.length_m = static_cast<float>(track.length_m - box.length_m);
  errors.heading_rad = static_cast<float>(geometry::wrap_angle(track.heading_rad - box.heading_rad));
  errors.mahalanobis_squared = static_cast<float>(has_covariance ? error.dot(p.inverse() * error) : kNaN);
  errors.is_near = box.position_m.norm() < ScoredDrive::kNear_m;
  errors.moves = box.velocity_mps.norm() >= score::ObjectTruth::kSlowestMoving_mps;
  return errors;
}

}  // namespace

void Reliability::add(double score, bool is_at_an_object) {
  if (!(score >= 0.0 && score <= 1.0)) return;
  Bin& bin = bins[std::min(kBins - 1, static_cast<std::size_t>(score * static_cast<double>(kBins)))];
  ++bin.entries;
  bin.at_an_object += is_at_an_object ? 1 : 0;
  bin.score_sum += score;
}

Reliability& Reliability::operator+=(const Reliability& other) {
  for (std::size_t i = 0; i < kBins; ++i) {
    bins[i].entries += other.bins[i].entries;
    bins[i].at_an_object += other.bins[i].at_an_object;
    bins[i].score_sum += other.bins[i].score_sum;
  }
  return *this;
}

std::uint32_t ScoredDrive::index_of(const judge::TrueObject& object) {
  const auto next = static_cast<std::uint32_t>(objects_.size());
  const auto [place, is_new] = index_of_id_.try_emplace(object.box.id, next);
  if (is_new) objects_.push_back({object.box.id, object.object_class});
  return place->second;
}

void ScoredDrive::see(const judge::TrueObject& object, double t_s) {
  Object& seen = objects_[index_of(object)];
  ++seen.lists_in_view;
  const double step_s = t_s - seen.last_s;
  if (seen.last_s >= 0.0 && step_s > 0.0 && step_s <= judge::TrackJudge::kLongestGapInView_s) seen.in_view_s += step_s;
  seen.last_s = std::max(seen.last_s, t_s);
}

void ScoredDrive::live(const ListedTrack& track, double t_s, bool is_at_an_object) {
  Life& life = lives_.try_emplace(track.id, Life{t_s, t_s, 0, 0}).first->second;
  life.last_s = std::max(life.last_s, t_s);
  ++life.lists;
  if (!is_at_an_object) ++life.lists_at_none;
}

std::size_t ScoredDrive::long_false_tracks() const {
  return static_cast<std::size_t>(std::count_if(lives_.begin(), lives_.end(), [](const auto& of_track) {
    const Life& life = of_track.second;
    return 2 * life.lists_at_none > life.lists && life.last_s - life.first_s >= judge::TrackJudge::kLongFalseLife_s;
  }));
}

void ScoredDrive::add(const Scene& scene) {
  struct Candidate {
    bool is_unscored;
    double box_m, centre_m;
    std::size_t track, object;
    [[nodiscard]] auto order() const { return std::tie(is_unscored, box_m, centre_m, track, object); }
  };
  List& list = lists_.emplace_back();
  for (const judge::TrueObject& object : scene.objects) {
    if (is_judged(object)) see(object, scene.t_s);
  }
  std::vector<Candidate> candidates;
  std::vector<std::uint16_t> place_in_list(scene.tracks.size());
  for (std::size_t k = 0; k < scene.tracks.size(); ++k) {
    const ListedTrack& track = scene.tracks[k];
    const bool in_range = judge::band_of(track.position_m).has_value();
    bool is_at_an_object = false, in_a_box = false;
    for (const judge::TrueObject& object : scene.objects) {
      is_at_an_object = is_at_an_object || is_at(track, object);
      in_a_box = in_a_box || (object.in_view && !object.parked && object.box.distance_m(track.position_m) <= 0.0);
    }
    if (in_range) reliability_.add(track.score, is_at_an_object);
    if (in_range && track.confirmed) live(track, scene.t_s, is_at_an_object);
    const auto score = static_cast<float>(track.score);
    if (!is_at_an_object) {
      if (in_range) false_tracks_.push_back({score, track.confirmed});
      continue;
    }
    place_in_list[k] = static_cast<std::uint16_t>(list.tracks.size());
    list.tracks.push_back({score, track.confirmed, in_range, track.says_it_stands()});
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const judge::TrueObject& object = scene.objects[o];
      const double box_m = object.box.distance_m(track.position_m);
      if (object.parked || !(box_m <= judge::kMaxTrackDistance_m) || (in_a_box && box_m > 0.0)) continue;
      candidates.push_back({!is_judged(object), box_m, (object.box.position_m - track.position_m).norm(), k, o});
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.order() < b.order(); });
  for (const Candidate& each : candidates) {
    const judge::TrueObject& object = scene.objects[each.object];
    list.pairs.push_back(
        {index_of(object), place_in_list[each.track], !each.is_unscored, errors_of(scene.tracks[each.track], object)});
  }
}

}  // namespace boresight::bench::tracking
