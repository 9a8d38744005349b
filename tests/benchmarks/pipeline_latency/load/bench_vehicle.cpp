#include "tests/benchmarks/pipeline_latency/load/bench_vehicle.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace boresight::bench {

namespace {

namespace fs = std::filesystem;

const std::string kRadarTable = "[[radar]]";
constexpr unsigned kDemoRadars = 4;

struct Place {
  const char* name;
  double x_m, y_m, yaw_deg;
};
/// Of the radars beyond those of the demo vehicle, m and degrees in the vehicle frame. They look along the road, as the
/// crowded road has ten vehicles in such a view only.
constexpr std::array<Place, kMostRadars - kDemoRadars> kPlaces = {{{"front", 3.75, 0.0, 0.0},
                                                                   {"rear", -0.95, 0.0, 180.0},
                                                                   {"front_left_inner", 3.7, 0.5, 20.0},
                                                                   {"front_right_inner", 3.7, -0.5, -20.0}}};

/// The table of `like` with the values of another radar.
std::string table_of(const std::string& like, unsigned id) {
  const Place& place = kPlaces[id - kDemoRadars - 1];
  std::string table;
  for (std::size_t begin = 0, end = 0; begin < like.size(); begin = end + 1) {
    end = std::min(like.find('\n', begin), like.size());
    std::string line = like.substr(begin, end - begin);
    if (line.starts_with("id ")) line = "id = " + std::to_string(id);
    if (line.starts_with("name ")) line = std::string("name = \"") + place.name + "\"";
    if (line.starts_with("source ")) {
      const std::size_t last_byte = line.rfind('.') + 1;
      line = line.substr(0, last_byte) + std::to_string(112 + id) + "\"}";
    }
    if (line.starts_with("mounting_pose ")) {
      line = "mounting_pose = {position_m = [" + std::to_string(place.x_m) + ", " + std::to_string(place.y_m) +
             ", 0.6], yaw_deg = " + std::to_string(place.yaw_deg) + "}";
    }
    table += line + "\n";
  }
  return table;
}

}  // namespace

fs::path write_bench_vehicle(const fs::path& shipped, const fs::path& to, unsigned radars) {
  if (radars < 1 || radars > kMostRadars) throw std::invalid_argument("1 to 8 radars");
  fs::create_directories(to / "vehicle");
  for (const char* const folder : {"services", "radar_profiles"}) {
    fs::copy(shipped / folder, to / folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  std::ifstream file(shipped / "vehicle" / "demo.toml");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  text.replace(text.find("name = \"demo\""), sizeof("name = \"demo\"") - 1, "name = \"bench\"");
  std::size_t end = 0;
  std::string first;
  for (unsigned id = 1; id <= kDemoRadars; ++id) {
    const std::size_t begin = text.find(kRadarTable, end);
    if (id > radars) {
      text.resize(begin);
      break;
    }
    end = std::min(text.find(kRadarTable, begin + 1), text.size());
    if (id == 1) first = text.substr(begin, end - begin);
  }
  for (unsigned id = kDemoRadars + 1; id <= radars; ++id) text += "\n" + table_of(first, id);
  std::ofstream(to / "vehicle" / "bench.toml") << text;
  return to;
}

}  // namespace boresight::bench
