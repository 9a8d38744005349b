// Objects that are hidden from all radars.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "services/simulator/detection_truth.hpp"
#include "services/simulator/judge/object.hpp"

namespace boresight::judge {

/// An object is hidden if no radar has had a direct reflection of it for longer than this. No tracker can know of it.
inline constexpr double kHidden_s = 0.5;

/// Time of the last direct reflection of each object, whatever its classification.
class LastSeen {
 public:
  /// Takes the truth of a scan and marks the objects that are hidden at its time.
  void mark(double t_s, const std::vector<simulator::DetectionTruth>& truth, std::vector<Object>& objects) {
    for (const simulator::DetectionTruth& is : truth) {
      if (is.provenance == Provenance::kMoving || is.provenance == Provenance::kStationary) last_s_[is.object_id] = t_s;
    }
    for (Object& object : objects) {
      const auto last = last_s_.find(object.id);
      object.is_hidden = last == last_s_.end() || t_s - last->second > kHidden_s;
    }
  }

 private:
  std::map<std::uint32_t, double> last_s_;
};

}  // namespace boresight::judge
