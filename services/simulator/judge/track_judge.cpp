#include "services/simulator/judge/track_judge.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include <Eigen/LU>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"

namespace boresight::judge {

namespace {

/// Cost of a pair: the distance from the box, and a tenth of the distance from the centre, which decides between tracks
/// in the same box. Choice.
constexpr double kCentreShare = 0.1;
/// Objects out of view come last, so that they take no track from a visible object.
constexpr double kOutOfViewCost = 50.0;
/// More than any pair costs, so that as many tracks as possible get an object.
constexpr double kCostOfNoPair = 1000.0;

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

double squared(double value) {
  return value * value;
}

}  // namespace

TrackJudge::Cell& TrackJudge::Cell::operator+=(const Cell& other) {
  objects += other.objects;
  objects_found += other.objects_found;
  stays += other.stays;
  stays_found += other.stays_found;
  delays_s.insert(delays_s.end(), other.delays_s.begin(), other.delays_s.end());
  lists_in_view += other.lists_in_view;
  lists_tracked += other.lists_tracked;
  along_m2 += other.along_m2;
  across_m2 += other.across_m2;
  speed_m2ps2 += other.speed_m2ps2;
  heading_rad2 += other.heading_rad2;
  length_m2 += other.length_m2;
  width_m2 += other.width_m2;
  switches += other.switches;
  fragments += other.fragments;
  errors_inside += other.errors_inside;
  errors_with_covariance += other.errors_with_covariance;
  return *this;
}

bool TrackJudge::is_scored(const TrueObject& object) {
  return object.in_view && !object.parked && band_of(object.box.position_m).has_value();
}

bool TrackJudge::is_at_an_object(const ScoredTrack& track, std::span<const TrueObject> objects) const {
  return std::any_of(objects.begin(), objects.end(), [&](const TrueObject& object) {
    return (!object.parked || track.says_it_stands()) && object.box.distance_m(track.position_m) <= kMaxTrackDistance_m;
  });
}

void TrackJudge::pair_up(std::span<const TrueObject> objects) {
  object_of_track_.assign(confirmed_.size(), kNone);
  track_of_object_.assign(objects.size(), kNone);
  // Pairs of the list before stay together while they are possible (Bernardin and Stiefelhagen 2008).
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const auto before = track_of_.find(objects[o].box.id);
    if (objects[o].parked || before == track_of_.end()) continue;
    for (std::size_t k = 0; k < confirmed_.size(); ++k) {
      if (confirmed_[k].id != before->second || object_of_track_[k] != kNone) continue;
      if (objects[o].box.distance_m(confirmed_[k].position_m) > kMaxTrackDistance_m) continue;
      object_of_track_[k] = o;
      track_of_object_[o] = k;
    }
  }
  free_tracks_.clear();
  free_objects_.clear();
  for (std::size_t k = 0; k < confirmed_.size(); ++k) {
    if (object_of_track_[k] == kNone) free_tracks_.push_back(k);
  }
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (track_of_object_[o] == kNone && !objects[o].parked) free_objects_.push_back(o);
  }
  pairs_.clear();
  for (std::size_t row = 0; row < free_tracks_.size(); ++row) {
    const Eigen::Vector2d& place = confirmed_[free_tracks_[row]].position_m;
    // A track in the box of an object that is in view belongs to that object or to none.
    const bool in_a_box = std::any_of(objects.begin(), objects.end(), [&place](const TrueObject& object) {
      return object.in_view && !object.parked && object.box.distance_m(place) <= 0.0;
    });
    for (std::size_t column = 0; column < free_objects_.size(); ++column) {
      const TrueObject& object = objects[free_objects_[column]];
      const double distance_m = object.box.distance_m(place);
      if (!(distance_m <= kMaxTrackDistance_m) || (in_a_box && distance_m > 0.0)) continue;
      const double centre_m = (object.box.position_m - place).norm();
      pairs_.push_back(
          {row, column, distance_m + kCentreShare * centre_m + (is_scored(object) ? 0.0 : kOutOfViewCost)});
    }
  }
  pairing_.solve(free_tracks_.size(), free_objects_.size(), pairs_, kCostOfNoPair);
  for (std::size_t row = 0; row < free_tracks_.size(); ++row) {
    const std::size_t column = pairing_.column_of(row);
    if (column == Pairing::kNoPartner) continue;
    object_of_track_[free_tracks_[row]] = free_objects_[column];
    track_of_object_[free_objects_[column]] = free_tracks_[row];
  }
  track_of_.clear();
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (track_of_object_[o] != kNone) track_of_[objects[o].box.id] = confirmed_[track_of_object_[o]].id;
  }
}

