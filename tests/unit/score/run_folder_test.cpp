// Files of a run folder that cannot be read are refused with the place and the allowed values.
#include "services/boresight/score/run_folder.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/score/made_run.hpp"

namespace boresight::score {
namespace {

using testing::HasSubstr;

std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RunFolder, TimesWhoseDifferencesDoNotFitAreRefused) {
  const made::fs::path folder = made::folder("run_folder_times");
  const auto scans_with = [&](const std::string& time_ns) {
    made::write_file(folder / "scans.csv", "t_s,time_ns,radar,scan,detections,tracks\n0," + time_ns + ",1,1,0,0\n");
    return refusal_of([&] {
      RunScan scan;
      EXPECT_TRUE(RunScans(folder).next(scan));
    });
  };
  const auto health_with = [&](const std::string& time_ns) {
    made::write_file(folder / "health.jsonl", R"({"t_s":0,"time_ns":)" + time_ns + R"(,"radars":[]})");
    return refusal_of([&] {
      RunVerdicts verdicts;
      EXPECT_TRUE(RunHealth(folder).next(verdicts));
    });
  };
  for (const char* const allowed : {"-4000000000000000000", "0", "4000000000000000000"}) {
    EXPECT_EQ(scans_with(allowed), "");
    EXPECT_EQ(health_with(allowed), "");
  }
  for (const char* const refused : {"-9223372036854775808", "-4000000000000000001", "4000000000000000001"}) {
    EXPECT_THAT(scans_with(refused), HasSubstr("scans.csv:2: time_ns: read \"" + std::string(refused) +
                                               "\", allowed is a whole number -4000000000000000000 … "));
  }
  for (const char* const refused : {"-9223372036854775808", "18446744073709551615"}) {
    EXPECT_THAT(health_with(refused), HasSubstr("health.jsonl:1: time_ns: allowed is -4000000000000000000 … "));
  }
}

TEST(RunFolder, ATrackWhoseCovarianceIsNoNumberIsRefused) {
  const made::fs::path folder = made::folder("run_folder_covariance");
  made::write_run(folder, 1, 0.0);
  for (const char* const cells : {"x,0,0.04", "0.04,x,0.04", "0.04,0,x"}) {
    made::write_file(folder / "tracks.csv",
                     made::kTrackHeader +
                         "0,1700000000000000000,1,1,7,confirmed,measured,moving,car,0.99,1,0,20,2,0,"
                         "11,0,0,4.5,1.8,1.5,2," +
                         cells + "\n");
    EXPECT_THAT(refusal_of([&] {
                  RunScan scan;
                  std::vector<judge::ScoredTrack> tracks;
                  EXPECT_TRUE(RunScans(folder).next(scan));
                  RunTracks(folder).take(scan, tracks);
                }),
                HasSubstr("read \"x\", allowed is a number"))
        << cells;
  }
}

}  // namespace
}  // namespace boresight::score
