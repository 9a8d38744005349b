#include "services/tracker/core/pmbm/group.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace boresight::tracking::pmbm {

namespace {

/// Rows of a group in work: candidates before the reduction, or products of rows while groups are joined.
std::size_t working_rows(const Capacity& c) {
  return std::max(c.candidates, c.rows * c.rows);
}

}  // namespace

Group::Group(const Capacity& c) : stride(c.group_objects), alike(std::bit_ceil(2 * group_pool(c))) {
  ids.reserve(c.group_objects);
  pool.reserve(group_pool(c));
  log_weights.reserve(working_rows(c));
  table.reserve(working_rows(c) * stride);
}

void Group::clear() {
  ids.clear();
  pool.clear();
  log_weights.clear();
  table.clear();
}

bool Group::add_row(double log_weight) {
  if (log_weights.size() == log_weights.capacity()) return false;
  log_weights.push_back(log_weight);
  table.resize(table.size() + stride);
  std::fill(table.end() - static_cast<std::ptrdiff_t>(stride), table.end(), std::int16_t{-1});
  return true;
}

bool Group::add_column(std::uint32_t id) {
  if (ids.size() == stride) return false;
  ids.push_back(id);
  return true;
}

int Group::add_local(const LocalHypothesis& local) {
  if (pool.size() == pool.capacity()) return -1;
  pool.push_back(local);
  return static_cast<int>(pool.size()) - 1;
}

void Group::erase_row(std::size_t row) {
  log_weights.erase(log_weights.begin() + static_cast<std::ptrdiff_t>(row));
  const auto begin = table.begin() + static_cast<std::ptrdiff_t>(row * stride);
  table.erase(begin, begin + static_cast<std::ptrdiff_t>(stride));
}

void Group::normalise() {
  double best = -std::numeric_limits<double>::infinity();
  for (const double w : log_weights) best = std::max(best, w);
  double sum = 0.0;
  for (const double w : log_weights) sum += std::exp(w - best);
  const double log_sum = best + std::log(sum);
  for (double& w : log_weights) w -= log_sum;
}

double Group::existence(std::size_t column) const {
  double sum = 0.0;
  for (std::size_t r = 0; r < rows(); ++r) {
    const std::int16_t l = at(r, column);
    if (l >= 0) sum += std::exp(log_weights[r]) * pool[static_cast<std::size_t>(l)].existence;
  }
  return sum;
}

void Group::join_equal_rows() {
  for (std::size_t i = 0; i < rows(); ++i) {
    for (std::size_t j = i + 1; j < rows();) {
      bool equal = true;
      for (std::size_t c = 0; c < columns() && equal; ++c) equal = at(i, c) == at(j, c);
      if (!equal) {
        ++j;
        continue;
      }
      log_weights[i] = std::log(std::exp(log_weights[i]) + std::exp(log_weights[j]));
      erase_row(j);
    }
  }
}

