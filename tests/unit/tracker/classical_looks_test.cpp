// Hits and misses among the latest looks.
#include <deque>
#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/classical/looks.hpp"

namespace boresight::tracking::classical {
namespace {

TEST(Looks, CountWhatAListOfLooksCounts) {
  std::mt19937_64 random(1);
  std::bernoulli_distribution hit(0.4);
  Looks looks;
  std::deque<bool> list;
  for (int i = 0; i < 200; ++i) {
    const bool is_hit = hit(random);
    looks.add(is_hit);
    list.push_front(is_hit);
    for (int n = 1; n <= Looks::kMost; ++n) {
      int hits = 0, misses = 0;
      for (int k = 0; k < n && k < static_cast<int>(list.size()); ++k) {
        (list[static_cast<std::size_t>(k)] ? hits : misses) += 1;
      }
      ASSERT_EQ(looks.hits(n), hits);
      ASSERT_EQ(looks.misses(n), misses);
    }
  }
}

TEST(Looks, NothingBeforeTheFirstLookIsAMiss) {
  EXPECT_EQ(Looks{}.misses(Looks::kMost), 0);
  EXPECT_EQ(Looks{}.hits(Looks::kMost), 0);
}

}  // namespace
}  // namespace boresight::tracking::classical
