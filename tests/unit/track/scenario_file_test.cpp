#include "services/boresight/track/scenario_file.hpp"

#include <string>

#include <gmock/gmock.h>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/config/reader.hpp"
#include "tests/unit/track/files.hpp"

namespace boresight::track {
namespace {

using ::testing::HasSubstr;

class ScenarioFiles : public ::testing::Test {
 protected:
  testing::Files files_{"track_scenario"};

  ScenarioFile read(std::string_view text) { return read_scenario_file(files_.write("params.txt", text)); }
  /// The error without the folder of the file.
  std::string error_of(std::string_view text) {
    try {
      (void)read(text);
    } catch (const config::Error& error) {
      std::string what = error.what();
      const std::string folder = files_.path("").string();
      for (std::size_t at = what.find(folder); at != std::string::npos; at = what.find(folder)) {
        what.erase(at, folder.size());
      }
      return what;
    }
    return "no error";
  }
  /// The parameters with one line replaced; an empty replacement removes the line.
  static std::string with(const std::string& key, const std::string& line) {
    std::string text(testing::kParameters);
    const std::size_t begin = text.find("\n" + key + " =") + 1;
    return text.replace(begin, text.find('\n', begin) + 1 - begin, line.empty() ? "" : line + "\n");
  }
};

TEST_F(ScenarioFiles, EveryParameterReachesTheModel) {
  const ScenarioFile file = read(testing::kParameters);
  EXPECT_EQ(file.number_of_scans, 3U);
  const tracking::LinearScenario& model = file.model;
  EXPECT_EQ(model.survival_probability, 0.99);
  EXPECT_EQ(model.step_s, 0.1);
  EXPECT_EQ(model.acceleration_density, 2.0);
  EXPECT_EQ(model.rate_forgetting, 1.1);
  EXPECT_EQ(model.extent_memory_s, 5.0);
  EXPECT_EQ(model.detection_probability, 0.9);
  EXPECT_EQ(model.spread, 0.25);
  EXPECT_EQ(model.noise_variance_m2, 0.09);
  EXPECT_EQ(model.range_rate_std_mps, 0.0);
  EXPECT_EQ(model.clutter_per_scan, 15.0);
  EXPECT_EQ(model.area_min_m, Eigen::Vector2d(-80.0, -25.0));
  EXPECT_EQ(model.area_max_m, Eigen::Vector2d(120.0, 25.0));
  EXPECT_EQ(model.birth_weight, 0.02);
  ASSERT_EQ(model.births.size(), 2U);
  EXPECT_EQ(model.births[0].mean, Eigen::Vector4d(80.0, -2.0, -3.0, 0.0));
  EXPECT_EQ(model.births[1].mean, Eigen::Vector4d(-15.0, 0.5, 4.0, 1.0));
  for (const tracking::ScenarioBirth& birth : model.births) {
    EXPECT_EQ(birth.std, Eigen::Vector4d(15.0, 5.0, 6.0, 1.5));
    EXPECT_EQ(birth.extent_scale, (Eigen::Matrix2d() << 49.0, 2.0, 2.0, 16.8).finished());
    EXPECT_EQ(birth.extent_dof, 20.0);
    EXPECT_EQ(birth.rate_shape, 16.0);
    EXPECT_EQ(birth.rate_inverse_scale, 2.0);
  }
}

TEST_F(ScenarioFiles, RangeRatesNeedTheirStdAndTheSpanOfClutter) {
  const tracking::LinearScenario model =
      read(std::string(testing::kParameters) + "range_rate_std = 0.1\nrange_rate_span = 40\n").model;
  EXPECT_EQ(model.range_rate_std_mps, 0.1);
  EXPECT_EQ(model.clutter_range_rate_span_mps, 40.0);
  EXPECT_THAT(error_of(std::string(testing::kParameters) + "range_rate_std = 0.1\n"),
              HasSubstr("params.txt:25: range_rate_std: range_rate_std and range_rate_span"));
}

TEST_F(ScenarioFiles, ErrorsNameLineKeyAndAllowedRange) {
  EXPECT_EQ(error_of(with("Ps", "Ps = 1.2")), "params.txt:2: Ps: read \"1.2\", allowed is a number 0 … 1");
  EXPECT_EQ(error_of(with("q", "q = nan")), "params.txt:4: q: read \"nan\", allowed is a number 0 … 1e+06");
  EXPECT_EQ(error_of(with("birth_v", "birth_v = 6")),
            "params.txt:11: birth_v: read \"6\", allowed is a number 7 … 1e+06");
  EXPECT_EQ(error_of(with("birth_std", "birth_std = [15 5 6]")),
            "params.txt:9: birth_std: read \"[15 5 6]\", allowed is a matrix of 1 rows and 4 columns, each number "
            "1e-06 … 1e+06");
  EXPECT_THAT(error_of(with("birth_xr", "birth_xr = [80 80;-2 2;-3;0 0]")), HasSubstr("params.txt:8: birth_xr: read"));
  EXPECT_THAT(error_of(with("birth_xr", "birth_xr = []")), HasSubstr("params.txt:8: birth_xr: read \"[]\""));
  EXPECT_THAT(error_of(with("Ch", "Ch = 0.25x")), HasSubstr("params.txt:14: Ch: read \"0.25x\""));
  EXPECT_THAT(error_of(with("Ch", "Ch 0.25")), HasSubstr("params.txt:14: read \"Ch 0.25\", allowed is KEY = VALUE"));
}

TEST_F(ScenarioFiles, ErrorsBetweenNumbersAreFound) {
  EXPECT_EQ(error_of(with("range_y", "range_y = [25 -25]")),
            "params.txt:18: range_y: read [25 -25], allowed is the smaller limit first");
  EXPECT_THAT(error_of(with("birth_V", "birth_V = [1 2;2 1]")), HasSubstr("params.txt:10: birth_V: allowed is a sym"));
  EXPECT_THAT(error_of(with("T", "T = 2.5")), HasSubstr("params.txt:22: T: read 2.5, allowed is a whole number"));
}

TEST_F(ScenarioFiles, UnknownRepeatedAndMissingKeysAreReportedTogether) {
  EXPECT_EQ(error_of(with("Pd", "Pdd = 0.9")),
            "params.txt:16: unknown key \"Pdd\"; did you mean 'Pd'?\n"
            "params.txt: Pd: is missing; allowed is a number 0.001 … 1");
  EXPECT_THAT(error_of(with("seed", "seed = 11\nnovelty = 1")), HasSubstr("known keys: Ps, Ts, "));
  EXPECT_EQ(error_of(std::string(testing::kParameters) + "tau = 6\n"),
            "params.txt:25: tau: is given twice, first on line 6");
}

TEST_F(ScenarioFiles, AbsentFileIsNamed) {
  EXPECT_THROW((void)read_scenario_file(files_.path("absent.txt")), recording::OpenError);
}

}  // namespace
}  // namespace boresight::track
