// Collision warnings of track lists, against the collisions that threaten in the simulated world.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "interfaces/messages/track_list.hpp"
#include "services/simulator/drive.hpp"

namespace boresight::bench::surroundings {

/// Time until the vehicle's box meets a body's, if the vehicle follows the road and all keep their speeds; none within
/// kHorizon_s.
inline constexpr double kHorizon_s = 6.0;
[[nodiscard]] std::optional<double> time_to_contact_s(const simulator::Drive& drive, double t_s);

/// A warning: from its first list on, until none has been given for kPause_s.
struct Warning {
  double begin_s = 0.0;
  double end_s = 0.0;
  std::optional<double> contact_s;  ///< true time to contact at its begin
  PathObject object{};              ///< the most urgent one then
};
inline constexpr double kPause_s = 1.0;

class WarningJudge {
 public:
  void add(const TrackList& list, const simulator::Drive& drive, double t_s);
  [[nodiscard]] const std::vector<Warning>& warnings() const { return warnings_; }
  /// The shortest true time to contact of the drive.
  [[nodiscard]] std::optional<double> shortest_s() const { return shortest_s_; }

 private:
  std::vector<Warning> warnings_;
  std::optional<double> shortest_s_;
  double checked_s_ = -1.0;
};

}  // namespace boresight::bench::surroundings
