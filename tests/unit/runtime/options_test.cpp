// Where the configuration and the vehicle file are found.
#include "services/common/runtime/options.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

namespace boresight::runtime {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OptionsTest : public ::testing::Test {
 protected:
  OptionsTest() {
    std::string name = (fs::temp_directory_path() / "boresight_options_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
    fs::create_directories(folder_ / "source/config/vehicle");
    fs::create_directories(folder_ / "source/config/services");
  }
  ~OptionsTest() override { fs::remove_all(folder_); }
  void make_build_tree(const fs::path& build, const std::string& source) const {
    fs::create_directories(build / "bin");
    std::ofstream(build / "CMakeCache.txt") << "# cache\nCMAKE_HOME_DIRECTORY:INTERNAL=" << source << "\n";
  }
  [[nodiscard]] Configuration configuration(const std::string& vehicle) const {
    return {folder_ / "source/config", vehicle, ""};
  }
  void make_vehicle(const std::string& name) const {
    std::ofstream(folder_ / "source/config/vehicle" / (name + ".toml")) << "name = \"" << name << "\"\n";
  }
  [[nodiscard]] std::string error_of(const std::string& vehicle) const {
    try {
      static_cast<void>(configuration(vehicle).vehicle_file());
    } catch (const config::Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(OptionsTest, BuildTreeUsesTheConfigurationOfItsSourceTree) {
  make_build_tree(folder_ / "source/build", "/absent");
  EXPECT_EQ(default_config_folder(folder_ / "source/build/bin"), folder_ / "source/config");
  make_build_tree(folder_ / "elsewhere", (folder_ / "source").string());
  EXPECT_EQ(default_config_folder(folder_ / "elsewhere/bin"), folder_ / "source/config");
}

TEST_F(OptionsTest, InstalledProgramUsesEtc) {
  fs::create_directories(folder_ / "source/bin");
  EXPECT_EQ(default_config_folder(folder_ / "source/bin"), "/etc/boresight") << "no build tree";
  make_build_tree(folder_ / "elsewhere", "/absent");
  EXPECT_EQ(default_config_folder(folder_ / "elsewhere/bin"), "/etc/boresight") << "no source tree";
}

TEST_F(OptionsTest, VehicleIsANameOrAFile) {
  make_vehicle("car");
  const fs::path file = folder_ / "source/config/vehicle/car.toml";
  EXPECT_EQ(configuration("car").vehicle_file(), file);
  EXPECT_EQ(configuration("").vehicle_file(), file) << "the only one";
  EXPECT_EQ(configuration(file.string()).vehicle_file(), file);
}

TEST_F(OptionsTest, RadarProfileIsANameInItsFolderOrAFile) {
  const Configuration c = configuration("");
  EXPECT_EQ(c.radar_profile_file("can_cluster"), folder_ / "source/config/radar_profiles/can_cluster.toml");
  EXPECT_EQ(c.radar_profile_file("mine.toml"), "mine.toml");
  EXPECT_EQ(c.radar_profile_file("./mine"), "./mine");
  EXPECT_EQ(c.radar_profile_file("/etc/mine.toml"), "/etc/mine.toml");
}

TEST_F(OptionsTest, StatisticsReplaceThoseOfEveryRadar) {
  Configuration c;
  c.directory = BORESIGHT_SOURCE_DIR "/config";
  c.vehicle_name = "demo";
  const VehicleConfig as_the_file_says = c.vehicle();
  c.statistics = "can_cluster";
  const VehicleConfig replaced = c.vehicle();
  ASSERT_FALSE(replaced.radars.empty());
  ASSERT_EQ(replaced.radars.size(), as_the_file_says.radars.size());
  for (std::size_t i = 0; i < replaced.radars.size(); ++i) {
    EXPECT_NE(as_the_file_says.radars[i].statistics, "can_cluster");
    EXPECT_EQ(replaced.radars[i].statistics, "can_cluster");
    EXPECT_EQ(replaced.radars[i].id, as_the_file_says.radars[i].id);
  }
}

TEST_F(OptionsTest, EachShippedVehicleNamesProfilesThatThereAre) {
  Configuration c;
  c.directory = BORESIGHT_SOURCE_DIR "/config";
  for (const auto& file : fs::directory_iterator(c.directory / "vehicle")) {
    c.vehicle_name = file.path().string();
    for (const RadarConfig& radar : c.vehicle(config::VehicleUse::kOffline).radars) {
      EXPECT_TRUE(fs::is_regular_file(c.radar_profile_file(radar.statistics))) << file.path() << ' ' << radar.name;
    }
  }
}

TEST_F(OptionsTest, UnknownVehicleIsReportedWithTheKnownNamesAndTheFolder) {
  make_vehicle("car");
  make_vehicle("truck");
  EXPECT_THAT(error_of("truk"), HasSubstr("no vehicle 'truk' in " + (folder_ / "source/config/vehicle").string()));
  EXPECT_THAT(error_of("truk"), HasSubstr("did you mean 'truck'?"));
  EXPECT_THAT(error_of("truk"), HasSubstr("names there: car, truck"));
  EXPECT_EQ(error_of("./absent.toml"), "--vehicle ./absent.toml: no such file");
}

TEST_F(OptionsTest, WithoutANameTheChosenVehicleIsTaken) {
  EXPECT_THAT(error_of(""), HasSubstr("source/config/vehicle: holds no vehicle; choose one by 'boresight vehicle use"));
  make_vehicle("car");
  make_vehicle("truck");
  EXPECT_THAT(error_of(""), HasSubstr("several vehicles, and none is chosen; choose one by 'boresight vehicle use"));
  EXPECT_THAT(error_of(""), HasSubstr(": car, truck"));
  choose_vehicle(folder_ / "source/config", "truck");
  EXPECT_EQ(configuration("").vehicle_file(), folder_ / "source/config/vehicle/truck.toml");
  choose_vehicle(folder_ / "source/config", "car");
  EXPECT_EQ(configuration("").vehicle_file(), folder_ / "source/config/vehicle/car.toml");
  EXPECT_EQ(configuration("truck").vehicle_file(), folder_ / "source/config/vehicle/truck.toml")
      << "a name overrides it";
  fs::remove(folder_ / "source/config/vehicle/car.toml");
  EXPECT_THAT(error_of(""), HasSubstr("vehicle/car.toml does not exist; choose one by")) << "no other is taken instead";
}

TEST_F(OptionsTest, AFileThatIsNoChoiceIsNotReplacedByOne) {
  std::ofstream(folder_ / "source/config/vehicle.toml") << "mine\n";
  EXPECT_THROW(choose_vehicle(folder_ / "source/config", "car"), std::runtime_error);
  EXPECT_FALSE(fs::is_symlink(folder_ / "source/config/vehicle.toml"));
}

TEST_F(OptionsTest, ExamplesHaveNamesForInstalledToolsOnly) {
  fs::create_directories(folder_ / "usr/share/boresight/vehicle");
  std::ofstream(folder_ / "usr/share/boresight/vehicle/example.toml") << "name = \"example\"\n";
  EXPECT_EQ(example_vehicle_folder(folder_ / "usr/bin"), folder_ / "usr/share/boresight/vehicle");
  EXPECT_EQ(example_vehicle_folder(folder_ / "usr/lib/boresight"), "") << "a service";
  EXPECT_EQ(example_vehicle_folder(folder_ / "source/build/bin"), "") << "a build tree";
  make_vehicle("car");
  Configuration c = configuration("example");
  EXPECT_THROW(static_cast<void>(c.vehicle_file()), config::Error);
  c.examples = example_vehicle_folder(folder_ / "usr/bin");
  EXPECT_EQ(c.vehicle_file(), c.examples / "example.toml");
  c.vehicle_name = "car";
  EXPECT_EQ(c.vehicle_file(), folder_ / "source/config/vehicle/car.toml");
  c.vehicle_name = "";
  EXPECT_EQ(c.vehicle_file(), folder_ / "source/config/vehicle/car.toml") << "no example is taken without its name";
}

}  // namespace
}  // namespace boresight::runtime
