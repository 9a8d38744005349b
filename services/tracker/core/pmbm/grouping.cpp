#include "services/tracker/core/pmbm/grouping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boresight::tracking::pmbm {

namespace {
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
}  // namespace

Grouping::Grouping(const Parameters& parameters, const Capacity& capacity)
    : parameters_(parameters), capacity_(capacity) {
  const std::size_t nodes = capacity.measurements + capacity.groups;
  nodes_.reserve(nodes);
  item_of_.reserve(nodes);
  items_.reserve(nodes);
  by_x_.reserve(capacity.measurements);
  x_.reserve(capacity.measurements);
  enters_.reserve(capacity.measurements);
  groups_.reserve(capacity.groups);
  measurements_.reserve(capacity.measurements);
}

std::size_t Grouping::root(std::size_t node) {
  while (nodes_[node].parent != node) {
    nodes_[node].parent = nodes_[nodes_[node].parent].parent;
    node = nodes_[node].parent;
  }
  return node;
}

void Grouping::connect(std::size_t a, std::size_t b, FilterWork& work) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  Node &na = nodes_[a], &nb = nodes_[b];
  // Where objects are joined, half of the room is left to new ones.
  const bool joins_objects = na.objects > 0 && nb.objects > 0;
  if ((joins_objects && (2 * (na.objects + nb.objects) > capacity_.group_objects ||
                         2 * (na.locals + nb.locals) > group_pool(capacity_))) ||
      na.measurements + nb.measurements > capacity_.group_measurements) {
    ++work.cut_gates;
    return;
  }
  na.parent = b;
  nb.objects += na.objects;
  nb.locals += na.locals;
  nb.measurements += na.measurements;
}

template <typename Visit>
void Grouping::for_near(std::span<const Measurement<double>> z, const Vector2<double>& centre, double half_width_m,
                        const Visit& visit) const {
  const auto begin = std::lower_bound(x_.begin(), x_.end(), centre.x - half_width_m);
  for (auto it = begin; it != x_.end() && *it <= centre.x + half_width_m; ++it) {
    const std::size_t i = by_x_[static_cast<std::size_t>(it - x_.begin())];
    visit(i, z[i]);
  }
}

std::span<const WorkItem> Grouping::find(const Model& model, const PoissonPart& poisson, const GroupStore& store,
                                         FilterWork& work) {
  const auto z = model.measurements();
  const std::size_t n = std::min(z.size(), capacity_.measurements), groups = store.size();
  work.dropped_detections += static_cast<std::uint32_t>(z.size() - n);
  nodes_.clear();
  for (std::size_t i = 0; i < n; ++i) nodes_.push_back({i, 0, 1, 0, 1});
  for (std::size_t g = 0; g < groups; ++g) {
    nodes_.push_back({n + g, store.ids(g).size(), store.log_weights(g).size(), store.pool(g).size(), 0});
  }
  by_x_.clear();
  for (std::size_t i = 0; i < n; ++i) by_x_.push_back(i);
  std::sort(by_x_.begin(), by_x_.end(),
            [z](std::size_t a, std::size_t b) { return z[a].position_m.x < z[b].position_m.x; });
  x_.clear();
  for (const std::size_t i : by_x_) x_.push_back(z[i].position_m.x);

  enters_.assign(n, 0);
  for (std::size_t g = 0; g < groups; ++g) {
    for (const LocalHypothesis& local : store.pool(g)) {
      const View<double> view = model.view(local.component);
      if (view.detection_probability < parameters_.min_detection_probability) continue;
      const Component<double>& c = local.component;
      for (std::size_t k = 0; k < view.number_of_readings; ++k) {
        const Reading<double>& reading = view.readings[k];
        const Symmetric2<double> s = c.position_covariance + reading.covariance_m2 + view.noise_m2 +
                                     (reading.knows_scatter ? reading.scatter_m2 : view.spread * extent(c));
        const Symmetric2<double> information = inverse(s);
        const Vector2<double> middle = c.position_m + reading.offset_m;
        for_near(z, middle, std::sqrt(parameters_.gate_chi2 * s.xx), [&](std::size_t i, const auto& m) {
          if (quadratic(information, m.position_m - middle) > parameters_.gate_chi2) return;
          if (view.range_rate_variance > 0.0) {
            const double e = m.range_rate_mps - dot(m.sight, c.velocity_mps);
            const double variance = view.range_rate_variance + quadratic(c.velocity_covariance, m.sight);
            if (e * e > parameters_.gate_chi2 * variance) return;
          }
          enters_[i] = 1;
          connect(i, n + g, work);
        });
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (enters_[i] == 0 && (model.has_births_anywhere() || poisson.is_near(z[i]))) enters_[i] = 2;
  }
  const double link_m = model.link_distance_m();
  for (std::size_t a = 0; a < n; ++a) {
    if (enters_[by_x_[a]] == 0) continue;
    for (std::size_t b = a + 1; b < n && x_[b] - x_[a] <= link_m; ++b) {
      if (enters_[by_x_[b]] == 0 || !model.are_linked(z[by_x_[a]], z[by_x_[b]])) continue;
      connect(by_x_[a], by_x_[b], work);
    }
  }

  // Items by root; their lists by counting.
  items_.clear();
  item_of_.assign(n + groups, kNone);
  const auto item_of = [this](std::size_t node) -> WorkItem& {
    const std::size_t r = root(node);
    if (item_of_[r] == kNone) {
      item_of_[r] = items_.size();
      items_.emplace_back();
    }
    return items_[item_of_[r]];
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (enters_[i] != 0) ++item_of(i).measurements;
  }
  for (std::size_t g = 0; g < groups; ++g) ++item_of(n + g).groups;
  std::size_t first_group = 0, first_measurement = 0;
  for (WorkItem& item : items_) {
    item.first_group = first_group;
    item.first_measurement = first_measurement;
    first_group += item.groups;
    first_measurement += item.measurements;
    item.groups = item.measurements = 0;
  }
  groups_.resize(first_group);
  measurements_.resize(first_measurement);
  for (std::size_t i = 0; i < n; ++i) {
    if (enters_[i] == 0) continue;
    WorkItem& item = item_of(i);
    measurements_[item.first_measurement + item.measurements++] = i;
  }
  for (std::size_t g = 0; g < groups; ++g) {
    WorkItem& item = item_of(n + g);
    groups_[item.first_group + item.groups++] = g;
  }
  for (WorkItem& item : items_) {
    double objects = 0.0, rows = 1.0;
    for (const std::size_t g : this->groups(item)) {
      objects += static_cast<double>(store.ids(g).size());
      rows *= static_cast<double>(store.log_weights(g).size());
    }
    item.size = objects * rows * static_cast<double>(item.measurements + 1);
  }
  std::sort(items_.begin(), items_.end(), [](const WorkItem& a, const WorkItem& b) {
    // What may be new comes last: it takes the room that objects leave.
    if ((a.groups == 0) != (b.groups == 0)) return b.groups == 0;
    if (a.size != b.size) return a.size < b.size;
    return a.first_measurement != b.first_measurement ? a.first_measurement < b.first_measurement
                                                      : a.first_group < b.first_group;
  });
  return items_;
}

}  // namespace boresight::tracking::pmbm
