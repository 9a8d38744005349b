// The method `evidence` as a service uses it: corrected scans and tracks in, probabilities out.
#include "services/ghost_filter/core/evidence_filter.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/allocation_counter.hpp"
#include "services/ghost_filter/weights_file.hpp"

namespace boresight::ghosts {
namespace {

constexpr std::int64_t kCycle_ns = 50'000'000;

EvidenceConfig with_shipped_weights() {
  EvidenceConfig config;
  config.weights =
      read_weights(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/radar_profiles/series_77ghz.toml");
  return config;
}

/// A vehicle with a radar in front, and what it classifies.
class EvidenceDrive {
 public:
  explicit EvidenceDrive(const EvidenceConfig& config = with_shipped_weights())
      : filter(config),
        scan(std::make_unique<CorrectedScan>()),
        out(std::make_unique<ClassifiedScan>()),
        tracks(std::make_unique<TrackList>()) {
    std::memset(static_cast<void*>(out.get()), 0xCD, sizeof(ClassifiedScan));
    begin();
  }
  void begin() {
    *scan = {};
    scan->header.source_id = 1;
    scan->header.measurement_time_ns = now_ns;
    scan->fields = scan_field::kRcs;
    scan->geometry.sensor_position_vehicle_m = {3.6F, 0.0F, 0.5F};
    scan->geometry.ego_speed_mps = static_cast<float>(speed_mps);
    scan->geometry.sensor_velocity_vehicle_mps = {static_cast<float>(speed_mps), 0.0F, 0.0F};
    scan->geometry.ego_speed_std_mps = 0.05F;
    scan->geometry.ego_yaw_rate_std_radps = 0.002F;
  }
  /// Place in the vehicle frame, range rate over ground.
  std::size_t add(const Eigen::Vector2d& place_m, double range_rate_mps,
                  std::uint16_t flags = corrected_flag::kMoving) {
    const std::size_t i = scan->number_of_valid_detections++;
    const Eigen::Vector2d line = place_m - Eigen::Vector2d(3.6, 0.0);
    scan->x_vehicle_m[i] = static_cast<float>(place_m.x());
    scan->y_vehicle_m[i] = static_cast<float>(place_m.y());
    scan->range_m[i] = static_cast<float>(line.norm());
    scan->azimuth_vehicle_rad[i] = static_cast<float>(std::atan2(line.y(), line.x()));
    scan->range_rate_over_ground_mps[i] = static_cast<float>(range_rate_mps);
    scan->range_rate_mps[i] = static_cast<float>(range_rate_mps - speed_mps * line.x() / line.norm());
    scan->rcs_dbsm[i] = 5.0F;
    scan->range_std_m[i] = 0.15F;
    scan->azimuth_std_rad[i] = 0.006F;
    scan->range_rate_std_mps[i] = 0.1F;
    scan->detection_flags[i] = flags;
    return i;
  }
  void add_rail(double y_m) {
    for (double x = 5.0; x < 60.0; x += 1.5) add({x, y_m}, 0.0, corrected_flag::kStationary);
  }
  /// A car that is known since long.
  void know(const Eigen::Vector2d& centre_m, const Eigen::Vector2d& velocity_mps, float existence = 1.0F) {
    tracks->header.measurement_time_ns = now_ns;
    Track& t = tracks->tracks[tracks->number_of_tracks++] = {};
    t.status = TrackStatus::kConfirmed;
    t.object_class = ObjectClass::kCar;
    t.existence_probability = existence;
    t.age_s = 5.0F;
    t.length_m = 4.5F;
    t.width_m = 1.8F;
    t.position_vehicle_m = {static_cast<float>(centre_m.x()), static_cast<float>(centre_m.y()), 0.5F};
    t.velocity_over_ground_mps = {static_cast<float>(velocity_mps.x()), static_cast<float>(velocity_mps.y())};
    for (const std::size_t row : {0U, 1U, 2U, 3U}) t.covariance[row * kTrackStateSize + row] = 0.05F;
  }
  void classify() { filter.classify(*scan, *out); }
  void next_cycle() { now_ns += kCycle_ns; }
  [[nodiscard]] double real(std::size_t i) const {
    return static_cast<double>(out->probability(Provenance::kMoving, i));
  }

  EvidenceFilter filter;
  std::unique_ptr<CorrectedScan> scan;
  std::unique_ptr<ClassifiedScan> out;
  std::unique_ptr<TrackList> tracks;
  std::int64_t now_ns = 1'000'000'000'000;
  double speed_mps = 0.0;
};

/// A scan of a rail, of an object with company, and of lone false detections.
void fill_mixed(EvidenceDrive& d, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.2);
  std::uniform_real_distribution<double> x(5.0, 70.0), y(-20.0, 20.0), rate(-15.0, 15.0);
  d.begin();
  d.add_rail(8.0);
  for (int k = 0; k < 5; ++k) d.add({30.0 + noise(random), 1.0 + noise(random)}, 9.0 + 0.2 * noise(random));
  for (int k = 0; k < 30; ++k) d.add({x(random), y(random)}, rate(random));
}

void expect_same_output(const ClassifiedScan& a, const ClassifiedScan& b, std::size_t i) {
  EXPECT_EQ(a.provenance[i], b.provenance[i]) << i;
  EXPECT_EQ(a.moving_log_likelihood_ratio[i], b.moving_log_likelihood_ratio[i]) << i;
  for (const Provenance origin : kOrigins) EXPECT_EQ(a.probability(origin, i), b.probability(origin, i)) << i;
}

TEST(EvidenceFilter, StrengthChangesNothing) {
  for (const float shift_db : {10.0F, -10.0F}) {
    EvidenceDrive as_it_is, shifted;
    std::mt19937 random(1), again(1);
    for (int cycle = 0; cycle < 12; ++cycle) {
      fill_mixed(as_it_is, random);
      fill_mixed(shifted, again);
      for (std::size_t i = 0; i < shifted.scan->number_of_valid_detections; ++i) shifted.scan->rcs_dbsm[i] += shift_db;
      if (cycle == 3) {
        for (EvidenceDrive* d : {&as_it_is, &shifted}) {
          d->know({30.0, 1.0}, {9.0, 0.0});
          d->filter.add_tracks(*d->tracks);
        }
      }
      as_it_is.classify();
      shifted.classify();
      for (std::size_t i = 0; i < as_it_is.scan->number_of_valid_detections; ++i) {
        expect_same_output(*as_it_is.out, *shifted.out, i);
      }
      as_it_is.next_cycle();
      shifted.next_cycle();
    }
  }
}

TEST(EvidenceFilter, FlagsSayWhetherTracksAreKnown) {
  EvidenceDrive d;
  const auto flags = [&d] {
    d.begin();
    d.add({30.0, 1.0}, 9.0);
    d.classify();
    return d.out->flags;
  };
  EXPECT_EQ(flags(), pipeline_flag::kNoTracks);
  d.filter.add_tracks(*d.tracks);  // an empty list of long ago
  EXPECT_EQ(flags(), pipeline_flag::kTracksStale);
  d.tracks->header.measurement_time_ns = d.now_ns;
  d.filter.add_tracks(*d.tracks);
  EXPECT_EQ(flags(), 0U) << "an empty list is knowledge, too";
  d.now_ns += 500'000'000;
  EXPECT_EQ(flags(), 0U);
  d.now_ns += 1'000'000;
  EXPECT_EQ(flags(), pipeline_flag::kTracksStale);
  d.scan->flags = pipeline_flag::kNoElevation;
  d.classify();
  EXPECT_EQ(d.out->flags, pipeline_flag::kTracksStale | pipeline_flag::kNoElevation) << "the corrector's are kept";
}

TEST(EvidenceFilter, StaleTracksAreNotUsed) {
  EvidenceDrive without, stale;
  stale.know({30.0, 1.0}, {9.0, 0.0});
  stale.filter.add_tracks(*stale.tracks);
  for (EvidenceDrive* d : {&without, &stale}) {
    d->now_ns += 600'000'000;
    d->begin();
    d->add({30.0, 1.0}, 9.0);
    d->classify();
  }
  EXPECT_EQ(without.out->flags, pipeline_flag::kNoTracks);
  EXPECT_EQ(stale.out->flags, pipeline_flag::kTracksStale);
  expect_same_output(*without.out, *stale.out, 0);
}

TEST(EvidenceFilter, ADetectionThatIsNotFiniteIsUnclassifiedAndChangesNoOther) {
  const auto columns = [](CorrectedScan& scan) {
    return std::vector<DetectionColumn<float>*>{
        &scan.x_vehicle_m,         &scan.y_vehicle_m,     &scan.range_m,
        &scan.azimuth_vehicle_rad, &scan.range_rate_mps,  &scan.range_rate_over_ground_mps,
        &scan.range_std_m,         &scan.azimuth_std_rad, &scan.range_rate_std_mps};
  };
  for (std::size_t column = 0; column < 9; ++column) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      EvidenceDrive whole, broken;
      std::mt19937 random(2), again(2);
      for (int cycle = 0; cycle < 3; ++cycle) {
        fill_mixed(whole, random);
        fill_mixed(broken, again);
        for (const std::uint16_t flags : {corrected_flag::kMoving, corrected_flag::kStationary}) {
          const std::size_t i = broken.add({30.0, 1.0}, 9.0, flags);
          (*columns(*broken.scan)[column])[i] = value;
        }
        whole.classify();
        broken.classify();
        const std::size_t number = whole.scan->number_of_valid_detections;
        for (std::size_t i = 0; i < number; ++i) expect_same_output(*whole.out, *broken.out, i);
        for (std::size_t i = number; i < number + 2; ++i) {
          EXPECT_EQ(broken.out->provenance[i], Provenance::kUnknown);
          EXPECT_EQ(broken.out->moving_log_likelihood_ratio[i], 0.0F);
          for (const Provenance origin : kOrigins) EXPECT_EQ(broken.out->probability(origin, i), 0.0F);
        }
        whole.next_cycle();
        broken.next_cycle();
      }
    }
  }
}

