#include "services/tracker/core/classes/decision_forest.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/tracker/core/classes/forest_text.hpp"

namespace boresight::tracking::decision_forest_test {
namespace {

constexpr double kTight = 1e-6;

/// Two trees: one by the first feature and then the second, one by the second feature.
ForestTable two_trees() {
  ForestTable table;
  table.missing = {0.0F, 5.0F};
  table.nodes = {{0, 4, 1.0F},  // x₀ ≤ 1 → 1, else 4
                 {1, 3, 2.0F},  // x₁ ≤ 2 → 2, else 3
                 {ForestNode::kLeaf, 0, 0.0F},
                 {ForestNode::kLeaf, 1, 0.0F},
                 {ForestNode::kLeaf, 2, 0.0F},
                 {1, 7, 4.0F},  // x₁ ≤ 4 → 6, else 7
                 {ForestNode::kLeaf, 0, 0.0F},
                 {ForestNode::kLeaf, 2, 0.0F}};
  table.trees = {0, 5};
  table.leaves = {{1.0F, 0.0F, 0.0F, 0.0F, 0.0F}, {0.0F, 0.5F, 0.5F, 0.0F, 0.0F}, {0.0F, 0.0F, 0.0F, 0.0F, 1.0F}};
  return table;
}

ClassProbabilities at(const ForestTable& table, double x0, double x1) {
  return DecisionForest(table).probabilities(std::array{x0, x1});
}

TEST(DecisionForest, IsTheMeanOfTheLeavesThatAreReached) {
  const ForestTable table = two_trees();
  EXPECT_NEAR(at(table, 1.0, 2.0)[0], 1.0,
              kTight);  // both trees at the first leaf; a threshold belongs to the smaller side
  const ClassProbabilities p = at(table, 0.0, 3.0);
  EXPECT_NEAR(p[0], 0.5, kTight);
  EXPECT_NEAR(p[1], 0.25, kTight);
  EXPECT_NEAR(p[2], 0.25, kTight);
  EXPECT_NEAR(at(table, 2.0, 9.0)[4], 1.0, 1e-5);
}

TEST(DecisionForest, UnknownFeatureHasTheValueOfTheTable) {
  const ForestTable table = two_trees();
  for (const double unknown : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_EQ(at(table, 0.5, unknown), at(table, 0.5, 5.0));
    EXPECT_EQ(at(table, unknown, 1.0), at(table, 0.0, 1.0));
  }
  EXPECT_EQ(DecisionForest(table).probabilities(std::array{0.5}), at(table, 0.5, 5.0));
}

TEST(DecisionForest, ExponentSharpensTheMean) {
  ForestTable table = two_trees();
  table.exponent = 2.0;
  const ClassProbabilities p = at(table, 0.0, 3.0);
  EXPECT_NEAR(p[0], 0.25 / 0.375, 1e-5);
  EXPECT_NEAR(p[1], 0.0625 / 0.375, 1e-5);
}

TEST(DecisionForest, ProbabilitiesSumToOneWhateverTheFeatures) {
  std::mt19937 random(1);
  std::normal_distribution<double> value(0.0, 10.0);
  ForestTable table = two_trees();
  table.exponent = 3.7;
  const DecisionForest forest(table);
  for (int i = 0; i < 1000; ++i) {
    const ClassProbabilities p = forest.probabilities(std::array{value(random), value(random)});
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
    for (const double share : p) EXPECT_GE(share, 0.0);
  }
}

TEST(DecisionForest, WithoutTreesItIsThePrior) {
  ForestTable table;
  table.prior_share = {0.1, 0.2, 0.3, 0.1, 0.3};
  EXPECT_EQ(DecisionForest(table).probabilities({}), table.prior_share);
}

TEST(DecisionForest, AllocatesNothing) {
  const DecisionForest forest(two_trees());
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 100; ++i) static_cast<void>(forest.probabilities(std::array{0.1 * i, 5.0}));
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

TEST(DecisionForest, RefusesTablesThatCannotBeEvaluated) {
  const auto refuses = [](const auto& change) {
    ForestTable table = two_trees();
    change(table);
    EXPECT_THROW(DecisionForest{table}, std::invalid_argument);
  };
  refuses([](ForestTable& t) { t.nodes[0].other = 0; });  // a walk without end
  refuses([](ForestTable& t) { t.nodes[5].other = 8; });
  refuses([](ForestTable& t) { t.nodes[0].feature = 2; });
  refuses([](ForestTable& t) { t.nodes[2].other = 3; });
  refuses([](ForestTable& t) { t.nodes[0].threshold = NAN; });
  refuses([](ForestTable& t) { t.nodes.back() = {0, 8, 1.0F}; });
  refuses([](ForestTable& t) { t.leaves[0][1] = 0.2F; });
  refuses([](ForestTable& t) { t.leaves[0] = {1.5F, -0.5F, 0.0F, 0.0F, 0.0F}; });
  refuses([](ForestTable& t) { t.trees[1] = 8; });
  refuses([](ForestTable& t) { t.missing[0] = NAN; });
  refuses([](ForestTable& t) { t.exponent = 0.0; });
  refuses([](ForestTable& t) { t.prior_share[0] = 0.9; });
}

/// A whole text with one tree: the first feature, then the second.
std::string text_of_a_forest() {
  std::string text =
      "# a comment\nversion,1\nclasses,pedestrian,two_wheeler,car,van,truck\nprior,200,200,200,200,200\n";
  for (const ForestNumber& number : forest_numbers()) {
    text += "number," + std::string(number.key) + "," + std::to_string(number.of({})) + "\n";
  }
  for (std::size_t k = 0; k < kClassFeatures; ++k) {
    text += "feature," + std::string(name_of(static_cast<ClassFeature>(k))) + ",0.5\n";
  }
  return text +
         "tree\nsplit,0,1.5\nleaf,1000,0,0,0,0\nsplit,1,-2\nleaf,0,1000,0,0,0\nleaf,0,0,0,0,1000\n"
         "tree\nleaf,0,0,500,500,0\nend\n";
}

TEST(ForestText, ReadsTreesAsTheyAreWritten) {
  const ObjectForest forest = parse_forest(text_of_a_forest());
  EXPECT_EQ(forest.table.trees.size(), 2U);
  const DecisionForest trees(forest.table);
  ClassFeatures x{};
  x[0] = 1.0;
  EXPECT_NEAR(trees.probabilities(x)[0], 0.5, 1e-5);
  x[0] = 2.0;
  x[1] = -3.0;
  EXPECT_NEAR(trees.probabilities(x)[1], 0.5, 1e-5);
  x[1] = 0.0;
  EXPECT_NEAR(trees.probabilities(x)[4], 0.5, 1e-5);
  EXPECT_NEAR(trees.probabilities(x)[2], 0.25, 1e-5);
  EXPECT_EQ(forest.evidence.memory_s, ClassEvidenceParameters{}.memory_s);
  EXPECT_EQ(forest.levels.prior_number, RadarLevelParameters{}.prior_number);
}

TEST(ForestText, NamesTheFirstWrongLine) {
  const std::string whole = text_of_a_forest();
  const auto line_of = [](std::string_view text, std::size_t place) {
    return static_cast<std::size_t>(1 +
                                    std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
  };
  const auto refuses = [&](const std::string& old, const std::string& put, const std::string& problem) {
    std::string text = whole;
    const std::size_t place = text.find(old);
    ASSERT_NE(place, std::string::npos) << old;
    text.replace(place, old.size(), put);
    try {
      static_cast<void>(parse_forest(text));
      ADD_FAILURE() << old << " → " << put;
    } catch (const ForestTextError& error) {
      EXPECT_EQ(error.line, line_of(text, place)) << error.what();
      EXPECT_NE(std::string(error.what()).find(problem), std::string::npos) << error.what();
    }
  };
  refuses("version,1", "version,2", "version");
  refuses("pedestrian,two_wheeler", "two_wheeler,pedestrian", "class 1 must be pedestrian");
  refuses("prior,200", "prior,900", "sum to 1000");
  refuses("number,memory_s,5", "number,memory_s,nan", "must be a number from 0.1 to 100");
  refuses("number,memory_s", "number,memory", "memory_s");
  refuses("feature,most_count", "feature,length_m", "most_count");
  refuses("feature,most_count,0.5", "feature,most_count", "2 values");
  refuses("split,0,1.5", "split,28,1.5", "whole number from 0 to 27");
  refuses("split,0,1.5", "split,0,inf", "must be a number");
  refuses("split,0,1.5", "branch,0,1.5", "split");
  refuses("leaf,0,1000,0,0,0", "leaf,0,999,0,0,0", "sum to 1000");
  refuses("leaf,0,1000,0,0,0", "leaf,0,1000,0,0", "5 values");
  refuses("leaf,0,1000,0,0,0", "leaf,0,-1,1001,0,0", "whole number");
  refuses("leaf,0,0,0,0,1000", "tree", "split");
  refuses("end\n", "leaf,0,0,0,0,1000\nend\n", "tree");
  refuses("end\n", "tree", "must end with");
}

TEST(ForestText, RefusesATableThatEndsEarlyOrHoldsNoTree) {
  const std::string whole = text_of_a_forest();
  for (std::size_t length = 0; length < whole.size() - 1; length += 7) {
    if (whole.substr(0, length).ends_with("end")) continue;
    EXPECT_THROW(static_cast<void>(parse_forest(whole.substr(0, length))), ForestTextError) << length;
  }
  EXPECT_THROW(static_cast<void>(parse_forest(whole.substr(0, whole.find("tree\n")) + "end\n")), ForestTextError);
  EXPECT_THROW(static_cast<void>(parse_forest(whole + "tree\n")), ForestTextError);
}

}  // namespace
}  // namespace boresight::tracking::decision_forest_test
