// Counters: steps, repetitions, losses, wraps, jumps and recovery.
#include <gtest/gtest.h>

#include "services/common/e2e/checker.hpp"
#include "services/common/e2e/header.hpp"
#include "services/common/e2e/protector.hpp"
#include "tests/unit/e2e/support.hpp"

namespace boresight::e2e {
namespace {

using test::all_configs;
using test::Named;

/// A valid message with this counter.
std::vector<std::uint8_t> message(const Config& config, std::uint64_t counter) {
  std::vector<std::uint8_t> data(40, 0x33);
  Header header;
  header.counter = static_cast<std::uint32_t>(counter);
  header.length = static_cast<std::uint32_t>(data.size());
  header.data_id = sent_data_id(config);
  write_fields(config, header, data);
  write_crc(config, compute_crc(config, header.counter, data), data);
  return data;
}

Config with_delta(Config config, std::uint32_t max_delta_counter) {
  config.max_delta_counter = max_delta_counter;
  return config;
}

std::uint64_t counter_values(const Config& config) {
  return layout(config.profile).counter_values;
}

TEST(Sequence, WrapsOfEveryProfile) {
  for (const auto& [profile, values] : std::vector<std::pair<Profile, std::uint64_t>>{{Profile::kP01, 15},
                                                                                      {Profile::kP11, 15},
                                                                                      {Profile::kP02, 16},
                                                                                      {Profile::kP22, 16},
                                                                                      {Profile::kP04, 65536},
                                                                                      {Profile::kP05, 256},
                                                                                      {Profile::kP06, 256},
                                                                                      {Profile::kP07, 4294967296}}) {
    Config config;
    config.profile = profile;
    EXPECT_EQ(counter_values(config), values);
    Checker checker(config);
    EXPECT_EQ(checker.check(message(config, values - 2)), Status::kInitial);
    EXPECT_EQ(checker.check(message(config, values - 1)), Status::kOk);
    EXPECT_EQ(checker.check(message(config, 0)), Status::kOk);
    EXPECT_EQ(checker.check(message(config, 1)), Status::kOk);
    EXPECT_EQ(checker.statistics().lost, 0u);
    EXPECT_EQ(checker.statistics().accepted, 4u);
  }
}

TEST(Sequence, SenderWrapsWhereTheReceiverExpectsIt) {
  for (const Named& named : all_configs()) {
    const std::uint64_t values = counter_values(named.config);
    if (values > 65536) continue;
    Protector protector(named.config);
    Checker checker(named.config);
    std::vector<std::uint8_t> data(40, 0);
    const std::uint64_t messages = 2 * values + 3;
    for (std::uint64_t i = 0; i < messages; ++i) {
      ASSERT_LT(protector.counter(), values) << named.name;
      ASSERT_TRUE(protector.protect(data));
      ASSERT_EQ(checker.check(data), i == 0 ? Status::kInitial : Status::kOk) << named.name << ", message " << i;
    }
    EXPECT_EQ(checker.statistics().accepted, messages) << named.name;
  }
}

TEST(Sequence, FirstCounterOfASender) {
  for (const Named& named : all_configs()) {
    const bool counts_first = named.config.profile == Profile::kP02 || named.config.profile == Profile::kP22;
    EXPECT_EQ(Protector(named.config).counter(), counts_first ? 1u : 0u) << named.name;
  }
}

TEST(Sequence, LossesUpToTheLimitAreCountedAndAccepted) {
  for (const Named& named : all_configs()) {
    const Config config = with_delta(named.config, 4);
    const std::uint64_t values = counter_values(config);
    for (std::uint64_t steps = 1; steps <= 5; ++steps) {
      for (const std::uint64_t start : {std::uint64_t{0}, values - 2}) {  // the second one wraps
        Checker checker(config);
        EXPECT_EQ(checker.check(message(config, start)), Status::kInitial);
        const Status expected = steps == 1 ? Status::kOk : steps <= 4 ? Status::kOkSomeLost : Status::kWrongSequence;
        EXPECT_EQ(checker.check(message(config, (start + steps) % values)), expected) << named.name << ", " << steps;
        EXPECT_EQ(checker.statistics().lost, steps - 1) << named.name;
        EXPECT_EQ(checker.statistics().accepted, steps <= 4 ? 2u : 1u) << named.name;
        EXPECT_EQ(checker.statistics().wrong_sequence, steps <= 4 ? 0u : 1u) << named.name;
      }
    }
  }
}

TEST(Sequence, RepetitionIsRejectedAndDoesNotDisturb) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 3)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 3)), Status::kRepeated);
    EXPECT_EQ(checker.check(message(named.config, 3)), Status::kRepeated);
    EXPECT_EQ(checker.check(message(named.config, 4)), Status::kOk);
    EXPECT_EQ(checker.statistics().repeated, 2u);
    EXPECT_EQ(checker.statistics().received, 4u);
    EXPECT_EQ(checker.statistics().accepted, 2u);
  }
}

TEST(Sequence, FollowsASenderThatRestarted) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 5)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 6)), Status::kOk);
    EXPECT_EQ(checker.check(message(named.config, 0)), Status::kWrongSequence) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 1)), Status::kOk) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 2)), Status::kOk) << named.name;
    EXPECT_EQ(checker.statistics().wrong_sequence, 1u);
    EXPECT_EQ(checker.statistics().lost, 0u) << named.name << ": a step back is no loss";
  }
}

