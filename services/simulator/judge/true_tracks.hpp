// The tracks of a tracker that knows everything of the objects that radars have detected.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "interfaces/messages/track_list.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::judge {

/// Knows an object from its first direct echo on, and until it is hidden (hidden.hpp).
class TrueTracks {
 public:
  /// Writes all of `out` but the header: the objects that are not hidden at `t_s`, with existence 1, their true state,
  /// and the age since they were known first. Times rise.
  void write(double t_s, const std::vector<Object>& objects, TrackList& out);
  /// Since when an object has been known without a break; negative if it is not known.
  [[nodiscard]] double age_s(std::uint32_t object, double t_s) const;

 private:
  std::map<std::uint32_t, double> known_since_s_;
};

}  // namespace boresight::judge
