// What is judged: a track list beside the true objects at its time.
#pragma once

#include <vector>

#include "services/simulator/judge/scored_scene.hpp"

namespace boresight::bench::tracking {

struct ListedTrack : judge::ScoredTrack {
  double score = 0.0;  ///< the larger, the surer that there is an object
};

struct Scene {
  double t_s = 0.0;
  std::vector<ListedTrack> tracks;
  std::vector<judge::TrueObject> objects;
};

}  // namespace boresight::bench::tracking