void Group::merge_similar_rows(double merge_distance) {
  // Many rows differ in the same hypotheses.
  alike.clear();
  const auto are_alike = [&](std::int16_t a, std::int16_t b) {
    const auto la = static_cast<std::size_t>(a), lb = static_cast<std::size_t>(b);
    const std::uint64_t key = la * pool.capacity() + lb;
    int known = alike.find(key);
    if (known < 0) {
      known = distance(pool[la].component, pool[lb].component, merge_distance) < merge_distance ? 1 : 0;
      static_cast<void>(alike.insert(key, known));
    }
    return known == 1;
  };
  for (std::size_t i = 0; i < rows(); ++i) {
    for (std::size_t j = i + 1; j < rows();) {
      std::size_t different = 0, existing = 0;
      bool is_one = true;
      for (std::size_t c = 0; c < columns() && is_one; ++c) {
        const std::int16_t a = at(i, c), b = at(j, c);
        if (a == b) continue;
        ++different;
        if (a < 0 || b < 0) {
          ++existing;
          is_one = different == 1;
          continue;
        }
        is_one = existing == 0 && are_alike(a, b);
      }
      if (!is_one || pool.size() + different > pool.capacity()) {
        ++j;
        continue;
      }
      const double wi = std::exp(log_weights[i]), wj = std::exp(log_weights[j]);
      for (std::size_t c = 0; c < columns(); ++c) {
        const std::int16_t a = at(i, c), b = at(j, c);
        if (a == b) continue;
        static const LocalHypothesis kNone{};
        const LocalHypothesis& la = a < 0 ? kNone : pool[static_cast<std::size_t>(a)];
        const LocalHypothesis& lb = b < 0 ? kNone : pool[static_cast<std::size_t>(b)];
        LocalHypothesis merged;
        merged.existence = (wi * la.existence + wj * lb.existence) / (wi + wj);
        const bool second = a < 0 || (b >= 0 && wj > wi);
        merged.detections = second ? lb.detections : la.detections;
        merged.scatter = second ? lb.scatter : la.scatter;
        merged.mean_m = second ? lb.mean_m : la.mean_m;
        merged.shared = second ? lb.shared : la.shared;
        if (a < 0 || b < 0) {
          merged.component = second ? lb.component : la.component;
        } else {
          const std::array<WeightedComponent<double>, 2> two{
              {{wi * la.existence, &la.component}, {wj * lb.existence, &lb.component}}};
          merged.component = merge<double>(two);
        }
        at(i, c) = static_cast<std::int16_t>(add_local(merged));
      }
      log_weights[i] = std::log(wi + wj);
      erase_row(j);
    }
  }
}

void Group::prune_rows(double prune_weight, std::size_t most) {
  // A selection sort of few rows: the likeliest first.
  for (std::size_t i = 0; i < rows() && i < most; ++i) {
    const auto best = static_cast<std::size_t>(
        std::max_element(log_weights.begin() + static_cast<std::ptrdiff_t>(i), log_weights.end()) -
        log_weights.begin());
    if (best == i) continue;
    std::swap(log_weights[i], log_weights[best]);
    for (std::size_t c = 0; c < columns(); ++c) std::swap(at(i, c), at(best, c));
  }
  const double limit = std::log(prune_weight);
  while (rows() > most || (rows() > 1 && log_weights.back() < limit)) erase_row(rows() - 1);
  normalise();
}

GroupStore::GroupStore(const Capacity& c) : capacity_(c) {
  spans_.reserve(c.groups);
  ids_.reserve(c.objects);
  pool_.reserve(c.local_hypotheses);
  log_weights_.reserve(c.groups * c.rows);
  table_.reserve(c.objects * c.rows);
  renamed_.reserve(group_pool(c));
  products_.reserve(c.rows * c.rows);
  old_table_.reserve(c.rows * c.group_objects);
}

void GroupStore::clear() {
  spans_.clear();
  ids_.clear();
  pool_.clear();
  log_weights_.clear();
  table_.clear();
}

std::span<LocalHypothesis> GroupStore::pool(std::size_t g) {
  return {pool_.data() + spans_[g].pool, spans_[g].locals};
}
std::span<const LocalHypothesis> GroupStore::pool(std::size_t g) const {
  return {pool_.data() + spans_[g].pool, spans_[g].locals};
}
std::span<const std::uint32_t> GroupStore::ids(std::size_t g) const {
  return {ids_.data() + spans_[g].ids, spans_[g].columns};
}
std::span<const double> GroupStore::log_weights(std::size_t g) const {
  return {log_weights_.data() + spans_[g].weights, spans_[g].rows};
}
std::int16_t GroupStore::at(std::size_t g, std::size_t row, std::size_t column) const {
  const Span& s = spans_[g];
  return table_[s.table + row * s.columns + column];
}

void GroupStore::erase(std::size_t group, std::size_t column) {
  const Span& s = spans_[group];
  for (std::size_t r = 0; r < s.rows; ++r) table_[s.table + r * s.columns + column] = -1;
}

