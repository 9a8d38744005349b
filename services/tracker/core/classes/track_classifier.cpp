#include "services/tracker/core/classes/track_classifier.hpp"

#include <numeric>

namespace boresight::tracking {

TrackClassifier::TrackClassifier(const ObjectForest& forest, std::size_t radars)
    : TrackClassifier(forest, radars, forest.table.prior_share) {}

TrackClassifier::TrackClassifier(const ObjectForest& forest, std::size_t radars, const ClassProbabilities& prior_share)
    : forest_(forest.table), parameters_(forest.evidence), levels_(radars, forest.levels), prior_share_(prior_share) {
  for (std::size_t k = 0; k < prior_shift_.size(); ++k) {
    const double in_training = forest.table.prior_share[k];
    prior_shift_[k] = in_training > 0.0 ? prior_share[k] / in_training : 0.0;
  }
}

ClassProbabilities TrackClassifier::probabilities(const ClassEvidence& evidence) const {
  if (evidence.detections() <= 0.0) return prior_share_;
  ClassProbabilities p = forest_.probabilities(evidence.features());
  for (std::size_t k = 0; k < p.size(); ++k) p[k] *= prior_shift_[k];
  const double sum = std::accumulate(p.begin(), p.end(), 0.0);
  if (!(sum > 0.0)) return prior_share_;
  for (double& share : p) share /= sum;
  return p;
}

}  // namespace boresight::tracking
