#include "services/tracker/core/classical/classical_filter.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "services/tracker/core/classical/velocity.hpp"
#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking::classical {

namespace {

/// Existence after a scan whose detections are so much likelier of the track than of clutter.
double detected_existence(double r, double log_likelihood_ratio) {
  const double odds = r / std::max(kLeastProbability, 1.0 - r) * std::exp(std::min(log_likelihood_ratio, kMostLog));
  return odds / (1.0 + odds);
}

}  // namespace

ClassicalFilter::ClassicalFilter(const Parameters& parameters, std::size_t max_objects, std::size_t max_detections)
    : parameters_(parameters), max_objects_(max_objects), clusters_(max_detections) {
  tracks_.reserve(max_objects);
  views_.reserve(max_objects);
  predictions_.reserve(max_objects);
  existence_.reserve(max_objects);
  estimates_.reserve(max_objects);
  headings_.reserve(max_objects);
  taken_by_.reserve(max_detections);
  explained_.reserve(max_detections);
  is_used_.reserve(max_detections);
  members_.reserve(max_detections);
  pairs_.reserve(4 * max_detections);
}

void ClassicalFilter::clear() {
  tracks_.clear();
  estimates_.clear();
}

void ClassicalFilter::step(Model& model, double elapsed_s) {
  work_ = {};
  predict(model, elapsed_s);
  look(model);
  associate_mature(model);
  number_of_clusters_ = clusters_.find(model.measurements(), taken_by_, parameters_.cluster);
  associate_tentative(model);
  update(model);
  headings_.clear();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (tracks_[k].cell.n > 0.0) find_heading(model, k);
  }
  start(model);
  end_tracks(model);
  join_parts(model);
  report();
}

template <typename Value>
Value ClassicalFilter::of_class(const ByClass<Value>& values, std::span<const double> probabilities) {
  if (probabilities.empty()) return values[static_cast<std::size_t>(extended_object::RoadUserClass::kCar)];
  return values[static_cast<std::size_t>(
      std::distance(probabilities.begin(), std::max_element(probabilities.begin(), probabilities.end())))];
}

filters::ProcessNoise ClassicalFilter::noise_of(const Model& model, const Track& track) const {
  const auto classes = model.class_probabilities(track.id);
  return {of_class(parameters_.motion.jerk_density_m2ps5, classes),
          of_class(parameters_.motion.acceleration_time_s, classes)};
}

void ClassicalFilter::predict(const Model& model, double elapsed_s) {
  for (Track& track : tracks_) {
    const Vector2<double> before_m = track.component.position_m + elapsed_s * track.component.velocity_mps;
    track.existence *= model.predict(track.component, elapsed_s);
    // The axes move with the vehicle.
    const Vector2<double> shift_m = track.component.position_m - before_m;
    static_cast<void>(track.motion.predict(elapsed_s, noise_of(model, track)));
    static_cast<void>(track.motion.shift({-shift_m.x, -shift_m.y}));
    track.since_detection_s += std::max(0.0, elapsed_s);
    const Vector2<double> moved_m = elapsed_s * track.component.velocity_mps + shift_m;
    track.history.move({moved_m.x, moved_m.y}, std::max(0.0, elapsed_s), parameters_.heading.history_s);
    set_kinematics(track.motion.state(), track.component);
    track.cell = {};
    track.shape_heading.reset();
  }
}

void ClassicalFilter::look(const Model& model) {
  views_.clear();
  predictions_.clear();
  existence_.clear();
  for (const Track& track : tracks_) {
    views_.push_back(model.view(track.component));
    predictions_.emplace_back(track.component, views_.back());
    existence_.push_back(track.existence * track.component.source.object);
  }
}

void ClassicalFilter::associate_mature(const Model& model) {
  const auto measurements = model.measurements();
  taken_by_.assign(measurements.size(), kFree);
  explained_.assign(measurements.size(), 0.0);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    // Likelier of a track than of clutter, by the expected number of detections at the place.
    double best = 0.0;
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (!tracks_[k].is_mature || views_[k].detection_probability <= kLeastProbability) continue;
      const Prediction<double>& p = predictions_[k];
      if (p.place_distance(measurements[i].position_m) > parameters_.gate.place_chi2) continue;
      if (p.range_rate_distance(measurements[i]) > parameters_.gate.range_rate_chi2) continue;
      const double likelihood = p.log_intensity(measurements[i]) + std::log(tracks_[k].existence);
      if (likelihood <= best) continue;
      best = likelihood;
      taken_by_[i] = static_cast<std::int32_t>(k);
    }
    if (taken_by_[i] != kFree) tracks_[static_cast<std::size_t>(taken_by_[i])].cell.add(measurements[i], 1.0);
  }
}

void ClassicalFilter::take(std::size_t track, std::size_t cluster) {
  is_used_[cluster] = 1;
  tracks_[track].cell.join(clusters_.cell(cluster));
  for (const std::size_t i : clusters_.members(cluster)) taken_by_[i] = static_cast<std::int32_t>(track);
}

