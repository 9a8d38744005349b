#include "services/alignment_estimator/core/plate/fit.hpp"

namespace boresight::alignment::plate {

std::string_view name_of(Failure failure) {
  switch (failure) {
    case Failure::kNone:
      return "NONE";
    case Failure::kAborted:
      return "ABORTED";
    case Failure::kPositioningTimeout:
      return "POSITIONING_TIMEOUT";
    case Failure::kNoPlateSeen:
      return "NO_PLATE_SEEN";
    case Failure::kMeasuringTimeout:
      return "MEASURING_TIMEOUT";
    case Failure::kDecisionTimeout:
      return "DECISION_TIMEOUT";
    case Failure::kTooFewTilts:
      return "TOO_FEW_TILTS";
    case Failure::kTooFewScans:
      return "TOO_FEW_SCANS";
    case Failure::kTiltsNotMonotonic:
      return "TILTS_NOT_MONOTONIC";
    case Failure::kNotFinite:
      return "NOT_FINITE";
    case Failure::kNoMaximum:
      return "NO_MAXIMUM";
    case Failure::kMaximumOutsideTilts:
      return "MAXIMUM_OUTSIDE_TILTS";
    case Failure::kAmplitudeTooLow:
      return "AMPLITUDE_TOO_LOW";
  }
  return "?";
}

std::string_view explain(Failure failure) {
  switch (failure) {
    case Failure::kNone:
      return "the run succeeded";
    case Failure::kAborted:
      return "the station aborted the run";
    case Failure::kPositioningTimeout:
      return "the plate was not reported in place in time";
    case Failure::kNoPlateSeen:
      return "no detection of the plate in its window for too long";
    case Failure::kMeasuringTimeout:
      return "too few scans contained the plate in time";
    case Failure::kDecisionTimeout:
      return "the station did not go on after a tilt";
    case Failure::kTooFewTilts:
      return "too few tilts, or too few that agree with one another";
    case Failure::kTooFewScans:
      return "a tilt has fewer than 10 or more than 50 scans";
    case Failure::kTiltsNotMonotonic:
      return "the tilts neither increase nor decrease throughout";
    case Failure::kNotFinite:
      return "a measured value is not a number";
    case Failure::kNoMaximum:
      return "the amplitude has no maximum over the tilt";
    case Failure::kMaximumOutsideTilts:
      return "the amplitude's maximum lies beyond the measured tilts";
    case Failure::kAmplitudeTooLow:
      return "the amplitude at its maximum is below the limit: the bumper transmits too little";
  }
  return "?";
}

}  // namespace boresight::alignment::plate
