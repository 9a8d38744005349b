#include "tests/benchmarks/realism/statistics/object_counts.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::bench::realism {

namespace {

constexpr double kOffEnds_s = 0.3;       // at the first and last detection of an object; Schumann et al.
constexpr double kTrackBin_m = 10.0;     // range bin of a track
constexpr std::size_t kLeastOfBin = 10;  // scans; with fewer the mean of the bin hides a correlation

std::size_t index_of(RoadUser user) {
  return static_cast<std::size_t>(user);
}

}  // namespace

void ObjectCounts::add(const ObservedScan& scan) {
  for (const ObservedObject& object : scan.objects) {
    const auto count =
        static_cast<unsigned>(std::count_if(scan.detections.begin(), scan.detections.end(),
                                            [&](const ObservedDetection& d) { return d.is_direct_of(object.id); }));
    open_[{scan.radar, object.id}].push_back({scan.t_s, scan.number, object.user, static_cast<float>(object.range_m),
                                              static_cast<float>(object.aspect_rad), count, object.in_sight});
    if (count == 0) continue;
    const auto [entry, is_new] = detected_s_.try_emplace(object.id, scan.t_s, scan.t_s);
    if (!is_new) entry->second.second = scan.t_s;
  }
}

void ObjectCounts::end_drive() {
  for (const auto& [key, visits] : open_) {
    const auto detected = detected_s_.find(key.second);
    Series from_first, in_sight;
    for (const Visit& v : visits) {
      if (v.in_sight) in_sight.push_back(v);
      if (detected == detected_s_.end()) continue;
      const auto [first_s, last_s] = detected->second;
      if (v.t_s > first_s + kOffEnds_s && v.t_s < last_s - kOffEnds_s) from_first.push_back(v);
    }
    close(from_first, Counting::kFirstToLast);
    close(in_sight, Counting::kInSight);
  }
  open_.clear();
  detected_s_.clear();
}

void ObjectCounts::close(const Series& series, Counting counting) {
  Sums& sums = sums_[static_cast<std::size_t>(counting)];
  for (const Visit& v : series) sums.all.push_back({v.user, v.range_m, v.aspect_rad, v.count});
  // A run: successive scans of the radar with the object as the same kind of road user.
  Series run;
  for (const Visit& v : series) {
    if (!run.empty() && (v.scan != run.back().scan + 1 || v.user != run.back().user)) {
      add_runs(run, sums);
      run.clear();
    }
    run.push_back(v);
  }
  add_runs(run, sums);
  add_bins(series, sums);
}

void ObjectCounts::add_runs(const Series& run, Sums& sums) {
  if (run.empty()) return;
  const std::size_t user = index_of(run.front().user);
  std::size_t missed = 0;
  bool seen = false;
  for (std::size_t i = 0; i < run.size(); ++i) {
    if (i > 0 && run[i - 1].count == 0) sums.none_after_none[user].add(run[i].count == 0);
    if (run[i].count == 0) {
      ++missed;
      continue;
    }
    if (seen && missed > 0) sums.gaps[user].add(static_cast<double>(missed));
    seen = true;
    missed = 0;
  }
}

void ObjectCounts::add_bins(const Series& series, Sums& sums) {
  std::map<std::pair<RoadUser, int>, std::vector<const Visit*>> bins;
  for (const Visit& v : series) {
    bins[{v.user, static_cast<int>(static_cast<double>(v.range_m) / kTrackBin_m)}].push_back(&v);
  }
  for (const auto& [key, visits] : bins) {
    if (visits.size() < kLeastOfBin) continue;
    const std::size_t user = index_of(key.first);
    std::vector<double> counts;
    std::vector<double> steps(visits.back()->scan - visits.front()->scan + 1, kNoFigure);
    for (const Visit* v : visits) {
      counts.push_back(v->count);
      steps[v->scan - visits.front()->scan] = v->count;
    }
    sums.in_track[user].add_group(counts);
    for (std::size_t k = 0; k < kLags.size(); ++k) sums.correlation[user][k].add_series(steps, kLags[k]);
  }
}

void ObjectCounts::merge(const ObjectCounts& other) {
  for (std::size_t c = 0; c < kCountings; ++c) {
    Sums& mine = sums_[c];
    const Sums& its = other.sums_[c];
    mine.all.insert(mine.all.end(), its.all.begin(), its.all.end());
    for (std::size_t u = 0; u < kRoadUsers; ++u) {
      mine.none_after_none[u].merge(its.none_after_none[u]);
      mine.gaps[u].merge(its.gaps[u]);
      mine.in_track[u].merge(its.in_track[u]);
      for (std::size_t k = 0; k < kLags.size(); ++k) mine.correlation[u][k].merge(its.correlation[u][k]);
    }
  }
}

template <typename Use>
void ObjectCounts::for_each(Counting counting, const CountSelection& of, const Use& use) const {
  for (const Counted& c : sums_[static_cast<std::size_t>(counting)].all) {
    const double range_m = static_cast<double>(c.range_m), aspect_rad = static_cast<double>(c.aspect_rad);
    if (c.user != of.user || range_m < of.range_from_m || range_m >= of.range_to_m) continue;
    if (aspect_rad < of.aspect_from_rad || aspect_rad > of.aspect_to_rad) continue;
    use(c.count);
  }
}

double ObjectCounts::mean(Counting counting, const CountSelection& of) const {
  double sum = 0.0, n = 0.0;
  for_each(counting, of, [&](unsigned count) {
    sum += count;
    n += 1.0;
  });
  return n > 0.0 ? sum / n : kNoFigure;
}

double ObjectCounts::percent_none(Counting counting, const CountSelection& of) const {
  Share none;
  for_each(counting, of, [&](unsigned count) { none.add(count == 0); });
  return none.percent();
}

double ObjectCounts::variance_over_mean(Counting counting, const CountSelection& of) const {
  std::vector<double> counts;
  for_each(counting, of, [&](unsigned count) { counts.push_back(count); });
  WithinGroups one;
  one.add_group(counts);
  return one.variance_over_mean();
}

double ObjectCounts::most(const CountSelection& of) const {
  double most = kNoFigure;
  for_each(Counting::kInSight, of, [&](unsigned count) { most = std::fmax(most, count); });
  return most;
}

double ObjectCounts::none_after_none(Counting counting, RoadUser user) const {
  return sums_[static_cast<std::size_t>(counting)].none_after_none[index_of(user)].value();
}

const Samples& ObjectCounts::gaps(Counting counting, RoadUser user) const {
  return sums_[static_cast<std::size_t>(counting)].gaps[index_of(user)];
}

double ObjectCounts::variance_over_mean_in_track(Counting counting, RoadUser user) const {
  return sums_[static_cast<std::size_t>(counting)].in_track[index_of(user)].variance_over_mean();
}

double ObjectCounts::correlation(Counting counting, RoadUser user, std::size_t lag) const {
  const auto place = std::find(kLags.begin(), kLags.end(), lag);
  if (place == kLags.end()) return kNoFigure;
  return sums_[static_cast<std::size_t>(counting)]
      .correlation[index_of(user)][static_cast<std::size_t>(place - kLags.begin())]
      .value();
}

}  // namespace boresight::bench::realism
