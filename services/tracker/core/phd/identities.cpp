// Which components of the intensity are one object: merging after the correction, and identities from scan to scan.
#include <algorithm>

#include "services/tracker/core/phd/phd_filter.hpp"

namespace boresight::tracking::phd {

bool PhdFilter::is_object(std::uint32_t id) const {
  const int index = id == kNew ? -1 : identity_index_.find(id);
  return index >= 0 && identities_[static_cast<std::size_t>(index)].existence >= parameters_.object_probability;
}

bool PhdFilter::may_merge(const Hypothesis& a, const Hypothesis& b) const {
  return parameters_.as_published || a.id == b.id || !is_object(a.id) || !is_object(b.id);
}

void PhdFilter::reduce() {
  by_weight_.clear();
  for (std::size_t i = 0; i < children_.size(); ++i) by_weight_.push_back(i);
  std::sort(by_weight_.begin(), by_weight_.end(), [this](std::size_t a, std::size_t b) {
    const double weight_a = children_[a].local.existence, weight_b = children_[b].local.existence;
    return weight_a != weight_b ? weight_a > weight_b : a < b;
  });
  is_merged_.assign(children_.size(), 0);
  for (const std::size_t i : by_weight_) {
    if (is_merged_[i] != 0) continue;
    if (corrected_.size() == corrected_.capacity()) {
      ++work_.dropped_objects;
      continue;
    }
    // Components like the heaviest one left become one with it. Identity and source are those of the heaviest.
    const Hypothesis& heaviest = children_[i];
    double weight = 0.0;
    mixture_.clear();
    for (const std::size_t j : by_weight_) {
      if (is_merged_[j] != 0) continue;
      const pmbm::LocalHypothesis& other = children_[j].local;
      if (j != i && (!may_merge(heaviest, children_[j]) ||
                     distance(heaviest.local.component, other.component) >= parameters_.merge_distance)) {
        continue;
      }
      is_merged_[j] = 1;
      weight += other.existence;
      mixture_.push_back({other.existence, &other.component});
    }
    corrected_.push_back(
        {heaviest.id,
         {weight, heaviest.local.detections, heaviest.local.scatter, merge<double>(mixture_), heaviest.local.mean_m}});
    corrected_.back().local.component.source = heaviest.local.component.source;
  }
}

void PhdFilter::identify() {
  for (Identity& identity : identities_) {
    const double a = std::min(1.0, identity.detected), q = identity.missed / identity.weight;
    identity.existence = a + (1.0 - a) * missed_existence(identity.existence, q);
  }
  by_weight_.clear();
  for (std::size_t i = 0; i < corrected_.size(); ++i) by_weight_.push_back(i);
  std::sort(by_weight_.begin(), by_weight_.end(), [this](std::size_t a, std::size_t b) {
    const double weight_a = corrected_[a].local.existence, weight_b = corrected_[b].local.existence;
    return weight_a != weight_b ? weight_a > weight_b : a < b;
  });
  if (corrected_.size() > capacity_.components) {
    by_weight_.resize(capacity_.components);
    work_.dropped_objects += static_cast<std::uint32_t>(corrected_.size() - capacity_.components);
  }
  next_identities_.clear();
  next_index_.clear();
  heaviest_.clear();
  store_.clear();
  for (const std::size_t i : by_weight_) {
    Hypothesis& h = corrected_[i];
    int index = next_index_.find(h.id);
    // Published, a second component of an identity that is as heavy as an object is another object.
    const bool is_other = parameters_.as_published && index >= 0 && h.local.existence >= parameters_.object_probability;
    if (h.id == kNew || is_other) {
      h.id = next_id_++;
      index = -1;
    }
    h.local.component.label = h.id;
    if (index >= 0) {
      next_identities_[static_cast<std::size_t>(index)].weight += h.local.existence;
    } else {
      const int before = identity_index_.find(h.id);
      const double existence =
          before >= 0 ? identities_[static_cast<std::size_t>(before)].existence : std::min(1.0, h.local.existence);
      static_cast<void>(next_index_.insert(h.id, static_cast<int>(next_identities_.size())));
      next_identities_.push_back({h.id, existence, h.local.existence, 0.0, 0.0});
      heaviest_.push_back(store_.size());
    }
    static_cast<void>(store_.store_alone(h.id, h.local));  // has room for capacity_.components
  }
  for (std::size_t g = 0; g < store_.size() && !parameters_.as_published; ++g) {
    const Identity& identity = next_identities_[static_cast<std::size_t>(next_index_.find(store_.ids(g).front()))];
    store_.pool(g).front().existence *= identity.existence / identity.weight;
  }
  for (Identity& identity : next_identities_) {
    if (!parameters_.as_published) identity.weight = identity.existence;
  }
  std::swap(identities_, next_identities_);
}

void PhdFilter::report() {
  estimates_.clear();
  for (std::size_t k = 0; k < identities_.size(); ++k) {
    const Identity& identity = identities_[k];
    const pmbm::LocalHypothesis& local = store_.pool(heaviest_[k]).front();
    const double existence = parameters_.as_published ? std::min(1.0, identity.weight) : identity.existence;
    if (existence < parameters_.report_existence) continue;
    ObjectEstimate& e = estimates_.emplace_back();
    e.id = identity.id;
    e.existence = existence * local.component.source.object;
    e.source_existence = existence;
    e.detected = local.detections > 0.0;
    e.detections = local.detections;
    e.scatter = local.scatter;
    e.component = &local.component;
    e.mean_m = local.mean_m;
  }
  std::sort(estimates_.begin(), estimates_.end(), [](const ObjectEstimate& a, const ObjectEstimate& b) {
    return a.existence != b.existence ? a.existence > b.existence : a.id < b.id;
  });
}

}  // namespace boresight::tracking::phd