bool GroupStore::store(const Group& group, std::span<const std::size_t> columns) {
  if (spans_.size() == spans_.capacity() || ids_.size() + columns.size() > ids_.capacity() ||
      log_weights_.size() + group.rows() > log_weights_.capacity() ||
      table_.size() + group.rows() * columns.size() > table_.capacity()) {
    return false;
  }
  const Span span{ids_.size(), columns.size(), pool_.size(), 0, log_weights_.size(), group.rows(), table_.size()};
  renamed_.assign(group.pool.size(), -1);
  for (const std::size_t c : columns) ids_.push_back(group.ids[c]);
  for (std::size_t r = 0; r < group.rows(); ++r) {
    log_weights_.push_back(group.log_weights[r]);
    for (const std::size_t c : columns) {
      const std::int16_t l = group.at(r, c);
      if (l < 0) {
        table_.push_back(-1);
        continue;
      }
      int& name = renamed_[static_cast<std::size_t>(l)];
      if (name < 0) {
        if (pool_.size() == pool_.capacity()) {  // undo: nothing of the group is kept
          ids_.resize(span.ids);
          pool_.resize(span.pool);
          log_weights_.resize(span.weights);
          table_.resize(span.table);
          return false;
        }
        name = static_cast<int>(pool_.size() - span.pool);
        pool_.push_back(group.pool[static_cast<std::size_t>(l)]);
      }
      table_.push_back(static_cast<std::int16_t>(name));
    }
  }
  spans_.push_back(span);
  spans_.back().locals = pool_.size() - span.pool;
  return true;
}

bool GroupStore::store_alone(std::uint32_t id, const LocalHypothesis& local) {
  if (spans_.size() == spans_.capacity() || ids_.size() == ids_.capacity() || pool_.size() == pool_.capacity() ||
      log_weights_.size() == log_weights_.capacity() || table_.size() == table_.capacity()) {
    return false;
  }
  spans_.push_back({ids_.size(), 1, pool_.size(), 1, log_weights_.size(), 1, table_.size()});
  ids_.push_back(id);
  pool_.push_back(local);
  log_weights_.push_back(0.0);
  table_.push_back(0);
  return true;
}

bool GroupStore::join_into(Group& group, std::size_t stored, std::size_t most) {
  const Span& s = spans_[stored];
  if (group.columns() + s.columns > group.stride || group.pool.size() + s.locals > group.pool.capacity()) return false;
  if (group.rows() == 0) group.add_row(0.0);
  const std::size_t offset = group.pool.size(), had = group.columns();
  const auto locals = pool(stored);
  group.pool.insert(group.pool.end(), locals.begin(), locals.end());
  for (const std::uint32_t id : ids(stored)) group.ids.push_back(id);

  products_.clear();
  for (std::size_t a = 0; a < group.rows(); ++a) {
    for (std::size_t b = 0; b < s.rows; ++b) {
      products_.push_back({group.log_weights[a] + log_weights(stored)[b], a, b});
    }
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::min(most, products_.size()));
  std::partial_sort(products_.begin(), products_.begin() + kept, products_.end(),
                    [](const Product& x, const Product& y) { return x.log_weight > y.log_weight; });
  products_.resize(static_cast<std::size_t>(kept));

  old_table_.assign(group.table.begin(), group.table.end());
  group.log_weights.clear();
  group.table.clear();
  for (const Product& p : products_) {
    group.add_row(p.log_weight);
    const std::size_t row = group.rows() - 1;
    for (std::size_t c = 0; c < had; ++c) group.at(row, c) = old_table_[p.first * group.stride + c];
    for (std::size_t c = 0; c < s.columns; ++c) {
      const std::int16_t l = at(stored, p.second, c);
      group.at(row, had + c) =
          l < 0 ? std::int16_t{-1} : static_cast<std::int16_t>(offset + static_cast<std::size_t>(l));
    }
  }
  return true;
}

}  // namespace boresight::tracking::pmbm
