// Which objects no radar sees at present.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "tests/simulator/detection_truth.hpp"
#include "tests/simulator/judge/object.hpp"

namespace boresight::judge {

/// An object that no radar had a reflection of for so long is hidden, and no tracker can know of it.
inline constexpr double kHidden_s = 0.5;

/// When each object last had a reflection of its own, told right or not.
class LastSeen {
 public:
  /// Takes the truth of a scan and marks those of the objects that are hidden then.
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
