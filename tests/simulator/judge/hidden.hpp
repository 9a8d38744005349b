// Which objects no tracker can know of at present.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "tests/simulator/detection_truth.hpp"
#include "tests/simulator/judge/object.hpp"

namespace boresight::judge {

/// An object that no radar had a reflection of for so long is hidden, and no tracker can know of it.
inline constexpr double kHidden_s = 0.5;
/// Nor of one that was seen in fewer scans since it came into sight: of a flash no tracker makes an object. What it has
/// there is a neighbour's track.
inline constexpr unsigned kSeen_scans = 4;

/// When each object had reflections of its own, told right or not.
class LastSeen {
 public:
  /// Takes the truth of a scan and marks those of the objects that are hidden then.
  void mark(double t_s, const std::vector<simulator::DetectionTruth>& truth, std::vector<Object>& objects) {
    for (Object& object : objects) {
      Sight& sight = of_object_[object.id];
      const bool is_seen = std::any_of(truth.begin(), truth.end(), [&](const simulator::DetectionTruth& is) {
        return is.object_id == object.id &&
               (is.provenance == Provenance::kMoving || is.provenance == Provenance::kStationary);
      });
      if (t_s - sight.last_s > kHidden_s) sight.scans = 0;
      if (is_seen) {
        sight.last_s = t_s;
        ++sight.scans;
      }
      object.is_hidden = sight.scans < kSeen_scans;
    }
  }

 private:
  struct Sight {
    double last_s = -std::numeric_limits<double>::infinity();
    unsigned scans = 0;  ///< with it, since it was hidden
  };
  std::map<std::uint32_t, Sight> of_object_;
};

}  // namespace boresight::judge
