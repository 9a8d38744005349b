// load CONFIG OUT SECONDS: the load of a soak run. Writes the folder of configuration OUT/config with the vehicle
// `bench`, and OUT/radars.pcap, its radars on a crowded road at the speed of the scenario `straight_rail`.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "services/common/runtime/config/vehicle_file.hpp"
#include "services/simulator/scenario_file.hpp"
#include "tests/benchmarks/pipeline_latency/load/bench_vehicle.hpp"
#include "tests/benchmarks/pipeline_latency/load/recording.hpp"

int main(int argc, char** argv) {
  using namespace boresight;
  constexpr std::uint32_t kDetections = 800;  // of a scan: the capacity of the message and of the protocol
  if (argc != 4) {
    std::fprintf(stderr, "usage: load CONFIG OUT SECONDS\n");
    return 2;
  }
  try {
    const std::filesystem::path out = argv[2];
    const std::filesystem::path config = bench::write_bench_vehicle(argv[1], out / "config", bench::kMostRadars);
    const VehicleConfig vehicle = config::read_vehicle_file(config / "vehicle" / "bench.toml");
    const bench::CrowdedRoad road(simulator::scenario("straight_rail").ego.speed_mps.front().value, kDetections);
    bench::write_recording(road, vehicle, std::stod(argv[3]), out / "radars.pcap");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "load: %s\n", error.what());
    return 1;
  }
  return 0;
}
