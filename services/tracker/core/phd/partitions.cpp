#include "services/tracker/core/phd/partitions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "services/tracker/core/numeric.hpp"

namespace boresight::tracking::phd {

void DisjointSets::reset(std::size_t n) {
  parents_.clear();
  for (std::size_t i = 0; i < n; ++i) parents_.push_back(i);
}

std::size_t DisjointSets::root(std::size_t index) {
  while (parents_[index] != index) {
    parents_[index] = parents_[parents_[index]];
    index = parents_[index];
  }
  return index;
}

Partitions::Partitions(const Parameters& parameters, const Capacity& c)
    : parameters_(parameters), capacity_(c), cell_of_key_(std::bit_ceil(2 * c.cells + 2)), sets_(c.group_measurements) {
  const std::size_t n = c.group_measurements;
  cells_.reserve(c.cells);
  partitions_.reserve(c.partitions);
  lists_.reserve(c.partitions * (n + c.group_components));
  labels_.reserve(c.partitions * n);
  tree_.reserve(n);
  lengths_.reserve(n);
  nearest_.reserve(n);
  via_.reserve(n);
  shared_.reserve(c.group_components);
  label_keys_.reserve(n);
  new_labels_.reserve(n);
  indices_.reserve(std::max(c.cells, std::max(n, c.group_components)));
}

void Partitions::begin(std::span<const Measurement<double>> measurements, std::span<const std::uint64_t> keys) {
  z_ = measurements;
  keys_ = keys;
  cells_.clear();
  cell_of_key_.clear();
  partitions_.clear();
  lists_.clear();
  labels_.clear();
}

bool Partitions::has_room(std::size_t new_cells) const {
  return partitions_.size() < partitions_.capacity() && cells_.size() + new_cells <= cells_.capacity();
}

std::int16_t Partitions::find_or_add(std::uint64_t key) {
  int index = cell_of_key_.find(key);
  if (index < 0) {
    index = static_cast<int>(cells_.size());
    static_cast<void>(cell_of_key_.insert(key, index));
    cells_.emplace_back();
  }
  return static_cast<std::int16_t>(index);
}

void Partitions::add(std::span<const std::int16_t> labels) {
  const std::size_t n = z_.size();
  label_keys_.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) label_keys_[static_cast<std::size_t>(labels[i])] ^= keys_[i];
  Partition partition{0, lists_.size(), 0, 0.0};
  std::size_t unknown = 0;
  for (const std::uint64_t key : label_keys_) {
    if (key == 0) continue;
    partition.key += mixed(key);
    if (cell_of_key_.find(key) < 0) ++unknown;
  }
  const bool is_known = std::any_of(partitions_.begin(), partitions_.end(),
                                    [&partition](const Partition& p) { return p.key == partition.key; });
  if (is_known || !has_room(unknown)) return;
  const std::size_t first_new = cells_.size();
  indices_.assign(n, 0);
  for (std::size_t l = 0; l < n; ++l) {
    if (label_keys_[l] == 0) continue;
    indices_[l] = find_or_add(label_keys_[l]);
    lists_.push_back(indices_[l]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::int16_t index = indices_[static_cast<std::size_t>(labels[i])];
    if (static_cast<std::size_t>(index) >= first_new) cells_[static_cast<std::size_t>(index)].add(z_[i], keys_[i]);
    labels_.push_back(index);
  }
  partition.number_of_cells = lists_.size() - partition.first_cell;
  partitions_.push_back(partition);
}

void Partitions::label_by_root() {
  new_labels_.clear();
  for (std::size_t i = 0; i < z_.size(); ++i) new_labels_.push_back(static_cast<std::int16_t>(sets_.root(i)));
}

void Partitions::join_predicted(const Model& model, std::span<const std::int16_t> objects, Rest rest) {
  sets_.reset(z_.size());
  for (std::size_t a = 0; a < z_.size(); ++a) {
    for (std::size_t b = a + 1; b < z_.size(); ++b) {
      if (objects[a] != objects[b]) continue;
      if (objects[a] != kNone || (rest == Rest::kLinked && model.are_linked(z_[a], z_[b]))) sets_.join(a, b);
    }
  }
  label_by_root();
}

void Partitions::add_predicted(const Model& model, std::span<const std::int16_t> objects, Rest rest) {
  join_predicted(model, objects, rest);
  add(new_labels_);
}

void Partitions::add_shared(const Model& model, std::span<const std::int16_t> objects, std::span<const double> shares,
                            std::size_t columns, Rest rest) {
  const std::size_t n = z_.size();
  Partition partition{0, lists_.size(), 0, 0.0};
  shared_.assign(columns, Cell<double>{});
  const auto add_entropy = [&partition](double share) {
    if (share > 0.0) partition.log_count -= share * std::log(share);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (objects[i] == kNone) continue;
    double clutter = 1.0;
    for (std::size_t k = 0; k < columns; ++k) {
      const double share = shares[i * columns + k];
      if (share <= 0.0) continue;
      clutter -= share;
      add_entropy(share);
      shared_[k].add(z_[i], share);
    }
    add_entropy(clutter);
  }
  if (partition.log_count < parameters_.least_entropy || !has_room(columns + n)) return;
  indices_.assign(columns, kNone);
  for (std::size_t k = 0; k < columns; ++k) {
    if (shared_[k].n < parameters_.least_cell) continue;
    // A shared cell is never a single detection of clutter.
    if (shared_[k].n == 1.0) shared_[k].n = std::nextafter(shared_[k].n, kInfinity);
    indices_[k] = static_cast<std::int16_t>(cells_.size());
    cells_.push_back(shared_[k]);
    lists_.push_back(indices_[k]);
  }
  // The rest as in the prediction partition.
  join_predicted(model, objects, rest);
  label_keys_.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i) label_keys_[static_cast<std::size_t>(new_labels_[i])] ^= keys_[i];
  const std::size_t first_new = cells_.size(), first_label = labels_.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (objects[i] == kNone) {
      const std::int16_t index = find_or_add(label_keys_[static_cast<std::size_t>(new_labels_[i])]);
      if (static_cast<std::size_t>(index) >= first_new) cells_[static_cast<std::size_t>(index)].add(z_[i], keys_[i]);
      labels_.push_back(index);
      continue;
    }
    std::int16_t label = kNone;
    double most = 0.0;
    for (std::size_t k = 0; k < columns; ++k) {
      if (indices_[k] == kNone || shares[i * columns + k] <= most) continue;
      most = shares[i * columns + k];
      label = indices_[k];
    }
    labels_.push_back(label);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_root = static_cast<std::size_t>(new_labels_[i]) == i;
    if (objects[i] == kNone && is_root) lists_.push_back(labels_[first_label + i]);
  }
  partition.number_of_cells = lists_.size() - partition.first_cell;
  partitions_.push_back(partition);
}

