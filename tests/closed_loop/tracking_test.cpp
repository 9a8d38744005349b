// What the chain makes of a simulated drive: which vehicles it finds, how soon, how well, and what it makes up.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "tests/closed_loop/chain.hpp"
#include "tests/closed_loop/objects.hpp"

namespace boresight::closed_loop {
namespace {

constexpr double kFarthest_m = 60.0;  // of the vehicle's centre from the ego vehicle: what four corner radars shall see
constexpr double kMatch_m = 4.0;
/// The alignment estimator, which here remembers nothing, takes over a second to find that a radar is 2.5° crooked;
/// what such a radar makes up meanwhile is counted apart.
constexpr double kAligned_s = 1.5;

struct Figures {
  double seconds = 0.0;
  std::size_t chances = 0, found = 0;      // object instants after the grace, and with a confirmed track
  std::size_t stays = 0, stays_found = 0;  // uninterrupted stays of over 3 s within reach
  double worst_delay_s = 0.0;
  double position_square = 0.0, velocity_square = 0.0;
  std::size_t false_ids = 0, false_instants = 0, instants = 0, ids = 0;
  std::size_t early_false_ids = 0, early_false_instants = 0;  // of tracks born before kAligned_s
  std::size_t switches = 0;
  [[nodiscard]] double share() const { return static_cast<double>(found) / static_cast<double>(chances); }
  [[nodiscard]] double position_rmse_m() const { return std::sqrt(position_square / static_cast<double>(found)); }
  [[nodiscard]] double velocity_rmse_mps() const { return std::sqrt(velocity_square / static_cast<double>(found)); }
  [[nodiscard]] double false_tracks() const {
    return static_cast<double>(false_instants) / static_cast<double>(instants);
  }
};

Figures judge(const std::string& scenario, std::uint64_t seed, double duration_s) {
  const VehicleConfig vehicle =
      config::read_vehicle_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/vehicle/demo.toml");
  simulator::Drive drive(simulator::scenario(scenario), vehicle, seed, duration_s);
  Chain chain(vehicle);
  Figures figures;
  figures.seconds = duration_s;
  struct Memory {
    double since_s = -1.0, found_s = -1.0;
    std::uint32_t track = 0;
  };
  std::map<std::size_t, Memory> memory;
  std::set<std::uint32_t> ids;
  struct Life {
    double born_s;
    std::size_t instants = 0, wrong = 0;  // of which without an object
  };
  std::map<std::uint32_t, Life> life;
  const auto end_stay = [&](Memory& m, double t_s) {
    if (m.since_s >= 0.0 && t_s - m.since_s > 3.0) {
      ++figures.stays;
      figures.stays_found += m.found_s >= 0.0 ? 1 : 0;
      if (m.found_s >= 0.0) figures.worst_delay_s = std::max(figures.worst_delay_s, m.found_s - m.since_s);
    }
    m = {};
  };
  while (const simulator::Event* event = drive.next()) {
    if (!chain.take(*event)) continue;
    const double t_s = event->t_s;
    const std::vector<Object> objects = objects_at(drive, t_s);
    ++figures.instants;
    const TrackList& tracks = *chain.tracks;
    for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
      const Track& track = tracks.tracks[k];
      ids.insert(track.tracking_id);
      const Eigen::Vector2d p(track.position_vehicle_m[0], track.position_vehicle_m[1]);
      // A long vehicle's track may lie at either of its ends.
      const bool real = std::any_of(objects.begin(), objects.end(),
                                    [&](const Object& o) { return (o.position_m - p).norm() < kMatch_m + 3.0; });
      Life& its = life.try_emplace(track.tracking_id, Life{t_s}).first->second;
      ++its.instants;
      if (!real) {
        ++(its.born_s < kAligned_s ? figures.early_false_instants : figures.false_instants);
        ++its.wrong;
      }
    }
    for (const Object& object : objects) {
      Memory& m = memory[object.id];
      if (object.position_m.norm() > kFarthest_m) {
        end_stay(m, t_s);
        continue;
      }
      if (m.since_s < 0.0) m.since_s = t_s;
      const Track* best = nullptr;
      double best_m = kMatch_m;
      for (std::size_t k = 0; k < tracks.number_of_confirmed_tracks; ++k) {
        const Track& track = tracks.tracks[k];
        const double distance =
            (Eigen::Vector2d(track.position_vehicle_m[0], track.position_vehicle_m[1]) - object.position_m).norm();
        if (distance < best_m) {
          best_m = distance;
          best = &track;
        }
      }
      if (best != nullptr && m.found_s < 0.0) m.found_s = t_s;
      if (t_s - m.since_s < 1.5) continue;
      ++figures.chances;
      if (best == nullptr) continue;
      ++figures.found;
      figures.position_square += best_m * best_m;
      figures.velocity_square +=
          (Eigen::Vector2d(best->velocity_over_ground_mps[0], best->velocity_over_ground_mps[1]) - object.velocity_mps)
              .squaredNorm();
      if (m.track != 0 && m.track != best->tracking_id) ++figures.switches;
      m.track = best->tracking_id;
    }
  }
  for (auto& [index, m] : memory) end_stay(m, duration_s);
  figures.ids = ids.size();
  for (const auto& [id, its] : life) {
    if (2 * its.wrong > its.instants) ++(its.born_s < kAligned_s ? figures.early_false_ids : figures.false_ids);
  }
  std::printf(
      "%s, seed %llu: %zu of %zu stays of over 3 s found, at the latest after %.2f s; tracked %.1f %% of the time; "
      "position %.2f m, velocity %.2f m/s rms; %zu ids, %zu false, %.3f false at a time; %zu false before radars are "
      "aligned; %zu switches\n",
      scenario.c_str(), static_cast<unsigned long long>(seed), figures.stays_found, figures.stays,
      figures.worst_delay_s, 100.0 * figures.share(), figures.position_rmse_m(), figures.velocity_rmse_mps(),
      figures.ids, figures.false_ids, figures.false_tracks(), figures.early_false_ids, figures.switches);
  return figures;
}

class Tracking : public testing::TestWithParam<const char*> {};

TEST_P(Tracking, FindsEveryVehicleSoonAndMakesUpLittle) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Figures figures = judge(GetParam(), seed, 40.0);
    EXPECT_EQ(figures.stays_found, figures.stays);
    EXPECT_GT(figures.stays, 0u);
    EXPECT_LT(figures.worst_delay_s, 1.5);
    // The rest of the time they are hidden by others, or cross the line of sight and look stationary.
    EXPECT_GT(figures.share(), 0.85);
    EXPECT_LT(figures.position_rmse_m(), 1.6);
    EXPECT_LT(figures.velocity_rmse_mps(), 2.5);
    EXPECT_LT(figures.false_tracks(), 0.05);
    EXPECT_LE(figures.false_ids, 2u);
    EXPECT_LE(figures.early_false_ids, 2u);
    EXPECT_LT(static_cast<double>(figures.early_false_instants), 0.05 * static_cast<double>(figures.instants));
    EXPECT_LE(figures.ids, 4 * figures.stays);
    EXPECT_LE(figures.switches, 2 * figures.stays);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, Tracking, testing::Values("demo_drive", "aligned_drive", "straight_rail"));

}  // namespace
}  // namespace boresight::closed_loop
