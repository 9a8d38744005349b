// The shipped file: every key, with the default's value.
#include "services/tracker/config.hpp"

#include <filesystem>
#include <fstream>
#include <numeric>

#include <gtest/gtest.h>

#include "services/tracker/core/make_tracker.hpp"
#include "tests/unit/shipped_config.hpp"

namespace boresight::tracking {
namespace {

const std::filesystem::path kShipped = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/tracker.toml";

std::vector<double> numbers(const Config& config) {
  const DetectionParameters& d = config.model.detection;
  const BirthParameters& b = config.model.birth;
  const ClutterParameters& c = config.model.clutter;
  const SourceParameters& s = config.model.source;
  const MotionParameters& k = config.model.motion;
  const pmbm::Parameters& p = config.pmbm;
  const pmbm::Capacity& m = config.capacity;
  const classical::Parameters& a = config.classical;
  std::vector<double> all = {d.detection_probability,
                             d.view_edge_rad,
                             d.range_edge_m,
                             d.stationary_sigma,
                             d.motion_std_mps,
                             d.body_range_rate_std_mps,
                             d.spread,
                             d.held_factor,
                             d.count,
                             d.count_shape,
                             d.count_range_m,
                             d.count_power,
                             d.count_least,
                             d.count_most,
                             b.slow.density_per_m2,
                             b.slow.speed_std_mps,
                             b.any.density_per_m2,
                             b.any.speed_std_mps,
                             b.traffic.density_per_m2,
                             b.traffic.speed_std_mps,
                             b.half_length_m,
                             b.place_std_m,
                             b.extent_dof,
                             b.gap_along_m,
                             b.gap_across_m,
                             b.headway_s,
                             b.close_share,
                             b.person_m,
                             b.neighbour_density_per_m2,
                             b.company_density_per_m2,
                             b.neighbour_speed_std_mps,
                             b.part_odds,
                             b.same_speed_chi2,
                             b.link_distance_m,
                             b.link_range_rate_mps,
                             c.memory_s,
                             c.table_scans,
                             c.least_range_rate_mps,
                             c.with_ego_factor,
                             c.pace_mps,
                             c.pace_over_ground_mps,
                             c.pace_cell_m,
                             c.origin_offset,
                             c.origin_weight,
                             c.origin_limit,
                             c.level_memory_s,
                             s.share,
                             s.life_s,
                             s.more,
                             s.lasting_share,
                             s.other_radar,
                             s.side_lobes,
                             s.parent_existence,
                             s.side_lobe_range_std_m,
                             s.side_lobe_range_rate_std_mps,
                             s.side_lobe_nearest_m,
                             s.side_lobe_chi2,
                             s.side_lobe_least_deviations,
                             s.wander_m,
                             s.ambiguity_share,
                             s.ambiguity_width_mps,
                             s.wide_chi2,
                             s.wide_prior,
                             s.main_lobe_rad,
                             s.side_lobe_birth,
                             s.side_lobe_shape,
                             s.side_lobe_strength_db,
                             s.side_lobe_strength_std_db,
                             s.object_strength_std_db,
                             s.strength_std_db,
                             s.strength_memory_s,
                             k.acceleration_density,
                             k.rate_memory_s,
                             k.rate_min_shape,
                             k.extent_memory_s,
                             k.extent_min_dof,
                             k.extent_min_m2,
                             config.model.object_life_s,
                             config.model.longest_gap_s,
                             config.model.latest_scan_s,
                             p.gate_chi2,
                             p.prune_weight,
                             p.candidate_log,
                             p.merge_distance,
                             p.join_existence,
                             p.min_existence,
                             p.cell_gate_chi2,
                             p.search_log,
                             p.min_detection_probability,
                             p.min_share,
                             static_cast<double>(p.sharing_passes),
                             p.first_cell_links,
                             p.report_existence,
                             static_cast<double>(p.work_budget),
                             config.phd.gate_chi2,
                             config.phd.prune_weight,
                             config.phd.merge_distance,
                             config.phd.min_detection_probability,
                             config.phd.min_share,
                             config.phd.least_entropy,
                             config.phd.least_cell,
                             config.phd.object_probability,
                             config.phd.report_existence,
                             static_cast<double>(config.phd.work_budget),
                             a.cluster.radius_m,
                             a.cluster.range_rate_gap_mps,
                             a.cluster.least_weight,
                             a.gate.place_chi2,
                             a.gate.range_rate_chi2,
                             static_cast<double>(a.start.points),
                             a.start.strength_db,
                             a.start.existence,
                             a.life.least_detection_probability,
                             a.life.least_existence,
                             a.motion.first_acceleration_std_mps2,
                             a.heading.history_s,
                             a.heading.known_std_rad,
                             static_cast<double>(a.heading.doppler.least_points),
                             a.heading.doppler.least_speed_mps,
                             a.heading.doppler.interval_rad,
                             a.heading.doppler.outlier_chi2,
                             static_cast<double>(a.heading.shape.least_points),
                             a.heading.shape.face_std_m,
                             a.heading.shape.nearest_m,
                             a.join_existence,
                             a.report_existence,
                             config.surroundings.stationary.memory_s,
                             config.surroundings.stationary.least_probability,
                             config.surroundings.stationary.behind_m,
                             config.surroundings.stationary.ahead_m,
                             config.surroundings.stationary.aside_m,
                             config.surroundings.stationary.lowest_m,
                             config.surroundings.stationary.highest_m,
                             config.surroundings.stationary.mounting_std_rad,
                             static_cast<double>(config.surroundings.stationary.scans_per_look),
                             config.surroundings.road_edge.gate_sigma,
                             config.surroundings.road_edge.ahead_m,
                             config.surroundings.road_edge.band_half_width_m,
                             config.surroundings.road_edge.cell_m,
                             config.surroundings.road_edge.contrast_probability,
                             config.surroundings.road_edge.cell_memory_s,
                             config.surroundings.road_edge.least_cell_detections,
                             config.surroundings.road_edge.prior_log_odds,
                             config.surroundings.road_edge.start_log_odds,
                             config.surroundings.road_edge.end_log_odds,
                             config.surroundings.road_edge.slope_step,
                             config.surroundings.road_edge.curvature_step_per_m,
                             config.surroundings.road_edge.least_distance_m,
                             config.surroundings.road_edge.separation_m,
                             config.surroundings.road_edge.longest_gap_m,
                             config.surroundings.road_edge.longest_coast_s,
                             config.surroundings.road_edge.scatter_m,
                             config.surroundings.road_edge.scatter_memory_s,
                             config.surroundings.road_edge.least_weight,
                             config.surroundings.road_edge.repeat_factor,
                             config.surroundings.road_edge.offset_density_m2pm,
                             config.surroundings.road_edge.slope_density_pm,
                             config.surroundings.road_edge.curvature_density_pm3,
                             config.surroundings.road_edge.curvature_rate_std_pm2,
                             config.surroundings.road_edge.report_existence,
                             config.surroundings.road_edge.course_existence,
                             config.surroundings.road_edge.course_beyond_m,
                             config.surroundings.obstacle.corridor_m,
                             config.surroundings.obstacle.cluster_radius_m,
                             config.surroundings.obstacle.least_detections,
                             config.surroundings.obstacle.gate_m,
                             config.surroundings.obstacle.count,
                             config.surroundings.obstacle.count_range_m,
                             config.surroundings.obstacle.count_power,
                             config.surroundings.obstacle.background_count,
                             config.surroundings.obstacle.background_factor,
                             config.surroundings.obstacle.background_memory_s,
                             config.surroundings.obstacle.excess_db,
                             config.surroundings.obstacle.excess_std_db,
                             config.surroundings.obstacle.level_memory_s,
                             config.surroundings.obstacle.level_range_m,
                             config.surroundings.obstacle.most_of_scan,
                             config.surroundings.obstacle.evidence_share,
                             config.surroundings.obstacle.prior_log_odds,
                             config.surroundings.obstacle.most_log_odds,
                             config.surroundings.obstacle.end_log_odds,
                             config.surroundings.obstacle.position_density_m2ps,
                             config.surroundings.obstacle.centre_std_m,
                             config.surroundings.obstacle.extent_memory_s,
                             config.surroundings.obstacle.life_s,
                             static_cast<double>(config.surroundings.obstacle.looks_per_search),
                             config.surroundings.collision.front_m,
                             config.surroundings.collision.width_m,
                             config.surroundings.collision.lateral_jerk_density_m2ps5,
                             config.surroundings.collision.road_share,
                             config.surroundings.collision.lane_std_m,
                             config.surroundings.collision.least_speed_mps,
                             config.surroundings.collision.horizon_s,
                             config.surroundings.collision.warning_time_s,
                             config.surroundings.collision.warning_probability,
                             config.surroundings.collision.oncoming_probability,
                             config.surroundings.collision.oncoming_speed_mps,
                             config.surroundings.collision.warning_deceleration_mps2,
                             config.surroundings.collision.warning_lateral_mps2,
                             config.surroundings.collision.hold_s,
                             config.surroundings.collision.obstacle_hold_s,
                             config.surroundings.collision.least_existence,
                             config.surroundings.collision.report_probability,
                             config.model.box.evidence_share,
                             config.model.box.stray_share,
                             config.model.box.stray_m,
                             config.model.box.forget_s,
                             config.model.box.side_slip_mps,
                             config.model.box.turn.lateral_acceleration_mps2,
                             config.model.box.turn.radius_m,
                             config.model.box.turn.time_s,
                             config.model.box.road.parallel_share,
                             config.model.box.road.parallel_std_rad,
                             config.model.box.road.prior_s,
                             config.model.box.road.memory_s,
                             config.model.box.known_heading_rad,
                             config.model.box.contradiction_chi2,
                             config.model.box.sure_speed_sigma,
                             config.model.box.least_length_share,
                             config.model.box.least_doubt,
                             config.model.box.least_probability,
                             config.report.confirmed_existence,
                             config.report.hold_log_odds_per_s,
                             config.report.least_existence,
                             config.report.stopped_speed_mps,
                             config.report.flags.likely,
                             config.report.flags.merged_share,
                             config.report.flags.recent_scan_s};
  for (const std::size_t capacity :
       {m.measurements, m.objects, m.local_hypotheses, m.group_objects, m.group_measurements, m.rows, m.candidates}) {
    all.push_back(static_cast<double>(capacity));
  }
  return all;
}

Config parsed(const std::string& text) {
  return read_config(config::Reader::parse(text, "x.toml"));
}

TEST(TrackerConfig, ShippedFileHasTheDefaults) {
  const Config read = read_config(config::Reader::open(kShipped));
  EXPECT_EQ(read.tracker, Config{}.tracker);
  EXPECT_EQ(numbers(read), numbers(Config{}));
}

TEST(TrackerConfig, EveryKeyIsReadIntoItsPlace) {
  const auto read = [](const std::string& text) { return numbers(parsed(text)); };
  // The largest number of measurements is the shipped one: one more is refused.
  std::vector<double> expected = numbers(Config{});
  EXPECT_EQ(test::expect_each_number_is_read(kShipped, read, "capacity"), expected.size() - 7);
  const Config config = parsed(
      "[capacity]\nmeasurements = 105\nobjects = 107\nlocal_hypotheses = 102\ngroup_objects = 103\n"
      "group_measurements = 104\nrows = 5\ncandidates = 106\n");
  const pmbm::Capacity& c = config.capacity;
  EXPECT_EQ(std::vector({c.measurements, c.objects, c.local_hypotheses, c.group_objects, c.group_measurements, c.rows,
                         c.candidates}),
            (std::vector<std::size_t>{105, 107, 102, 103, 104, 5, 106}));
}

TEST(TrackerConfig, RulesOfTheClassicalChainAreReadForEachClass) {
  const auto rules = [](const Config& config) {
    const classical::Parameters& a = config.classical;
    std::vector<double> all;
    for (const auto* values :
         {&a.life.confirm_hits, &a.life.confirm_looks, &a.life.delete_misses, &a.life.delete_looks}) {
      all.insert(all.end(), values->begin(), values->end());
    }
    for (const auto* values : {&a.life.coast_s, &a.motion.jerk_density_m2ps5, &a.motion.acceleration_time_s}) {
      all.insert(all.end(), values->begin(), values->end());
    }
    return all;
  };
  EXPECT_EQ(rules(read_config(config::Reader::open(kShipped))), rules(Config{}));
  const Config config = parsed(
      "[classical]\nfilter = \"srukf\"\nshape_criterion = \"area\"\nconfirm_hits = [1, 2, 3, 4, 5]\n"
      "confirm_looks = [6, 7, 8, 9, 10]\ndelete_misses = [11, 12, 13, 14, 15]\ndelete_looks = [16, 17, 18, 19, 20]\n"
      "coast_s = [21, 22, 23, 24, 25]\njerk_density_m2ps5 = [26, 27, 28, 29, 30]\n"
      "acceleration_time_s = [31, 32, 33, 34, 35]\n");
  std::vector<double> expected(35);
  std::iota(expected.begin(), expected.end(), 1.0);
  EXPECT_EQ(rules(config), expected);
  EXPECT_EQ(config.classical.filter, filters::FilterKind::kSquareRootUnscented);
  EXPECT_EQ(config.classical.heading.shape.criterion, classical::ShapeCriterion::kArea);
}

TEST(TrackerConfig, RulesOfTheClassicalChainThatCannotBeMetAreRefused) {
  EXPECT_THROW(static_cast<void>(parsed("[classical]\nconfirm_hits = [3, 3, 6, 3, 3]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[classical]\ndelete_looks = [32, 31, 32, 32, 32]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[classical]\nconfirm_hits = [3, 3, 2.5, 3, 3]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[classical]\nconfirm_hits = [3, 3, 3, 3]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[classical]\nfilter = \"alpha_beta\"")), config::Error);
}

TEST(TrackerConfig, ClutterTableIsRead) {
  const auto tables = [](const Config& config) {
    const ClutterParameters& c = config.model.clutter;
    std::vector<double> all(c.table_range_edges_m.begin(), c.table_range_edges_m.end());
    all.insert(all.end(), c.table_by_range.begin(), c.table_by_range.end());
    all.insert(all.end(), c.table_rate_edges_mps.begin(), c.table_rate_edges_mps.end());
    all.insert(all.end(), c.table_by_rate.begin(), c.table_by_rate.end());
    return all;
  };
  EXPECT_EQ(tables(read_config(config::Reader::open(kShipped))), tables(Config{}));
  const Config config = parsed(
      "[clutter]\ntable_range_edges_m = [1, 2, 3, 4]\ntable_by_range = [0.5, 0.6, 0.7, 0.8, 0.9]\n"
      "table_rate_edges_mps = [11, 12, 13, 14, 15, 16]\ntable_by_rate = [21, 22, 23, 24, 25, 26]\n");
  EXPECT_EQ(tables(config),
            (std::vector<double>{1, 2, 3, 4, 0.5, 0.6, 0.7, 0.8, 0.9, 11, 12, 13, 14, 15, 16, 21, 22, 23, 24, 25, 26}));
}

TEST(TrackerConfig, ClutterTableMustHaveEdgesThatIncrease) {
  EXPECT_THROW(static_cast<void>(parsed("[clutter]\ntable_range_edges_m = [10, 25, 25, 75]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[clutter]\ntable_range_edges_m = [10, 25, 75]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[clutter]\ntable_rate_edges_mps = [1, 2, 5, 20, 10, 60]")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[clutter]\nleast_range_rate_mps = 1.0")), config::Error);
}

TEST(TrackerConfig, KeysThatContradictEachOtherAreRefused) {
  EXPECT_THROW(static_cast<void>(parsed("[capacity]\nobjects = 100\ngroup_objects = 101")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[capacity]\nmeasurements = 100\ngroup_measurements = 101")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[report]\nconfirmed_existence = 0.04\nleast_existence = 0.05")),
               config::Error);
  EXPECT_NO_THROW(static_cast<void>(parsed("[report]\nconfirmed_existence = 0.06\nleast_existence = 0.05")));
}

TEST(TrackerConfig, ClassesAndTheirForestComeFromTheirOwnFiles) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tracker_config";
  std::filesystem::create_directories(folder / "services");
  std::ofstream(folder / "services/tracker.toml") << "[report]\nstopped_speed_mps = 0.7\n";
  std::ofstream(folder / "services/object_classes.toml") << "[size]\nlength_mean_m = [1, 2, 4, 6, 12]\n";
  const std::filesystem::path forest = folder / "services/object_forest.csv";
  std::filesystem::copy_file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/services/object_forest.csv", forest,
                             std::filesystem::copy_options::overwrite_existing);
  runtime::Configuration files;
  files.directory = folder;
  const Config config = read_config(files);
  EXPECT_FALSE(config.forest.table.trees.empty());
  EXPECT_EQ(config.report.stopped_speed_mps, 0.7);
  EXPECT_EQ(config.model.classes.back().size.length_mean_m, 12.0);
  EXPECT_EQ(config.model.classes.back().size.width_mean_m, Config{}.model.classes.back().size.width_mean_m);
  std::filesystem::remove(folder / "services/object_classes.toml");
  EXPECT_THROW(static_cast<void>(read_config(files)), config::Error);
  std::ofstream(folder / "services/object_classes.toml") << "[size]\n";
  EXPECT_NO_THROW(static_cast<void>(read_config(files)));
  std::filesystem::remove(forest);
  EXPECT_THROW(static_cast<void>(read_config(files)), config::Error);
  std::filesystem::remove_all(folder);
}

TEST(TrackerConfig, UnknownTrackerOrKeyIsRefused) {
  EXPECT_THROW(static_cast<void>(parsed("tracker = \"rules\"")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[life]\nconfirm_hits = 4")), config::Error);
  EXPECT_THROW(static_cast<void>(parsed("[report]\nconfirmed = 0.5")), config::Error);
}

TEST(TrackerConfig, EveryNamedTrackerCanBeMadeAndTheFirstIsTheDefault) {
  EXPECT_EQ(tracker_names().front(), Config{}.tracker);
  VehicleConfig vehicle;
  vehicle.radars.emplace_back().id = 1;
  for (const std::string& name : tracker_names()) EXPECT_NE(make_tracker(name, vehicle, {}), nullptr) << name;
  EXPECT_THROW(static_cast<void>(make_tracker("rules", vehicle, {})), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::tracking
