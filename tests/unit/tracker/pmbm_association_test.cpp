// Associations that the search finds, against the enumeration of all of them.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "services/tracker/core/pmbm/association.hpp"
#include "tests/unit/tracker/list_model.hpp"
#include "tests/unit/tracker/support.hpp"

namespace boresight::tracking::pmbm {
namespace {

using support::Detections;
using support::ListModel;
using support::Reference;

struct SmallScene {
  ListModel model = support::car_model(false);
  std::vector<Reference> objects;
  std::vector<double> existence;
  Detections z;
};

/// Two cars side by side, a few detections of each, and a false one between them.
SmallScene random_small_scene(support::Random& random, double distance_m) {
  SmallScene s;
  const double log_clutter = support::car_log_clutter(s.model);
  for (int i = 0; i < 2; ++i) {
    Reference r;
    r.mean << 30.0, distance_m * i, 0.0, 0.0;
    r.covariance = Eigen::Vector4d(0.3, 0.3, 1.0, 1.0).asDiagonal();
    r.rate_shape = 8.0;
    r.rate_inverse_scale = 4.0;
    r.dof = 30.0;
    r.scale = 24.0 * Eigen::Vector2d(4.0, 1.0).asDiagonal();
    s.objects.push_back(r);
    s.existence.push_back(support::uniform(random, 0.5, 0.99));
    const Detections z =
        support::draw_detections(random, r.mean, r.extent(), s.model.sensor, random() % 4, log_clutter);
    s.z.insert(s.z.end(), z.begin(), z.end());
  }
  s.z.push_back(support::detection_at(
      {30.0 + support::uniform(random, -3.0, 3.0), distance_m * support::uniform(random, 0.0, 1.0)}, {0.0, 0.0}, 0.0,
      log_clutter));
  std::shuffle(s.z.begin(), s.z.end(), random);
  return s;
}

struct Enumeration {
  double log_best = -1e300, log_all = 0.0;
  std::vector<int> best;              ///< object of each measurement, −1: clutter
  std::array<double, 2> existence{};  ///< after the scan
  std::vector<double> explained;      ///< of each measurement, by an object
};

Enumeration enumerate(const SmallScene& s) {
  const std::size_t n = s.z.size();
  std::vector<int> labels(n, -1);
  std::vector<double> logs;
  std::vector<std::array<double, 2>> existences;
  std::vector<std::vector<int>> all;
  while (true) {
    double log_p = 0.0;
    std::array<double, 2> existence{};
    for (int o = 0; o < 2; ++o) {
      const auto object = static_cast<std::size_t>(o);
      Detections cell;
      for (std::size_t i = 0; i < n; ++i) {
        if (labels[i] == o) cell.push_back(s.z[i]);
      }
      const double r = s.existence[object];
      if (cell.empty()) {
        const double q = Prediction<double>(support::component_of(s.objects[object]), s.model.sensor).missed();
        log_p += std::log(1.0 - r + r * q);
        existence[object] = r * q / (1.0 - r + r * q);
      } else {
        log_p += std::log(r) + support::log_likelihood_reference(s.objects[object], s.model.sensor, cell);
        existence[object] = 1.0;
      }
    }
    logs.push_back(log_p);
    existences.push_back(existence);
    all.push_back(labels);
    std::size_t digit = 0;
    while (digit < n && ++labels[digit] == 2) labels[digit++] = -1;
    if (digit == n) break;
  }
  Enumeration e;
  e.explained.assign(n, 0.0);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    if (logs[k] <= e.log_best) continue;
    e.log_best = logs[k];
    e.best = all[k];
  }
  double sum = 0.0;
  for (const double l : logs) sum += std::exp(l - e.log_best);
  e.log_all = e.log_best + std::log(sum);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const double w = std::exp(logs[k] - e.log_all);
    for (std::size_t o = 0; o < 2; ++o) e.existence[o] += w * existences[k][o];
    for (std::size_t i = 0; i < n; ++i) e.explained[i] += all[k][i] >= 0 ? w : 0.0;
  }
  return e;
}

struct Searched {
  std::vector<Candidate> candidates;
  double log_all = 0.0;
  std::array<double, 2> existence{};
  std::uint32_t work = 0;
};

Searched search_scene(SmallScene& s) {
  const Parameters parameters;
  const Capacity capacity;
  Association association(parameters, capacity);
  PoissonPart poisson(parameters, capacity);
  poisson.begin_scan(s.model);
  Group group(capacity);
  group.add_row(0.0);
  for (std::size_t o = 0; o < 2; ++o) {
    group.add_column(static_cast<std::uint32_t>(o + 1));
    LocalHypothesis local;
    local.existence = s.existence[o];
    local.component = support::component_of(s.objects[o]);
    group.at(0, o) = static_cast<std::int16_t>(group.add_local(local));
  }
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < s.z.size(); ++i) keys.push_back(mixed(i + 1));
  Searched out;
  const auto found = association.search(s.model, poisson, group, s.z, keys, out.work);
  out.candidates.assign(found.begin(), found.end());
  double sum = 0.0;
  const double best = found[0].log_weight;
  for (const Candidate& c : found) sum += std::exp(c.log_weight - best);
  out.log_all = best + std::log(sum);
  for (const Candidate& c : found) {
    const double w = std::exp(c.log_weight - out.log_all);
    for (std::size_t o = 0; o < 2; ++o) {
      const double r = s.existence[o], q = association.prediction(o).missed();
      out.existence[o] += w * (c.cells[o].n > 0.0 ? 1.0 : r * q / (1.0 - r + r * q));
    }
  }
  return out;
}

