// Quality of the tracks of a simulated drive through the whole chain, by the simulator's judge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "services/ghost_filter/core/method.hpp"
#include "services/simulator/judge/figure_list.hpp"

namespace boresight::closed_loop {

/// Largest distance of an object's centre from the ego vehicle that four corner radars shall cover.
inline constexpr double kFarthest_m = 60.0;
/// The alignment estimator starts without stored estimates here and needs more than 1 s to find a mounting error
/// of 2.5°. False tracks caused meanwhile are counted separately.
inline constexpr double kAligned_s = 1.5;

struct DriveOfFigures {
  std::string scenario;
  std::string profile;  ///< radar profile of all radars, with its weights of the ghost filter's evidence
  ghosts::MethodName method = ghosts::MethodName::kEvidence;
  std::uint64_t seed = 1;
  double duration_s = 40.0;
};

/// Names and definitions of the judge (config/schema/truth.md). In view are objects within kFarthest_m of which a radar
/// had a direct reflection lately (hidden.hpp); parked bodies are no objects.
struct Figures {
  judge::FigureList drive;                       ///< of the whole drive
  judge::FigureList before_aligned, afterwards;  ///< of the lists before and from kAligned_s on
  std::size_t ids = 0;                           ///< confirmed tracks of the whole drive

  /// Over all classes and ranges.
  [[nodiscard]] double of_objects(const std::string& name) const {
    return drive.value("tracks.all.all_ranges." + name);
  }
};

[[nodiscard]] Figures judge_drive(const DriveOfFigures& of);

}  // namespace boresight::closed_loop
