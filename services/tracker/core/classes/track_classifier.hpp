// Class probabilities of tracks by the forest.
#pragma once

#include <cstddef>

#include "services/tracker/core/classes/class_evidence.hpp"
#include "services/tracker/core/classes/decision_forest.hpp"
#include "services/tracker/core/classes/radar_levels.hpp"

namespace boresight::tracking {

/// The caller keeps one ClassEvidence for each track, adds each scan in which the track could be detected, and asks
/// for the probabilities when it reports. Strengths of the points are those of `levels`.
///
///     classifier.levels().learn(scan, radar);                     // once a scan
///     point.strength_db = classifier.levels().strength_db(…);     // of each detection
///     classifier.add(track.evidence, observation);                // of each track
///     track.probability = classifier.probabilities(track.evidence);
class TrackClassifier {
 public:
  /// Throws std::invalid_argument as DecisionForest does.
  TrackClassifier(const ObjectForest& forest, std::size_t radars);
  /// The same with other shares of the classes than those in training: p_k is weighted by share_k over that in
  /// training.
  TrackClassifier(const ObjectForest& forest, std::size_t radars, const ClassProbabilities& prior_share);

  void add(ClassEvidence& evidence, const TrackObservation& scan) const { evidence.add(scan, parameters_); }
  /// By extended_object::RoadUserClass; they sum to 1. The prior's without any detection.
  [[nodiscard]] ClassProbabilities probabilities(const ClassEvidence& evidence) const;
  [[nodiscard]] RadarLevels& levels() { return levels_; }

 private:
  DecisionForest forest_;
  ClassEvidenceParameters parameters_;
  RadarLevels levels_;
  ClassProbabilities prior_share_, prior_shift_{};
};

}  // namespace boresight::tracking