TEST(EvidenceFilter, RejectedDetectionsAndThoseWithoutMotionAreUnclassified) {
  EvidenceDrive d;
  for (const std::uint16_t flag : {corrected_flag::kInvalid, corrected_flag::kOutsideRegion, corrected_flag::kWeak}) {
    d.add({30.0, 1.0}, 9.0, static_cast<std::uint16_t>(flag | corrected_flag::kMoving));
    d.add({30.0, 1.0}, 0.0, static_cast<std::uint16_t>(flag | corrected_flag::kStationary));
  }
  d.add({30.0, 1.0}, 9.0, 0);
  d.classify();
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(d.out->provenance[i], Provenance::kUnknown) << i;
  EXPECT_TRUE(d.filter.evidence().empty());
}

TEST(EvidenceFilter, StationaryDetectionsAreCertain) {
  EvidenceDrive d;
  d.add_rail(-6.0);
  d.add({20.0, 2.0}, 0.0, corrected_flag::kStationary | corrected_flag::kDoubted);
  d.classify();
  for (std::size_t i = 0; i < d.scan->number_of_valid_detections; ++i) {
    EXPECT_EQ(d.out->provenance[i], Provenance::kStationary);
    EXPECT_EQ(d.out->probability(Provenance::kStationary, i), 1.0F);
    EXPECT_EQ(d.out->moving_log_likelihood_ratio[i], -ClassifiedScan::kCertain);
  }
}

