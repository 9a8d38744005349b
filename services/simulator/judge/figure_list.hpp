// Figures of merit by name, in the order in which they were added: what a judge returns and a report shows.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/common/estimation/unknown.hpp"

namespace boresight::judge {

struct Figure {
  std::string name;       ///< words joined by dots: "tracks.car.0_30m.tracked_share"
  double value;           ///< NaN: there is no data for it
  std::string_view unit;  ///< "" for counts and shares
};

class FigureList {
 public:
  /// A name that exists already gets the new value. `unit` must be a literal.
  void add(std::string name, double value, std::string_view unit = {}) {
    const auto [place, is_new] = index_.try_emplace(name, figures_.size());
    if (is_new) {
      figures_.push_back({std::move(name), value, unit});
    } else {
      figures_[place->second].value = value;
    }
  }
  [[nodiscard]] const Figure* find(std::string_view name) const {
    const auto place = index_.find(name);
    return place == index_.end() ? nullptr : &figures_[place->second];
  }
  /// NaN if there is no such figure.
  [[nodiscard]] double value(std::string_view name) const {
    const Figure* const figure = find(name);
    return figure == nullptr ? kNaN : figure->value;
  }
  [[nodiscard]] const std::vector<Figure>& all() const { return figures_; }

 private:
  std::vector<Figure> figures_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

/// part / whole; NaN if the whole is 0.
[[nodiscard]] inline double share_of(double part, double whole) {
  return whole > 0.0 ? part / whole : kNaN;
}

}  // namespace boresight::judge
