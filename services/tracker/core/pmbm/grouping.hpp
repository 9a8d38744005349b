// Which stored groups and measurements belong together: connected by gates, or by measurements near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/filter.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/pmbm/group.hpp"
#include "services/tracker/core/pmbm/poisson_part.hpp"

namespace boresight::tracking::pmbm {

/// A group to be updated: stored groups and measurements, as ranges of the lists of Grouping.
struct WorkItem {
  std::size_t first_group = 0, groups = 0;
  std::size_t first_measurement = 0, measurements = 0;
  double size = 0.0;  ///< what is simple comes first
};

class Grouping {
 public:
  Grouping(const Parameters& parameters, const Capacity& capacity);

  /// The items in the order of their size, those without objects last. A connection that would make a group larger than
  /// its capacity is not made, and no more measurements are looked at than there is room for; `work` counts both.
  std::span<const WorkItem> find(const Model& model, const PoissonPart& poisson, const GroupStore& store,
                                 FilterWork& work);
  [[nodiscard]] std::span<const std::size_t> groups(const WorkItem& item) const {
    return {groups_.data() + item.first_group, item.groups};
  }
  [[nodiscard]] std::span<const std::size_t> measurements(const WorkItem& item) const {
    return {measurements_.data() + item.first_measurement, item.measurements};
  }

 private:
  struct Node {
    std::size_t parent = 0;
    std::size_t objects = 0, rows = 1, locals = 0, measurements = 0;
  };
  std::size_t root(std::size_t node);
  void connect(std::size_t a, std::size_t b, FilterWork& work);
  template <typename Visit>
  void for_near(std::span<const Measurement<double>> z, const Vector2<double>& centre, double half_width_m,
                const Visit& visit) const;

  Parameters parameters_;
  Capacity capacity_;
  std::vector<Node> nodes_;        // measurements, then groups
  std::vector<std::size_t> by_x_;  // measurements by x
  std::vector<double> x_;          // their x
  std::vector<char> enters_;       // 1: in the gate of an object, 2: may be new
  std::vector<WorkItem> items_;
  std::vector<std::size_t> item_of_;  // by root
  std::vector<std::size_t> groups_, measurements_;
};

}  // namespace boresight::tracking::pmbm