void ClassicalFilter::associate_tentative(const Model& model) {
  is_used_.assign(number_of_clusters_, 0);
  pairs_.clear();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (tracks_[k].cell.n > 0.0 || views_[k].detection_probability <= kLeastProbability) continue;
    Prediction<double>& p = predictions_[k];
    const double log_missed = std::log(p.missed());
    for (std::size_t c = 0; c < number_of_clusters_; ++c) {
      const Cell<double>& cell = clusters_.cell(c);
      if (p.place_distance(cell.mean()) > parameters_.gate.place_chi2) continue;
      if (p.range_rate_distance(model.measurements()[clusters_.members(c)[clusters_.members(c).size() / 2]]) >
          parameters_.gate.range_rate_chi2) {
        continue;
      }
      ++work_.likelihood_evaluations;
      const double log_likelihood = p.log_likelihood(cell);
      if (log_likelihood <= log_missed || pairs_.size() == pairs_.capacity()) continue;
      pairs_.push_back({log_likelihood + std::log(tracks_[k].existence), k, c});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    if (a.log_likelihood != b.log_likelihood) return a.log_likelihood > b.log_likelihood;
    return a.track != b.track ? a.track < b.track : a.cluster < b.cluster;
  });
  for (const Pair& pair : pairs_) {
    if (is_used_[pair.cluster] != 0 || tracks_[pair.track].cell.n > 0.0) continue;
    take(pair.track, pair.cluster);
  }
}

void ClassicalFilter::update(const Model& model) {
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (track.cell.n > 0.0) {
      update_detected(track, predictions_[k], views_[k], model);
      continue;
    }
    track.existence = missed_existence(track.existence, predictions_[k].missed());
    const Component<double> after = predictions_[k].missed_component(track.component);
    track.component = after;
    if (views_[k].detection_probability >= parameters_.life.least_detection_probability) track.looks.add(false);
  }
  for (std::size_t i = 0; i < taken_by_.size(); ++i) {
    if (taken_by_[i] != kFree) explained_[i] = tracks_[static_cast<std::size_t>(taken_by_[i])].existence;
  }
}

void ClassicalFilter::update_detected(Track& track, Prediction<double>& prediction, const View<double>& view,
                                      const Model& model) {
  ++work_.likelihood_evaluations;
  track.existence = detected_existence(track.existence, prediction.log_likelihood(track.cell));
  const auto centre = prediction.centre(track.cell);
  track.component = prediction.updated(track.component, track.cell);
  const Vector2<double> sensor_m = model.sensor_m();
  const CellVelocity rates = cell_velocity(track.cell, view);
  Eigen::Matrix2d covariance_m2;
  covariance_m2 << centre.covariance_m2.xx, centre.covariance_m2.xy, centre.covariance_m2.xy, centre.covariance_m2.yy;
  // A refused measurement leaves the prediction.
  static_cast<void>(track.motion.update({centre.position_m.x, centre.position_m.y}, covariance_m2, rates.along,
                                        {sensor_m.x, sensor_m.y}));
  if (rates.across)
    static_cast<void>(track.motion.update_velocity(rates.across->velocity_mps, rates.across->covariance));
  set_kinematics(track.motion.state(), track.component);
  track.looks.add(true);
  track.unseen_s = track.since_detection_s;
  track.since_detection_s = 0.0;
}

void ClassicalFilter::find_heading(const Model& model, std::size_t k) {
  Track& track = tracks_[k];
  const View<double>& view = views_[k];
  const HeadingParameters& p = parameters_.heading;
  for (std::size_t i = 0; i < taken_by_.size(); ++i) {
    if (taken_by_[i] != static_cast<std::int32_t>(k)) continue;
    const Measurement<double>& z = model.measurements()[i];
    track.history.add({{z.position_m.x, z.position_m.y},
                       0.5 * trace(view.noise_m2),
                       {z.sight.x, z.sight.y},
                       z.range_rate_mps,
                       view.range_rate_variance,
                       0.0});
  }
  const Component<double>& c = track.component;
  const double speed2 = squared_norm(c.velocity_mps);
  if (!track.is_mature || speed2 <= p.doppler.least_speed_mps * p.doppler.least_speed_mps) return;
  const Vector2<double> across{-c.velocity_mps.y, c.velocity_mps.x};
  HeadingSources sources;
  sources.id = track.id;
  sources.course = Heading{std::atan2(c.velocity_mps.y, c.velocity_mps.x),
                           quadratic(c.velocity_covariance, across) / (speed2 * speed2)};
  const double turn_mps = std::sqrt(squared_norm(view.turn_mps));
  const auto points = track.history.points();
  if (const auto line = doppler_line(points, p.doppler, turn_mps)) sources.line = line->heading;
  if (const auto interval = interval_search(points, sources.course->rad, p.doppler, turn_mps)) {
    sources.interval = interval->heading;
  }
  if (sources.course->variance_rad2 < p.known_std_rad * p.known_std_rad) {
    sources.shape = l_shape_heading(points, sources.course->rad, p.shape);
  }
  headings_.push_back(sources);
  if (!sources.shape) return;
  // Successive outlines have the same detections: together they count as one in the time that these last.
  track.shape_heading = sources.shape;
  track.shape_heading->variance_rad2 *= std::max(1.0, p.history_s / std::max(kLeastRange_m, track.unseen_s));
}