TEST(EvidenceFilter, ProbabilitiesSumToOneAndTheLabelFollowsThem) {
  EvidenceDrive d;
  std::mt19937 random(3);
  for (int cycle = 0; cycle < 20; ++cycle) {
    fill_mixed(d, random);
    if (cycle > 5) {
      d.tracks->number_of_tracks = 0;
      d.know({30.0, 1.0}, {9.0, 0.0});
      d.filter.add_tracks(*d.tracks);
    }
    d.classify();
    for (std::size_t i = 0; i < d.scan->number_of_valid_detections; ++i) {
      double sum = 0.0;
      for (const Provenance origin : kOrigins) {
        const auto p = static_cast<double>(d.out->probability(origin, i));
        EXPECT_GE(p, 0.0);
        sum += p;
      }
      EXPECT_NEAR(sum, 1.0, 1e-5);
      if ((d.scan->detection_flags[i] & corrected_flag::kMoving) == 0) continue;
      EXPECT_EQ(d.out->provenance[i] == Provenance::kMoving, d.real(i) >= 0.5) << d.real(i);
    }
    d.next_cycle();
  }
}

TEST(EvidenceFilter, EvidenceIsThatOfTheMovingDetectionsInTheirOrder) {
  EvidenceDrive d;
  d.add({20.0, 8.0}, 0.0, corrected_flag::kStationary);
  const std::size_t first = d.add({30.0, 1.0}, 9.0);
  d.add({35.0, 1.0}, 9.0, corrected_flag::kMoving | corrected_flag::kWeak);
  const std::size_t second = d.add({40.0, 1.0}, -9.0, corrected_flag::kMoving | corrected_flag::kDoubted);
  d.classify();
  ASSERT_EQ(d.filter.evidence().size(), 2U);
  EXPECT_EQ(d.filter.evidence()[0].index, first);
  EXPECT_EQ(d.filter.evidence()[1].index, second);
  constexpr auto kVerdict = static_cast<std::size_t>(EvidenceKind::kVerdict);
  EXPECT_EQ(d.filter.evidence()[0].levels.of[kVerdict], 0);
  EXPECT_EQ(d.filter.evidence()[1].levels.of[kVerdict], 2);
}