void TrackJudge::judge_lives(double t_s, std::span<const TrueObject> objects) {
  for (std::size_t k = 0; k < confirmed_.size(); ++k) {
    const ScoredTrack& track = confirmed_[k];
    if (!band_of(track.position_m)) continue;
    Life& life = lives_.try_emplace(track.id, Life{t_s, t_s}).first->second;
    life.last_s = std::max(life.last_s, t_s);
    ++life.lists;
    life.range_sum_m += track.position_m.norm();
    const bool at_an_object = is_at_an_object(track, objects);
    if (!at_an_object) ++life.lists_at_none;
    if (at_an_object && object_of_track_[k] == kNone && !track.says_it_stands()) ++duplicates_;
  }
  if (t_s < next_sweep_s_) return;
  next_sweep_s_ = t_s + kTrackForgotten_s;
  for (auto life = lives_.begin(); life != lives_.end();) {
    if (t_s - life->second.last_s > kTrackForgotten_s) {
      end_life(life->second);
      life = lives_.erase(life);
    } else {
      ++life;
    }
  }
}

void TrackJudge::end_life(const Life& life) {
  if (2 * life.lists_at_none <= life.lists) return;
  const double life_s = life.last_s - life.first_s;
  const std::size_t band = band_of({life.range_sum_m / static_cast<double>(life.lists), 0.0}).value_or(kBands - 1);
  for (FalseCounts* const counts : {&false_[band], &false_[kAllBands]}) {
    ++counts->tracks;
    if (life_s >= kShortFalseLife_s) ++counts->short_lives;
    if (life_s >= kLongFalseLife_s) ++counts->long_lives;
    counts->lists += life.lists;
  }
}

void TrackJudge::end_stay(ObjectRecord& record) {
  if (record.stays && record.last_s - record.since_s >= kShortestView_s) {
    const double delay_s = record.found_s - record.since_s;
    const bool is_found = record.found_s >= record.since_s;
    change_cells(record.object_class, record.first_band, [&](Cell& cell) {
      ++cell.stays;
      if (!is_found) return;
      ++cell.stays_found;
      cell.delays_s.push_back(delay_s);
    });
  }
  record.stays = false;
}

void TrackJudge::judge_errors(const TrueObject& object, const ScoredTrack& track, std::size_t band) {
  const Eigen::Vector2d error = track.position_m - object.box.position_m;
  const double c = std::cos(object.box.heading_rad), s = std::sin(object.box.heading_rad);
  const Eigen::Matrix2d& p = track.position_covariance_m2;
  const double determinant = p.determinant();
  const bool has_covariance = p.allFinite() && p(0, 0) > 0.0 && determinant > 0.0;
  const double distance = has_covariance ? error.dot(p.inverse() * error) : 0.0;
  change_cells(object.object_class, band, [&](Cell& cell) {
    cell.along_m2 += squared(c * error.x() + s * error.y());
    cell.across_m2 += squared(-s * error.x() + c * error.y());
    cell.speed_m2ps2 += squared(track.velocity_mps.norm() - object.box.velocity_mps.norm());
    cell.heading_rad2 += squared(geometry::wrap_angle(track.heading_rad - object.box.heading_rad));
    cell.length_m2 += squared(track.length_m - object.box.length_m);
    cell.width_m2 += squared(track.width_m - object.box.width_m);
    if (!has_covariance) return;
    ++cell.errors_with_covariance;
    cell.errors_inside += distance <= kChiSquared95 ? 1 : 0;
  });
}