TEST(Sequence, FollowsASenderAfterALongGap) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 0)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 6)), Status::kWrongSequence) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 7)), Status::kOk) << named.name;
    EXPECT_EQ(checker.statistics().lost, 5u);
  }
}

TEST(Sequence, OneLateMessageDoesNotRejectTheNextGoodOne) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    for (const std::uint64_t counter : {5, 6, 7}) checker.check(message(named.config, counter));
    EXPECT_EQ(checker.check(message(named.config, 5)), Status::kWrongSequence) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 8)), Status::kOk) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 9)), Status::kOk) << named.name;
    EXPECT_EQ(checker.statistics().lost, 0u) << named.name;
  }
}

TEST(Sequence, StrayCountersAreForgottenWhenTheSequenceGoesOn) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 5)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 9)), Status::kWrongSequence);
    EXPECT_EQ(checker.check(message(named.config, 6)), Status::kOk);
    EXPECT_EQ(checker.check(message(named.config, 10)), Status::kWrongSequence) << named.name << ": follows the stray";
  }
}

TEST(Sequence, AfterTwoStrayCountersTheOldSequenceIsDropped) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 1)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 5)), Status::kWrongSequence);
    EXPECT_EQ(checker.check(message(named.config, 10)), Status::kWrongSequence);
    EXPECT_EQ(checker.check(message(named.config, 2)), Status::kWrongSequence) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 3)), Status::kOk) << named.name;
  }
}

TEST(Sequence, AStepOfOneIsNeverWrong) {
  for (const Named& named : all_configs()) {
    const Config config = with_delta(named.config, 0);  // invalid, but must not exclude the sender
    Checker checker(config);
    EXPECT_EQ(checker.check(message(config, 1)), Status::kInitial);
    EXPECT_EQ(checker.check(message(config, 2)), Status::kOk) << named.name;
  }
}

TEST(Sequence, ASenderWithRandomCountersIsRejectedUntilTheyAreInSequence) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 1)), Status::kInitial);
    for (const std::uint64_t counter : {4, 7, 10, 13}) {
      EXPECT_EQ(checker.check(message(named.config, counter)), Status::kWrongSequence) << named.name << counter;
      EXPECT_EQ(checker.check(message(named.config, counter)), Status::kRepeated) << named.name << counter;
    }
    EXPECT_EQ(checker.check(message(named.config, 14)), Status::kOk) << named.name;
    EXPECT_EQ(checker.statistics().wrong_sequence, 4u);
    EXPECT_EQ(checker.statistics().lost, 8u) << named.name;
  }
}

TEST(Sequence, RejectedContentDoesNotMoveTheSequence) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 5)), Status::kInitial);
    std::vector<std::uint8_t> broken = message(named.config, 9);
    broken.back() ^= 1;
    EXPECT_EQ(checker.check(broken), Status::kWrongCrc) << named.name;
    EXPECT_EQ(checker.check({}), Status::kWrongLength) << named.name;
    EXPECT_EQ(checker.check(message(named.config, 6)), Status::kOk) << named.name;
    EXPECT_EQ(checker.statistics().wrong_crc, 1u);
    EXPECT_EQ(checker.statistics().wrong_length, 1u);
    EXPECT_EQ(checker.statistics().received, 4u);
  }
}

TEST(Sequence, FifteenIsAnInvalidCounterOfProfiles1And11) {
  for (const Profile profile : {Profile::kP01, Profile::kP11}) {
    Config config;
    config.profile = profile;
    Checker checker(config);
    EXPECT_EQ(checker.check(message(config, 15)), Status::kWrongSequence);
    EXPECT_EQ(checker.check(message(config, 14)), Status::kInitial);
    EXPECT_EQ(checker.check(message(config, 15)), Status::kWrongSequence);
    EXPECT_EQ(checker.check(message(config, 0)), Status::kOk);
    EXPECT_EQ(checker.statistics().lost, 0u);
  }
}

TEST(Sequence, ResetForgetsTheCounterAndKeepsTheStatistics) {
  for (const Named& named : all_configs()) {
    Checker checker(named.config);
    EXPECT_EQ(checker.check(message(named.config, 2)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 9)), Status::kWrongSequence);
    checker.reset();
    EXPECT_EQ(checker.check(message(named.config, 4)), Status::kInitial);
    EXPECT_EQ(checker.check(message(named.config, 10)), Status::kWrongSequence)
        << named.name << ": follows the old stray";
    EXPECT_EQ(checker.statistics().received, 4u);
    EXPECT_EQ(checker.config().profile, named.config.profile);
  }
}

TEST(Sequence, WrongDataIdIsCounted) {
  Config config;
  config.profile = Profile::kP04;
  config.data_id = 1;
  Config other = config;
  other.data_id = 2;
  Checker checker(config);
  EXPECT_EQ(checker.check(message(other, 0)), Status::kWrongDataId);
  EXPECT_EQ(checker.statistics().wrong_data_id, 1u);
  EXPECT_EQ(checker.statistics().accepted, 0u);
}

}  // namespace
}  // namespace boresight::e2e