TEST(EvidenceFilter, ADetectionOfAKnownObjectIsLikelierRealThanOneElsewhere) {
  EvidenceDrive d;
  d.know({40.0, 3.0}, {12.0, 0.0});
  d.filter.add_tracks(*d.tracks);
  d.begin();
  const std::size_t in_box = d.add({38.2, 3.0}, 12.0), elsewhere = d.add({38.2, -14.0}, 12.0);
  const std::size_t other_rate = d.add({38.2, 3.0}, -9.0);
  d.classify();
  EXPECT_GT(d.real(in_box), 0.7);
  EXPECT_LT(d.real(elsewhere), 0.3);
  EXPECT_GT(d.real(in_box), d.real(other_rate));
}

TEST(EvidenceFilter, AnAmbiguousDetectionOfAKnownObjectIsKept) {
  EvidenceDrive d;
  d.know({40.0, 3.0}, {12.0, 0.0});
  d.filter.add_tracks(*d.tracks);
  d.begin();
  const std::size_t ambiguous = d.add({38.2, 3.0}, 12.0 - 30.0, corrected_flag::kMoving | corrected_flag::kAmbiguous);
  d.classify();
  EXPECT_GE(d.real(ambiguous), 0.5);
  EXPECT_EQ(d.out->provenance[ambiguous], Provenance::kMoving);
}

TEST(EvidenceFilter, ADoubtedDetectionIsLessLikelyRealAndNotRejected) {
  const auto real = [](std::uint16_t flags) {
    EvidenceDrive d;
    d.add({38.2, 3.0}, 12.0, flags);
    d.classify();
    EXPECT_NE(d.out->provenance[0], Provenance::kUnknown);
    return d.real(0);
  };
  EXPECT_LT(real(corrected_flag::kMoving | corrected_flag::kDoubted), real(corrected_flag::kMoving));
}

TEST(EvidenceFilter, TheSensorsExistenceCountsOnlyWhereItIsStated) {
  EvidenceConfig config;
  config.weights.alone.of[static_cast<std::size_t>(EvidenceKind::kExistence)] = {0.0, -2.0, -1.0, 1.0, 2.0};
  const auto ratio = [&](std::uint32_t fields, float existence) {
    EvidenceDrive d(config);
    d.add({38.2, 3.0}, 12.0);
    d.scan->fields = fields;
    d.scan->existence_probability[0] = existence;
    d.classify();
    return d.out->moving_log_likelihood_ratio[0];
  };
  EXPECT_EQ(ratio(0, 0.9F), 0.0F);
  EXPECT_EQ(ratio(scan_field::kExistence, 0.9F), 2.0F);
  EXPECT_EQ(ratio(scan_field::kExistence, 0.1F), -2.0F);
  EXPECT_EQ(ratio(scan_field::kExistence, std::numeric_limits<float>::quiet_NaN()), 0.0F) << "not stated for this one";
}

TEST(EvidenceFilter, AClockThatJumpsClearsTheMemory) {
  for (const std::int64_t jump_ns : {std::int64_t{-5'000'000'000}, std::int64_t{5'000'000'000}}) {
    EvidenceDrive driven, fresh;
    const auto cycle = [](EvidenceDrive& d) {
      d.begin();
      d.add_rail(8.0);
      d.add({30.0, 1.0}, 0.5);
      d.classify();
    };
    for (int k = 0; k < 20; ++k) {
      cycle(driven);
      driven.next_cycle();
    }
    constexpr auto kPast = static_cast<std::size_t>(EvidenceKind::kPast);
    ASSERT_EQ(driven.filter.evidence()[0].levels.of[kPast], 4);
    ASSERT_GT(driven.out->number_of_reflector_segments, 0U);
    driven.now_ns += jump_ns;
    fresh.now_ns = driven.now_ns;
    cycle(driven);
    cycle(fresh);
    EXPECT_EQ(driven.filter.evidence()[0].levels.of[kPast], 0);
    EXPECT_EQ(driven.filter.map_points(), fresh.filter.map_points());
    const std::size_t moving = driven.scan->number_of_valid_detections - 1;
    expect_same_output(*driven.out, *fresh.out, moving);
  }
}

