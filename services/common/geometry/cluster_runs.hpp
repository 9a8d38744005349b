// Groups labelled items by cluster: a counting sort in two passes, without comparison or allocation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boresight::geometry {

template <typename Item>
class ClusterRuns {
 public:
  /// Allocates for at most `capacity` items.
  explicit ClusterRuns(std::size_t capacity) : capacity_(capacity) {
    items_.reserve(capacity);
    begins_.reserve(capacity + 1);
  }

  /// Copies the items with a label 0 … clusters − 1. Skips others (noise), items without a label, and items and
  /// clusters beyond the capacity.
  void sort(std::span<const Item> items, std::span<const std::int32_t> labels, std::size_t clusters) {
    clusters = std::min(clusters, capacity_);
    const std::size_t count = std::min({items.size(), labels.size(), capacity_});
    const auto is_in = [&](std::int32_t label) { return label >= 0 && static_cast<std::size_t>(label) < clusters; };
    // Each cluster's end first; entering the items moves it down to the begin.
    begins_.assign(clusters + 1, 0);
    for (const std::int32_t label : labels.first(count)) {
      if (is_in(label)) ++begins_[static_cast<std::size_t>(label)];
    }
    for (std::size_t c = 1; c <= clusters; ++c) begins_[c] += begins_[c - 1];
    items_.resize(begins_[clusters]);
    for (std::size_t i = count; i-- > 0;) {
      if (is_in(labels[i])) items_[--begins_[static_cast<std::size_t>(labels[i])]] = items[i];
    }
  }

  [[nodiscard]] std::size_t size() const { return begins_.empty() ? 0 : begins_.size() - 1; }
  /// The items of a cluster of the last call, in their given order. The caller may change them.
  [[nodiscard]] std::span<Item> operator[](std::size_t cluster) {
    return {items_.data() + begins_[cluster], begins_[cluster + 1] - begins_[cluster]};
  }

 private:
  std::size_t capacity_;
  std::vector<Item> items_;            // by cluster
  std::vector<std::uint32_t> begins_;  // of each cluster, and the end of the last one
};

}  // namespace boresight::geometry