void TrackJudge::judge_object(double t_s, const TrueObject& object, const ScoredTrack* track) {
  if (!is_scored(object)) return;
  const std::size_t band = *band_of(object.box.position_m);
  ObjectRecord& record = records_[object.box.id];
  record.object_class = object.object_class;
  if (record.stays && t_s - record.last_s > kLongestGapInView_s) end_stay(record);
  if (!record.stays) {
    record.stays = true;
    record.since_s = record.last_s = t_s;
    record.found_s = -1.0;
    record.first_band = band;
    record.track = 0;
    record.is_tracked = false;
  }
  const double step_s = std::max(0.0, t_s - record.last_s);
  record.last_s = std::max(record.last_s, t_s);
  for (const std::size_t each : {band, kAllBands}) {
    record.in_view_s[each] += step_s;
    record.found[each] = record.found[each] || track != nullptr;
  }
  const bool resumes = track != nullptr && !record.is_tracked && record.track != 0;
  const bool switches = track != nullptr && record.track != 0 && record.track != track->id;
  change_cells(object.object_class, band, [&](Cell& cell) {
    ++cell.lists_in_view;
    cell.lists_tracked += track != nullptr ? 1 : 0;
    cell.fragments += resumes ? 1 : 0;
    cell.switches += switches ? 1 : 0;
  });
  record.is_tracked = track != nullptr;
  if (track == nullptr) return;
  if (record.found_s < record.since_s) record.found_s = t_s;
  record.track = track->id;
  judge_errors(object, *track, band);
}

void TrackJudge::judge_gospa(std::span<const TrueObject> objects) {
  object_ellipses_.clear();
  track_ellipses_.clear();
  for (const TrueObject& object : objects) {
    if (!is_scored(object)) continue;
    const Object& box = object.box;
    object_ellipses_.push_back(ellipse_in_box(box.position_m, box.heading_rad, box.length_m, box.width_m));
  }
  for (std::size_t k = 0; k < confirmed_.size(); ++k) {
    const ScoredTrack& track = confirmed_[k];
    const std::size_t o = object_of_track_[k];
    bool counts = false;
    if (o != kNone) {
      counts = is_scored(objects[o]);
    } else if (band_of(track.position_m)) {
      // Tracks at an object that is not demanded are neither right nor false.
      counts = std::none_of(objects.begin(), objects.end(), [&](const TrueObject& object) {
        return !is_scored(object) && (!object.parked || track.says_it_stands()) &&
               object.box.distance_m(track.position_m) <= kMaxTrackDistance_m;
      });
    }
    if (counts) {
      track_ellipses_.push_back(ellipse_in_box(track.position_m, track.heading_rad, track.length_m, track.width_m));
    }
  }
  gospa_squared_ += gospa_.evaluate(object_ellipses_, track_ellipses_, GospaBase::kSquared);
  gospa_root_ += gospa_.evaluate(object_ellipses_, track_ellipses_, GospaBase::kRoot);
}

void TrackJudge::add(double t_s, std::span<const ScoredTrack> tracks, std::span<const TrueObject> objects) {
  ++lists_;
  confirmed_.clear();
  std::copy_if(tracks.begin(), tracks.end(), std::back_inserter(confirmed_),
               [](const ScoredTrack& track) { return track.confirmed; });
  pair_up(objects);
  judge_lives(t_s, objects);
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const std::size_t k = track_of_object_[o];
    judge_object(t_s, objects[o], k == kNone ? nullptr : &confirmed_[k]);
  }
  judge_gospa(objects);
}

void TrackJudge::finish() {
  for (auto& [id, record] : records_) {
    end_stay(record);
    for (std::size_t band = 0; band <= kBands; ++band) {
      if (record.in_view_s[band] < kShortestView_s) continue;
      Cell& cell = cells_[index_of(record.object_class)][band];
      ++cell.objects;
      cell.objects_found += record.found[band] ? 1 : 0;
    }
  }
  records_.clear();
  for (const auto& [id, life] : lives_) end_life(life);
  lives_.clear();
}

