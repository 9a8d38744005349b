#include "services/tracker/core/model/object_boxes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace boresight::tracking {

ObjectBoxes::ObjectBoxes(const BoxEstimator& estimator, const RoadParameters& road, std::size_t max_objects)
    : estimator_(estimator),
      traffic_(road),
      max_objects_(max_objects),
      records_(2 * max_objects),
      index_(std::bit_ceil(2 * max_objects + 2)) {
  used_.reserve(records_.size());
  free_.reserve(records_.size());
  is_kept_.reserve(records_.size());
  clear();
}

void ObjectBoxes::clear() {
  used_.clear();
  free_.clear();
  for (std::size_t i = records_.size(); i > 0; --i) free_.push_back(i - 1);
  index_.clear();
  traffic_.clear();
}

void ObjectBoxes::begin_scan(const Viewpoint& viewpoint) {
  viewpoint_ = viewpoint;
  for (const std::size_t i : used_) {
    records_[i].is_seen = false;
    records_[i].readings.reset();
  }
}

void ObjectBoxes::join(const Component<double>& whole, const Component<double>& part, std::uint32_t label) {
  const int source = index_.find(whole.label), target = index_.find(label);
  if (source < 0 || target < 0) return;
  Record& r = records_[static_cast<std::size_t>(target)];
  r = records_[static_cast<std::size_t>(source)];
  r.label = label;
  estimator_.add_part(r.memory, part.position_m - whole.position_m,
                      whole.position_covariance + part.position_covariance);
}

const ObjectBoxes::Record* ObjectBoxes::find(std::uint32_t label) const {
  const int i = index_.find(label);
  return i < 0 ? nullptr : &records_[static_cast<std::size_t>(i)];
}

ObjectBoxes::Record* ObjectBoxes::see(const Component<double>& predicted, const Symmetric2<double>& noise_m2) {
  const int i = index_.find(predicted.label);
  if (i < 0) return nullptr;
  Record& r = records_[static_cast<std::size_t>(i)];
  if (!r.is_seen) {
    r.is_seen = true;
    r.noise_m2 = noise_m2;
    r.predicted_m = predicted.position_m;
    r.predicted_covariance_m2 = predicted.position_covariance;
    r.views =
        estimator_.view(r.memory, predicted.position_m, std::sqrt(squared_norm(predicted.velocity_mps)), viewpoint_);
  }
  return &r;
}

std::size_t ObjectBoxes::begin_record(std::uint32_t label) {
  const std::size_t i = free_.back();
  free_.pop_back();
  Record& r = records_[i];
  r.label = label;
  r.memory = estimator_.begin();
  r.is_seen = false;
  r.readings.reset();
  return i;
}

void ObjectBoxes::learn(std::span<const ObjectEstimate> objects, double elapsed_s, double road_heading_rad) {
  const Road road = traffic_.road(road_heading_rad);
  traffic_.forget(elapsed_s);
  static const ClassViews kNotSeen{};
  is_kept_.assign(records_.size(), 0);
  const std::size_t had = used_.size();
  for (const ObjectEstimate& e : objects.first(std::min(objects.size(), max_objects_))) {
    const int known = index_.find(e.id);
    const std::size_t i = known >= 0 ? static_cast<std::size_t>(known) : begin_record(e.id);
    Record& r = records_[i];
    is_kept_[i] = 1;
    used_.push_back(i);
    // Nothing is known yet of the scan that an object began with.
    const BoxObservation o{elapsed_s,
                           road,
                           std::sqrt(squared_norm(e.component->position_m - viewpoint_.sensor_m)),
                           r.noise_m2,
                           r.is_seen ? e.detections : 0.0,
                           e.mean_m,
                           e.scatter,
                           r.predicted_m,
                           r.predicted_covariance_m2};
    estimator_.update(r.memory, *e.component, o, r.is_seen ? r.views : kNotSeen);
    if (e.shape_heading) estimator_.observe_heading(r.memory, *e.shape_heading);
    if (squared_norm(e.component->velocity_mps) <= 0.0) continue;
    traffic_.add(estimator_.course(*e.component), road_heading_rad,
                 e.existence * BoxEstimator::vehicle_probability(r.memory) * std::max(0.0, elapsed_s));
  }
  for (std::size_t k = 0; k < had; ++k) {
    if (is_kept_[used_[k]] == 0) free_.push_back(used_[k]);
  }
  used_.erase(used_.begin(), used_.begin() + static_cast<std::ptrdiff_t>(had));
  index_.clear();
  for (const std::size_t i : used_) static_cast<void>(index_.insert(records_[i].label, static_cast<int>(i)));
}

Box ObjectBoxes::box(const Component<double>& object) const {
  const Record* r = find(object.label);
  return estimator_.box(r != nullptr ? r->memory : estimator_.begin(), object, viewpoint_.sensor_m);
}

}  // namespace boresight::tracking
