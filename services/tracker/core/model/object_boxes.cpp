#include "services/tracker/core/model/object_boxes.hpp"

#include <bit>
#include <cmath>

namespace boresight::tracking {

ObjectBoxes::ObjectBoxes(const BoxEstimator& estimator, std::size_t max_objects)
    : estimator_(estimator), index_(std::bit_ceil(2 * max_objects + 2)) {
  records_.reserve(max_objects);
  before_.reserve(max_objects);
}

void ObjectBoxes::clear() {
  records_.clear();
  index_.clear();
}

void ObjectBoxes::begin_scan(const Viewpoint& viewpoint) {
  viewpoint_ = viewpoint;
  for (Record& r : records_) {
    r.is_seen = false;
    r.readings.reset();
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

void ObjectBoxes::learn(std::span<const ObjectEstimate> objects, double elapsed_s, double road_rad) {
  std::swap(records_, before_);
  records_.clear();
  for (const ObjectEstimate& e : objects) {
    if (records_.size() == records_.capacity()) break;
    Record& r = records_.emplace_back();
    // Of the round before: the table is built anew below.
    if (const int known = index_.find(e.id); known >= 0) {
      r = before_[static_cast<std::size_t>(known)];
    } else {
      r.label = e.id;
      r.memory = estimator_.begin();
    }
    // Nothing is known yet of the scan that an object began with.
    const BoxObservation o{elapsed_s,
                           road_rad,
                           std::sqrt(squared_norm(e.component->position_m - viewpoint_.sensor_m)),
                           r.noise_m2,
                           r.is_seen ? e.detections : 0.0,
                           e.mean_m,
                           e.scatter,
                           r.predicted_m,
                           r.predicted_covariance_m2};
    estimator_.update(r.memory, *e.component, o, r.is_seen ? r.views : ClassViews{});
  }
  index_.clear();
  for (std::size_t i = 0; i < records_.size(); ++i) {
    static_cast<void>(index_.insert(records_[i].label, static_cast<int>(i)));
  }
}

Box ObjectBoxes::box(const Component<double>& object) const {
  const Record* r = find(object.label);
  return estimator_.box(r != nullptr ? r->memory : estimator_.begin(), object, viewpoint_.sensor_m);
}

}  // namespace boresight::tracking
