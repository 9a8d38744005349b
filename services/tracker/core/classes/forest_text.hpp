// The text of config/services/object_forest.csv. One fact a line, in this order; '#' begins a comment:
//
//     version,1
//     classes,pedestrian,two_wheeler,car,van,truck
//     prior,SHARE,…                 of the classes in training, in thousandths
//     number,KEY,VALUE              each of forest_numbers()
//     feature,NAME,VALUE            each ClassFeature, and its value where it is not known
//     tree                          then its nodes, the side of smaller values first:
//     split,FEATURE,THRESHOLD       index of the feature from 0; values up to the threshold come first
//     leaf,SHARE,…                  probabilities of the classes, in thousandths
//     end
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "services/tracker/core/classes/object_forest.hpp"

namespace boresight::tracking {

/// A line of the table that is wrong.
class ForestTextError : public std::runtime_error {
 public:
  ForestTextError(std::size_t at_line, const std::string& problem) : std::runtime_error(problem), line(at_line) {}
  std::size_t line;  ///< from 1
};

/// Throws ForestTextError for the first line that is wrong. What it returns can be evaluated.
[[nodiscard]] ObjectForest parse_forest(std::string_view text);

}  // namespace boresight::tracking