void TrackJudge::write(FigureList& figures) const {
  const double lists = static_cast<double>(lists_);
  figures.add("tracks.lists", lists);
  const auto write_cell = [&figures, lists](const std::string& name, const Cell& cell) {
    const auto add = [&](const char* what, double value, std::string_view unit = {}) {
      figures.add("tracks." + name + "." + what, value, unit);
    };
    const bool is_seen = cell.lists_in_view > 0;
    const double tracked = static_cast<double>(cell.lists_tracked);
    const auto rms = [&](double sum) { return std::sqrt(share_of(sum, tracked)); };
    const auto count = [&](std::uint64_t value) { return is_seen ? static_cast<double>(value) : kNaN; };
    add("objects", lists > 0.0 ? static_cast<double>(cell.objects) : kNaN);
    add("objects_found", count(cell.objects_found));
    add("found_share", share_of(static_cast<double>(cell.objects_found), static_cast<double>(cell.objects)));
    add("tracked_share", share_of(tracked, static_cast<double>(cell.lists_in_view)));
    add("stays", lists > 0.0 ? static_cast<double>(cell.stays) : kNaN);
    add("stays_found", count(cell.stays_found));
    add("delay_median_s", quantile_of(cell.delays_s, 0.5), "s");
    add("delay_p90_s", quantile_of(cell.delays_s, 0.9), "s");
    add("delay_max_s", quantile_of(cell.delays_s, 1.0), "s");
    add("along_rms_m", rms(cell.along_m2), "m");
    add("across_rms_m", rms(cell.across_m2), "m");
    add("speed_rms_mps", rms(cell.speed_m2ps2), "m/s");
    add("heading_rms_deg", rms(cell.heading_rad2) * kDegreesPerRadian, "°");
    add("length_rms_m", rms(cell.length_m2), "m");
    add("width_rms_m", rms(cell.width_m2), "m");
    add("identity_switches", count(cell.switches));
    add("fragmentations", count(cell.fragments));
    add("inside_95_share",
        share_of(static_cast<double>(cell.errors_inside), static_cast<double>(cell.errors_with_covariance)));
  };
  for (std::size_t band = kBands + 1; band-- > 0;) {
    Cell all;
    for (std::size_t i = 0; i < kClasses; ++i) all += cells_[i][band];
    write_cell("all." + std::string(kBandNames[band]), all);
    for (std::size_t i = 1; i < kClasses; ++i) {
      write_cell(std::string(kClassNames[i]) + "." + std::string(kBandNames[band]), cells_[i][band]);
    }
  }
  const auto of_lists = [&](double value) { return lists_ > 0 ? value : kNaN; };
  for (std::size_t band = kBands + 1; band-- > 0;) {
    const std::string name = "tracks.false." + std::string(kBandNames[band]) + ".";
    const FalseCounts& counts = false_[band];
    figures.add(name + "tracks", of_lists(static_cast<double>(counts.tracks)));
    figures.add(name + "at_least_0.5_s", of_lists(static_cast<double>(counts.short_lives)));
    figures.add(name + "at_least_2_s", of_lists(static_cast<double>(counts.long_lives)));
    figures.add(name + "mean_at_a_time", share_of(static_cast<double>(counts.lists), lists));
  }
  figures.add("tracks.duplicates.mean_at_a_time", share_of(static_cast<double>(duplicates_), lists));
  figures.add("tracks.pairs_not_considered",
              of_lists(static_cast<double>(pairing_.not_considered() + gospa_.not_considered())));
  for (const auto& [name, parts] : {std::pair("squared", gospa_squared_), std::pair("root", gospa_root_)}) {
    const std::string prefix = "tracks.gospa." + std::string(name) + ".";
    const std::string_view unit = std::string_view(name) == "squared" ? "m²" : "m";
    figures.add(prefix + "total", share_of(parts.total(), lists), unit);
    figures.add(prefix + "localisation", share_of(parts.localisation, lists), unit);
    figures.add(prefix + "missed", share_of(parts.missed, lists), unit);
    figures.add(prefix + "false", share_of(parts.false_tracks, lists), unit);
  }
}

}  // namespace boresight::judge