void ClassicalFilter::start(Model& model) {
  for (std::size_t c = 0; c < number_of_clusters_; ++c) {
    const Cell<double>& cell = clusters_.cell(c);
    if (is_used_[c] != 0 || clusters_.members(c).size() < static_cast<std::size_t>(parameters_.start.points)) continue;
    if (cell.strengths > 0.0 && cell.strength_sum < parameters_.start.strength_db * cell.strengths) continue;
    members_.clear();
    for (const std::size_t i : clusters_.members(c)) members_.push_back(model.measurements()[i]);
    model.begin_group(members_, predictions_, existence_);
    ++work_.likelihood_evaluations;
    const double existence = detected_existence(0.5, model.log_newborn(cell));
    if (existence < parameters_.start.existence) continue;
    if (tracks_.size() == max_objects_) {
      ++work_.dropped_objects;
      continue;
    }
    const Component<double> newborn = model.newborn(cell);
    const filters::MotionFilter motion(parameters_.filter,
                                       motion_state(newborn, parameters_.motion.first_acceleration_std_mps2));
    if (!motion.is_valid()) continue;
    Track& track = tracks_.emplace_back(motion);
    track.id = next_id_++;
    track.component = newborn;
    track.component.label = track.id;
    track.existence = existence;
    track.cell = cell;
    track.looks.add(true);
    for (const std::size_t i : clusters_.members(c)) explained_[i] = 0.0;  // as new as clutter may be
  }
}

void ClassicalFilter::end_tracks(const Model& model) {
  const LifeParameters& life = parameters_.life;
  std::erase_if(tracks_, [&](Track& track) {
    const auto classes = model.class_probabilities(track.id);
    if (track.looks.hits(of_class(life.confirm_looks, classes)) >= of_class(life.confirm_hits, classes)) {
      track.is_mature = true;
    }
    return track.existence < life.least_existence || track.since_detection_s > of_class(life.coast_s, classes) ||
           track.looks.misses(of_class(life.delete_looks, classes)) >= of_class(life.delete_misses, classes);
  });
}

void ClassicalFilter::join_parts(Model& model) {
  for (std::size_t a = 0; a < tracks_.size(); ++a) {
    for (std::size_t b = a + 1; b < tracks_.size(); ++b) {
      const auto is_sure = [&](const Track& t) {
        return t.is_mature && t.existence * t.component.source.object > parameters_.join_existence;
      };
      if (!is_sure(tracks_[a]) || !is_sure(tracks_[b])) continue;
      const double part_in_whole = model.log_odds_of_part(tracks_[a].component, tracks_[b].component);
      const double whole_in_part = model.log_odds_of_part(tracks_[b].component, tracks_[a].component);
      if (std::max(part_in_whole, whole_in_part) <= 0.0) continue;
      if (whole_in_part > part_in_whole) std::swap(tracks_[a], tracks_[b]);
      Track& whole = tracks_[a];
      Component<double>& c = whole.component;
      const Component<double>& part = tracks_[b].component;
      const std::uint32_t label = std::min(whole.id, tracks_[b].id);
      model.join(c, part, label);
      // Detections of both add up.
      c.rate_inverse_scale =
          c.rate_shape / (c.rate_shape / c.rate_inverse_scale + part.rate_shape / part.rate_inverse_scale);
      whole.id = c.label = label;
      whole.cell.join(tracks_[b].cell);
      tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(b--));
    }
  }
}

void ClassicalFilter::report() {
  estimates_.clear();
  for (const Track& track : tracks_) {
    if (track.existence < parameters_.report_existence) continue;
    ObjectEstimate e;
    e.id = track.id;
    e.source_existence = track.existence;
    e.existence = track.existence * track.component.source.object;
    e.component = &track.component;
    e.detections = track.cell.n;
    e.detected = track.cell.n > 0.0;
    if (e.detected) {
      e.scatter = track.cell.scatter();
      e.mean_m = track.cell.mean();
    }
    e.confirmed = track.is_mature;
    e.shape_heading = track.shape_heading;
    estimates_.push_back(e);
  }
  std::sort(estimates_.begin(), estimates_.end(), [](const ObjectEstimate& a, const ObjectEstimate& b) {
    return a.existence != b.existence ? a.existence > b.existence : a.id < b.id;
  });
}

}  // namespace boresight::tracking::classical
