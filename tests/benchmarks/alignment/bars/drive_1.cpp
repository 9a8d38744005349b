// A three-minute drive of four radars, recorded by another simulator, through every method as `boresight align` runs
// it.
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "services/boresight/align/run.hpp"
#include "services/boresight/align/truth_file.hpp"
#include "services/boresight/input/drive_csv.hpp"
#include "services/boresight/input/ego_csv.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/bars/bars.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/parallel.hpp"

namespace boresight::bench {

namespace {

namespace fs = std::filesystem;

/// The unpacked table; removed by the destructor.
class Unpacked {
 public:
  explicit Unpacked(const fs::path& packed) {
    std::string name = fs::temp_directory_path() / "boresight_bench_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    folder_ = name;
    const std::string command = "xz -dc '" + packed.string() + "' > '" + table().string() + "'";
    if (std::system(command.c_str()) != 0) {
      fs::remove_all(folder_);
      throw std::runtime_error("xz cannot unpack " + packed.string());
    }
  }
  ~Unpacked() { fs::remove_all(folder_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;
  [[nodiscard]] fs::path table() const { return folder_ / "drive.csv"; }

 private:
  fs::path folder_;
};

std::int64_t cpu_time_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

align::Result align_drive(const std::string& method, const fs::path& table, const fs::path& folder) {
  // The recording's radars are the simulator's four corner radars without stated stds.
  const VehicleConfig vehicle = simulator::AlignmentDrive(simulator::four_corner_radars()).vehicle();
  std::ifstream truth(folder / "truth_1.txt");
  input::Problems problems([](const std::string& problem) { throw std::runtime_error(problem); });
  recording::ByteSource ego_source(folder / "ego_1.csv"), drive_source(table);
  input::EgoReader ego(ego_source, vehicle.ego, problems);
  input::DriveReader drive(drive_source, vehicle, problems);
  const auto scan = std::make_unique<RadarScan>();
  EgoMotion motion{};
  double motion_s = 0.0, scan_s = 0.0;
  bool has_motion = ego.next(motion, motion_s);
  align::Run::Options options;
  options.method = method;
  options.truth = align::read_truth(truth, "truth_1.txt");
  options.cpu_time_ns = cpu_time_ns;
  align::Run run(vehicle, std::move(options));
  while (drive.next(*scan, scan_s)) {
    for (; has_motion && motion_s <= scan_s; has_motion = ego.next(motion, motion_s)) run.add_ego(motion, motion_s);
    run.add_scan(*scan, scan_s);
  }
  return run.finish();
}

/// Largest absolute value of `of` over the radars.
template <typename Of>
double largest(const align::Result& result, Of&& of) {
  double value = 0.0;
  for (const align::RadarResult& radar : result.radars) value = std::max(value, std::abs(of(radar)));
  return value;
}

}  // namespace

void drive_1(const Options& options, Report& report) {
  if (options.data_folder.empty()) return;
  const fs::path folder = options.data_folder;
  const Unpacked unpacked(folder / "drive_1.csv.xz");
  const std::vector<std::string> methods =
      options.quick ? std::vector<std::string>{"boresight"} : align::method_names();
  std::vector<align::Result> results(methods.size());
  parallel_for(methods.size(), options.jobs,
               [&](std::size_t i) { results[i] = align_drive(methods[i], unpacked.table(), folder); });
  Table table{"drive_1",
              "drive_1: errors after 180 s about the vehicle's axes, worst radar",
              {"method", "k_v", "yaw °", "pitch °", "roll front / rear °", "seconds to 95 %, permanently, yaw / pitch",
               "RMSE m/s", "µs per scan"},
              {}};
  constexpr std::size_t kYawPlace = 1, kPitchPlace = 2, kRollPlace = 3;  // as in align::Sample
  for (const align::Result& result : results) {
    const auto error = [&](std::size_t place) {
      return largest(result, [&](const align::RadarResult& radar) { return radar.truth->errors[place]; });
    };
    const auto seconds = [&](std::size_t place) {
      double worst = 0.0;
      for (const align::RadarResult& radar : result.radars) {
        // 5 % of an initial error below half a degree disappears in the noise.
        if (std::abs(radar.truth->mountings.front().values[place]) < 0.5 * kRadiansPerDegree) continue;
        const double s = radar.truth->seconds_to_95_percent[place];
        worst = std::isnan(s) ? std::numeric_limits<double>::infinity() : std::max(worst, s);
      }
      return worst;
    };
    const auto roll_of = [&](std::size_t first) {
      return std::max(std::abs(result.radars[first].truth->errors[kRollPlace]),
                      std::abs(result.radars[first + 1].truth->errors[kRollPlace])) /
             kRadiansPerDegree;
    };
    const double speed_scale = error(0), yaw = error(kYawPlace) / kRadiansPerDegree,
                 pitch = error(kPitchPlace) / kRadiansPerDegree;
    table.rows.push_back(
        {result.method, number(speed_scale), number(yaw), number(pitch),
         number(roll_of(0)) + " / " + number(roll_of(2)),
         number(seconds(kYawPlace)) + " / " + number(seconds(kPitchPlace)),
         fixed(largest(result, [](const align::RadarResult& radar) { return radar.residuals.after.rmse_mps; }), 4),
         number(result.radars.front().cpu_us_per_scan)});
    if (result.method != "boresight") continue;
    const std::string how = "worst of four radars after 180 s of one recorded drive";
    report.at_most("drive_1", "k_v", speed_scale, 5e-5, "", how);
    report.at_most("drive_1", "yaw", yaw, 0.005, "°", how);
    report.at_most("drive_1", "pitch", pitch, 0.03, "°", how);
  }
  report.add(std::move(table));
}

}  // namespace boresight::bench
