// Extended objects by step: the truth of a simulated scenario, or the estimates of a tracker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "interfaces/messages/track_list.hpp"
#include "services/simulator/judge/gospa.hpp"

namespace boresight::track {

struct ExtendedObject {
  judge::Ellipse ellipse;
  Eigen::Vector2d velocity_mps{Eigen::Vector2d::Zero()};
  std::uint32_t id = 0;  ///< 0: not known

  friend bool operator==(const ExtendedObject& a, const ExtendedObject& b) {
    return a.ellipse.centre_m == b.ellipse.centre_m && a.ellipse.extent_m2 == b.ellipse.extent_m2 &&
           a.velocity_mps == b.velocity_mps && a.id == b.id;
  }
};

/// Objects of step k at index k − 1.
using ObjectsByStep = std::vector<std::vector<ExtendedObject>>;

/// Reads the columns step, cx, cy, vx, vy, X11, X12, X22 and, optionally, id, in any order: of a truth or of estimates.
/// The result ends with the last step of the table. Throws score::InputError, which names file, line, column and the
/// allowed values; an extent must be positive definite.
[[nodiscard]] ObjectsByStep read_objects(const std::filesystem::path& file);

/// A table that read_objects() reads back to the same numbers.
[[nodiscard]] std::string estimates_csv(const ObjectsByStep& objects);

/// The tracks with an existence probability above one half. Their boxes enclose the ellipses of the extents.
[[nodiscard]] std::vector<ExtendedObject> estimates_of(const TrackList& tracks);

/// Sum over all steps.
[[nodiscard]] std::size_t number_of_objects(const ObjectsByStep& objects);

}  // namespace boresight::track