void Partitions::find_tree(const Model& model) {
  // Prim's algorithm: single linkage joins along the tree of shortest distances.
  const std::size_t n = z_.size();
  tree_.clear();
  nearest_.assign(n, kInfinity);
  via_.assign(n, 0);
  std::size_t latest = 0;
  nearest_[0] = -1.0;  // negative: in the tree
  for (std::size_t joined = 1; joined < n; ++joined) {
    std::size_t next = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (nearest_[i] < 0.0) continue;
      const double d2 = squared_norm(z_[i].position_m - z_[latest].position_m);
      if (d2 < nearest_[i] && model.are_linked(z_[i], z_[latest])) {
        nearest_[i] = d2;
        via_[i] = latest;
      }
      if (next == n || nearest_[i] < nearest_[next]) next = i;
    }
    if (nearest_[next] < kInfinity) tree_.push_back({nearest_[next], next, via_[next]});
    nearest_[next] = -1.0;
    latest = next;
  }
  std::sort(tree_.begin(), tree_.end(), [](const Link& x, const Link& y) {
    return x.squared_distance != y.squared_distance ? x.squared_distance < y.squared_distance : x.a < y.a;
  });
}

void Partitions::add_by_distance(const Model& model) {
  find_tree(model);
  lengths_.assign(1, 0);
  for (std::size_t links = 0; links < tree_.size();) {
    const double length = tree_[links].squared_distance;
    while (links < tree_.size() && tree_[links].squared_distance == length) ++links;
    lengths_.push_back(links);
  }
  // Half of the room is left to splits.
  const std::size_t steps = lengths_.size(), most = std::max<std::size_t>(2, capacity_.partitions / 2);
  const std::size_t count = std::min(most, steps);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t step = count == 1 ? 0 : (count - 1 - k) * (steps - 1) / (count - 1);
    sets_.reset(z_.size());
    for (std::size_t link = 0; link < lengths_[step]; ++link) sets_.join(tree_[link].a, tree_[link].b);
    label_by_root();
    add(new_labels_);
  }
}

void Partitions::split(std::size_t partition, std::int16_t cell) {
  const std::size_t n = z_.size();
  const auto labels = this->labels(partition);
  const Cell<double>& whole = cells_[static_cast<std::size_t>(cell)];
  // k-means with k = 2, from the two sides of the middle along the longest axis.
  const Symmetric2<double> s = whole.scatter();
  const double angle_rad = 0.5 * std::atan2(2.0 * s.xy, s.xx - s.yy);
  Vector2<double> middle = whole.mean(), direction{std::cos(angle_rad), std::sin(angle_rad)};
  new_labels_.assign(n, 0);
  for (std::size_t round = 0; round < n; ++round) {
    std::array<Vector2<double>, 2> sum{};
    std::array<double, 2> count{};
    bool changed = round == 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (labels[i] != cell) continue;
      const std::size_t side = dot(z_[i].position_m - middle, direction) > 0.0 ? 1 : 0;
      changed = changed || new_labels_[i] != static_cast<std::int16_t>(side);
      new_labels_[i] = static_cast<std::int16_t>(side);
      sum[side] = sum[side] + z_[i].position_m;
      count[side] += 1.0;
    }
    if (count[0] == 0.0 || count[1] == 0.0) return;
    if (!changed) break;
    const Vector2<double> a = (1.0 / count[0]) * sum[0], b = (1.0 / count[1]) * sum[1];
    middle = 0.5 * (a + b);
    direction = b - a;
  }
  // The other cells are numbered after the two sides.
  indices_.assign(cells_.size(), -1);
  std::int16_t next = 2;
  for (std::size_t i = 0; i < n; ++i) {
    if (labels[i] == cell) continue;
    std::int16_t& name = indices_[static_cast<std::size_t>(labels[i])];
    if (name < 0) name = next++;
    new_labels_[i] = name;
  }
  add(new_labels_);
}

}  // namespace boresight::tracking::phd
