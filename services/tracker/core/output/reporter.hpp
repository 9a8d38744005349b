// From the filter's objects to a track list.
#pragma once

#include <span>

#include "interfaces/messages/track_list.hpp"
#include "services/tracker/core/filter.hpp"

namespace boresight::tracking {

class Reporter {
 public:
  virtual ~Reporter() = default;
  virtual void clear() = 0;
  /// The objects after a scan that came `elapsed_s` after the one before, likeliest first.
  virtual void take(std::span<const ObjectEstimate> objects, double elapsed_s) = 0;
  /// Writes the tracks, and their numbers.
  virtual void write(TrackList& out) const = 0;
};

}  // namespace boresight::tracking