TEST(EvidenceFilter, TheRatioDoesNotDependOnTheTracksWhereNoMirrorIsKnown) {
  EvidenceDrive empty, full;
  std::mt19937 random(4), again(4);
  for (int cycle = 0; cycle < 15; ++cycle) {
    for (auto [d, generator] : {std::pair(&empty, &random), std::pair(&full, &again)}) {
      std::uniform_real_distribution<double> x(5.0, 70.0), y(-20.0, 20.0), rate(-15.0, 15.0);
      d->begin();
      for (int k = 0; k < 25; ++k) d->add({x(*generator), y(*generator)}, rate(*generator));
      for (int k = 0; k < 3; ++k) d->add({30.0 + 0.3 * k, 1.0}, 9.0);
      d->tracks->number_of_tracks = 0;
      d->tracks->header.measurement_time_ns = d->now_ns;
    }
    full.know({31.0, 1.0}, {9.0, 0.0});
    full.know({20.0, -10.0}, {-5.0, 1.0}, 0.6F);
    double differences = 0.0;
    for (EvidenceDrive* d : {&empty, &full}) {
      d->filter.add_tracks(*d->tracks);
      d->classify();
    }
    for (std::size_t i = 0; i < full.scan->number_of_valid_detections; ++i) {
      differences += std::abs(empty.real(i) - full.real(i));
      EXPECT_EQ(empty.out->moving_log_likelihood_ratio[i], full.out->moving_log_likelihood_ratio[i]) << i;
    }
    EXPECT_GT(differences, 0.1) << "the probabilities do depend on them";
    empty.next_cycle();
    full.next_cycle();
  }
}

TEST(EvidenceFilter, EachRadarHasItsOwnWeights) {
  EvidenceConfig config;
  config.weights.alone.constant = 0.5;
  config.radars.resize(1);
  config.radars[0].radar_id = 7;
  config.radars[0].weights.alone.constant = -1.5;
  const auto ratio = [&](std::uint32_t radar) {
    EvidenceDrive d(config);
    d.add({38.2, 3.0}, 12.0);
    d.scan->header.source_id = radar;
    d.classify();
    return d.out->moving_log_likelihood_ratio[0];
  };
  EXPECT_EQ(ratio(7), -1.5F);
  EXPECT_EQ(ratio(1), 0.5F);
}

TEST(EvidenceFilter, AMirrorImageOfAKnownObjectIsNamedSo) {
  EvidenceDrive d;
  std::size_t image = 0;
  for (int k = 0; k < 40; ++k) {
    d.tracks->number_of_tracks = 0;
    d.know({35.0, 3.0}, {-10.0, 0.0});
    d.filter.add_tracks(*d.tracks);
    d.begin();
    d.add_rail(8.0);
    // Three bounces: mirrored at y = 8, so at y = 13.
    const Eigen::Vector2d mirrored(35.0, 13.0);
    const double rate = (mirrored - Eigen::Vector2d(3.6, 0.0)).normalized().dot(Eigen::Vector2d(-10.0, 0.0));
    image = d.add(mirrored, rate);
    d.classify();
    d.next_cycle();
  }
  EXPECT_GT(d.out->probability(Provenance::kGhostType2, image), d.out->probability(Provenance::kGhostType1, image));
  EXPECT_GT(d.out->probability(Provenance::kGhostType2, image), d.out->probability(Provenance::kClutter, image));
}

TEST(EvidenceFilter, ClassifiesWithoutAllocation) {
  EvidenceDrive d;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(5.0, 70.0), y(-20.0, 20.0), rate(-15.0, 15.0);
  const std::uint64_t before = runtime::counted_allocations();
  for (int cycle = 0; cycle < 60; ++cycle) {
    d.speed_mps = 10.0;
    fill_mixed(d, random);
    while (d.scan->number_of_valid_detections < kMaxDetections) d.add({x(random), y(random)}, rate(random));
    d.tracks->number_of_tracks = 0;
    for (std::size_t k = 0; k < kMaxTracks; ++k) d.know({x(random), y(random)}, {rate(random), 0.0});
    {
      const runtime::CountAllocations counting;
      if (cycle > 3) d.filter.add_tracks(*d.tracks);
      d.classify();
    }
    d.next_cycle();
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST(EvidenceFilter, BadCountsInAMessageDoNoHarm) {
  EvidenceDrive d;
  d.add({30.0, 1.0}, 9.0);
  d.scan->number_of_valid_detections = 100'000;
  d.tracks->number_of_tracks = 100'000;
  d.tracks->header.measurement_time_ns = d.now_ns;
  d.filter.add_tracks(*d.tracks);
  d.classify();
  EXPECT_EQ(d.out->number_of_valid_detections, kMaxDetections);
}

}  // namespace
}  // namespace boresight::ghosts
