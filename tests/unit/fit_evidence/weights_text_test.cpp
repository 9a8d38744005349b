// The table [evidence] of a radar profile, written and read.
#include "services/boresight/fit_evidence/weights_text.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/ghost_filter/weights_file.hpp"

namespace boresight::fit_evidence {
namespace {

using namespace ghosts;
using testing::AllOf;
using testing::HasSubstr;

/// Weights of which each is another number, with more digits than the file has.
EvidenceWeights written_weights() {
  EvidenceWeights w;
  w.prior_log_odds = -1.2345;
  double next = -3.0;
  const auto number = [&next] { return next += 0.0567; };
  for (const auto& [each, kinds] :
       {std::pair(&w.alone, kScanEvidences), std::pair(&w.ratio, kEvidences), std::pair(&w.with_tracks, kEvidences)}) {
    each->constant = number();
    for (std::size_t k = 0; k < kinds; ++k) {
      for (std::size_t level = 0; level < kEvidenceSpecs[k].levels; ++level) each->of[k][level] = number();
    }
  }
  for (double& weight : w.track_unsure) weight = number();
  for (double& weight : w.track_sure) weight = number();
  return w;
}

std::string written() {
  return weights_text(written_weights(), "7 drives");
}

EvidenceWeights read_text(const std::string& text) {
  return read_weights(config::Reader::parse(text, "radar.toml"));
}

std::string problems_of(const std::string& text) {
  try {
    static_cast<void>(read_text(text));
  } catch (const config::Error& error) {
    return error.what();
  }
  return "";
}

/// The text with one line in place of that which begins so; without it, if `line` is empty.
std::string with_line(const std::string& beginning, const std::string& line) {
  std::string text = written();
  const std::size_t at = text.find("\n" + beginning);
  EXPECT_NE(at, std::string::npos) << beginning;
  return text.replace(at + 1, text.find('\n', at + 1) - at - 1, line);
}

TEST(WeightsFile, ReadsWhatItWrites) {
  const EvidenceWeights w = written_weights(), read = read_text(written());
  constexpr double kRounding = 0.00501;
  EXPECT_NEAR(read.prior_log_odds, w.prior_log_odds, kRounding);
  const auto expect_equal = [&](const LevelWeights& a, const LevelWeights& b) {
    EXPECT_NEAR(a.constant, b.constant, kRounding);
    for (std::size_t k = 0; k < kEvidences; ++k) {
      for (std::size_t level = 0; level < kMostLevels; ++level) EXPECT_NEAR(a.of[k][level], b.of[k][level], kRounding);
    }
  };
  expect_equal(read.alone, w.alone);
  expect_equal(read.ratio, w.ratio);
  expect_equal(read.with_tracks, w.with_tracks);
  for (std::size_t level = 0; level < kTrackLevels; ++level) {
    EXPECT_NEAR(read.track_unsure[level], w.track_unsure[level], kRounding);
    EXPECT_NEAR(read.track_sure[level], w.track_sure[level], kRounding);
  }
}

TEST(WeightsFile, WrittenAgainIsTheSameText) {
  EXPECT_EQ(weights_text(read_text(written()), "7 drives"), written());
}

TEST(WeightsFile, AnOriginMayHoldAnyText) {
  const std::string text = weights_text(written_weights(), "drives \"a\\b\"\nand c");
  EXPECT_EQ(problems_of(text), "");
  EXPECT_THAT(text, HasSubstr(R"(origin = "drives \"a\\b\"?and c")"));
}

TEST(WithWeights, ReplaceTheTableAndKeepAllElse) {
  const std::string before = "name = \"a\"  # [evidence]\n\n[noise]\nlist = [\n[1, 2],\n]\n\n# fitted\n";
  const std::string after = "\n# of the next table\n[ strength ]\non = true\n";
  const std::string old = weights_text({}, "old drives");
  for (const std::string& table :
       {old, "[ evidence ]\n" + old.substr(old.find('\n') + 1), old + "# a comment of the table\nnew_key = 1\n"}) {
    EXPECT_EQ(with_weights(before + table + after, written(), "radar.toml"), before + written() + after) << table;
  }
  // A part of the table elsewhere.
  const std::size_t with_tracks = old.find("[evidence.with_tracks]");
  EXPECT_EQ(
      with_weights(before + old.substr(0, with_tracks) + after + old.substr(with_tracks), written(), "radar.toml"),
      before + written() + "\n" + after);
  EXPECT_EQ(with_weights(written(), written(), "radar.toml"), written());
}

TEST(WithWeights, AreAddedToAProfileWithoutThem) {
  const std::string profile = "name = \"a\"\n[evidence_of_mirrors]\non = true";
  EXPECT_EQ(with_weights(profile, written(), "radar.toml"), profile + "\n\n# Weights of the evidence\n" + written());
}

TEST(WithWeights, AProfileThatKeepsOtherWeightsIsRefused) {
  const auto problem_of = [](const std::string& profile) -> std::string {
    try {
      static_cast<void>(with_weights(profile, written(), "radar.toml"));
    } catch (const config::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(problem_of("evidence = {origin = \"a\"}\n"), HasSubstr("radar.toml"));
  EXPECT_THAT(problem_of("evidence.alone.constant = 1.0\n"), HasSubstr("radar.toml"));
  EXPECT_THAT(problem_of("name = \n"), HasSubstr("radar.toml"));
}

TEST(WeightsFile, AProfileWithoutTheTableIsRefused) {
  EXPECT_THAT(problems_of("about = \"a radar\"\n[noise]\nrange_m = 0.1\n"),
              AllOf(HasSubstr("radar.toml:1"), HasSubstr("evidence"), HasSubstr("missing")));
}

TEST(WeightsFile, TheSimulatorsTablesAreNotRead) {
  EXPECT_EQ(problems_of("about = 3\n[noise]\nanything = \"at all\"\n" + written()), "");
}

TEST(WeightsFile, AnErrorNamesFileLineAndKey) {
  // Line 6 is that of the first list.
  ASSERT_EQ(written().find("\n\n[evidence.alone]\nconstant = "), written().find("\n\n"));
  struct Case {
    const char* beginning;
    const char* line;
    const char* key;
    const char* problem;
  };
  for (const Case& c : {Case{"past = ", "", "evidence.alone.past", "missing"},
                        Case{"constant = ", "", "evidence.alone.constant", "missing"},
                        Case{"prior_log_odds = ", "", "evidence.prior_log_odds", "missing"},
                        Case{"origin = ", "", "evidence.origin", "missing"},
                        Case{"track_sure = ", "", "evidence.with_tracks.track_sure", "missing"},
                        Case{"past = ", "past = [1, 2, 3]", "evidence.alone.past", "has 3 elements"},
                        Case{"past = ", "past = 3.0", "evidence.alone.past", "array of 6 numbers"},
                        Case{"past = ", "past = [0, 0, 0, 0, 0, 51]", "evidence.alone.past", "-50 … 50"},
                        Case{"past = ", "past = [0, 0, nan, 0, 0, 1]", "evidence.alone.past", "-50 … 50"},
                        Case{"constant = ", "constant = -1e3", "evidence.alone.constant", "-50 … 50"},
                        Case{"ring = ", "rings = [0, 0, 0, 0]", "evidence.alone.rings", "unknown key"}}) {
    const std::string problems = problems_of(with_line(c.beginning, c.line));
    EXPECT_THAT(problems, AllOf(HasSubstr("radar.toml:"), HasSubstr(std::string(c.key) + ":"), HasSubstr(c.problem)))
        << c.beginning << c.line;
  }
  EXPECT_THAT(problems_of(with_line("past = ", "past = [1, 2, 3]")), HasSubstr("radar.toml:7: evidence.alone.past"));
  EXPECT_THAT(problems_of(with_line("prior_log_odds = ", "prior_log_odds = 0.1\nposterior = 2.0")),
              HasSubstr("radar.toml:4: evidence.posterior: unknown key"));
}

TEST(WeightsFile, EachShippedProfileHasWeights) {
  const std::filesystem::path folder = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/radar_profiles";
  std::size_t profiles = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".toml") continue;
    ++profiles;
    const EvidenceWeights w = read_weights(file.path());
    const auto past = static_cast<std::size_t>(EvidenceKind::kPast);
    EXPECT_GT(w.alone.of[past][5], w.alone.of[past][0]) << file.path() << ": what lasts is likelier real";
    EXPECT_GT(w.track_sure[kTrackLevels - 1], w.track_sure[0]) << file.path();
    const auto verdict = static_cast<std::size_t>(EvidenceKind::kVerdict);
    for (const std::size_t doubted : {2U, 3U}) EXPECT_LT(w.alone.of[verdict][doubted], 0.0) << file.path();
  }
  EXPECT_EQ(profiles, 3U);
}

TEST(WeightsFile, AFileThatIsAbsentIsAnErrorWithItsName) {
  try {
    static_cast<void>(read_weights(std::filesystem::path("/nowhere/radar.toml")));
    FAIL();
  } catch (const config::Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/radar.toml"));
  }
}

}  // namespace
}  // namespace boresight::fit_evidence
