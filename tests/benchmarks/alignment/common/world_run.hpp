// The product's estimator on one drive of the world simulator, whose radars have a profile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/simulator/car/real_car.hpp"
#include "services/simulator/judge/alignment_judge.hpp"
#include "services/simulator/judge/figure_list.hpp"

namespace boresight::bench {

struct WorldDrive {
  std::string scenario;  ///< or its file
  std::string profile;   ///< radar profile of all radars, or its file
  std::uint64_t seed = 1;
  double duration_s = 45.0;            ///< at most as long as the scenario states
  simulator::car::RealCar real_car{};  ///< instead of the effects that the scenario states
};

struct WorldRun {
  judge::FigureList figures;  ///< of judge::AlignmentJudge
  std::size_t radars = 0;     ///< ids 1 … radars
  double duration_s = 0.0;
  std::vector<judge::MountingTruth> truth;  ///< at the last estimate, by radar, as an estimator in the car can know it
};

/// Mountings and k_v are wrong by amounts of the seed: draw_mounting_error(), draw_speed_scale(). Axes that the
/// estimator reports as not observable have no NEES. With a real car the true speed scale of a radar includes its own
/// scale of range rates, and the true mounting the pitch by load from its time on.
[[nodiscard]] WorldRun run_world_drive(const WorldDrive& of);

}  // namespace boresight::bench