TEST(Association, FindsTheLikeliestOfAllAssociations) {
  support::Random random(1);
  for (const double distance_m : {3.0, 5.0, 8.0}) {
    int found = 0;
    constexpr int kRuns = 60;
    for (int run = 0; run < kRuns; ++run) {
      SmallScene s = random_small_scene(random, distance_m);
      const Enumeration expected = enumerate(s);
      const Searched searched = search_scene(s);
      // The likeliest hard association is among the candidates; softly shared, it need not be the first.
      const bool has_best =
          std::any_of(searched.candidates.begin(), searched.candidates.end(), [&](const Candidate& c) {
            return std::equal(c.labels.begin(), c.labels.end(), expected.best.begin(),
                              [](std::int16_t a, int b) { return a == b; });
          });
      found += has_best ? 1 : 0;
    }
    EXPECT_GE(found, kRuns * 95 / 100) << distance_m;
  }
}

TEST(Association, TotalWeightAndExistenceAreCloseToTheSumOverAllAssociations) {
  support::Random random(2);
  for (const double distance_m : {3.0, 5.0, 8.0}) {
    double squares_of_weight = 0.0, squares_of_existence = 0.0, worst = 0.0;
    constexpr int kRuns = 60;
    for (int run = 0; run < kRuns; ++run) {
      SmallScene s = random_small_scene(random, distance_m);
      const Enumeration expected = enumerate(s);
      const Searched searched = search_scene(s);
      const double error = searched.log_all - expected.log_all;
      squares_of_weight += error * error / kRuns;
      for (std::size_t o = 0; o < 2; ++o) {
        const double of_existence = searched.existence[o] - expected.existence[o];
        squares_of_existence += of_existence * of_existence / (2.0 * kRuns);
        worst = std::max(worst, std::abs(of_existence));
      }
    }
    EXPECT_LT(std::sqrt(squares_of_weight), 0.2) << distance_m;
    EXPECT_LT(std::sqrt(squares_of_existence), 0.03) << distance_m;
    EXPECT_LT(worst, 0.2) << distance_m;
  }
}

TEST(Association, SharesEachMeasurementOnceBetweenObjectsAndClutter) {
  support::Random random(3);
  for (int run = 0; run < 60; ++run) {
    SmallScene s = random_small_scene(random, 3.0);
    for (const Candidate& c : search_scene(s).candidates) {
      double shared = 0.0;
      for (const Cell<double>& cell : c.cells) {
        EXPECT_GE(cell.n, 0.0);
        shared += cell.n;
      }
      EXPECT_LE(shared, static_cast<double>(s.z.size()) + 1e-9);
      ASSERT_EQ(c.shared.size(), c.cells.size());
      for (const double share : c.shared) {
        EXPECT_GE(share, -1e-9);
        EXPECT_LE(share, 1.0);
      }
    }
  }
}

TEST(Association, StatesTheShareOfACellThatOtherCellsHave) {
  support::Random random(7);
  SmallScene s = random_small_scene(random, 3.0);
  s.existence = {0.99, 0.99};
  s.z.clear();
  const double log_clutter = support::car_log_clutter(s.model);
  for (const double y_m : {-0.3, 3.3, 1.5}) {  // of the one, of the other, and between them
    for (const double x_m : {29.5, 30.5})
      s.z.push_back(support::detection_at({x_m, y_m}, {0.0, 0.0}, 0.0, log_clutter));
  }
  const Candidate between = search_scene(s).candidates.front();
  EXPECT_GT(between.shared[0] + between.shared[1], 0.2);
  s.z.resize(4);
  const Candidate apart = search_scene(s).candidates.front();
  EXPECT_LT(apart.shared[0] + apart.shared[1], 0.02);
}

TEST(Association, IsOneCandidateWhereNothingIsAmbiguous) {
  support::Random random(4);
  SmallScene s = random_small_scene(random, 60.0);
  s.existence = {1.0, 1.0};
  s.z.clear();
  for (const Reference& r : s.objects) {
    const Detections z = support::draw_detections(random, r.mean, r.extent(), s.model.sensor, 5, -25.0);
    s.z.insert(s.z.end(), z.begin(), z.end());
  }
  const Searched searched = search_scene(s);
  ASSERT_EQ(searched.candidates.size(), 1U);
  EXPECT_EQ(searched.candidates[0].labels, (std::vector<std::int16_t>{0, 0, 0, 0, 0, 1, 1, 1, 1, 1}));
  EXPECT_LT(searched.candidates[0].shared[0] + searched.candidates[0].shared[1], 1e-6);
  double expected = 0.0;
  for (std::size_t o = 0; o < 2; ++o) {
    expected += support::log_likelihood_reference(s.objects[o], s.model.sensor, std::span(s.z).subspan(5 * o, 5));
  }
  EXPECT_NEAR(searched.candidates[0].log_weight, expected, 1e-6);
}

TEST(Association, OfAnObjectThatDoesNotExistHasFiniteWeights) {
  support::Random random(5);
  for (int run = 0; run < 30; ++run) {
    SmallScene s = random_small_scene(random, 3.0);
    s.existence = {0.0, 0.9};
    const Searched searched = search_scene(s);
    for (const Candidate& c : searched.candidates) {
      EXPECT_TRUE(std::isfinite(c.log_weight));
      for (const std::int16_t label : c.labels) EXPECT_NE(label, 0) << "detections of nothing";
    }
  }
}

}  // namespace
}  // namespace boresight::tracking::pmbm
