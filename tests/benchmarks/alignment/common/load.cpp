#include "tests/benchmarks/alignment/common/load.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

namespace {

/// The simulated radars have at most so many detections per scan; scans with more are put together.
constexpr double kMostSimulated = 500.0;

void append(const alignment::ScanDetections& from, alignment::ScanDetections& to) {
  const std::size_t count = std::min(from.count, kMaxDetections - to.count);
  const auto copy = [&](const auto& source, auto& target) {
    std::copy_n(source.begin(), count, target.begin() + static_cast<std::ptrdiff_t>(to.count));
  };
  copy(from.range_m, to.range_m);
  copy(from.azimuth_rad, to.azimuth_rad);
  copy(from.elevation_rad, to.elevation_rad);
  copy(from.range_rate_mps, to.range_rate_mps);
  copy(from.azimuth_std_rad, to.azimuth_std_rad);
  copy(from.elevation_std_rad, to.elevation_std_rad);
  copy(from.range_rate_std_mps, to.range_rate_std_mps);
  to.count += count;
}

double thread_cpu_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Load::Load(std::size_t radars, double detections_per_scan, double seconds) : duration_ns_(std::llround(seconds * 1e9)) {
  simulator::AlignmentSpec spec = clean_drive(simulator::RoadKind::kMixed, seconds, 1);
  const auto four = spec.radars;
  const auto parts = static_cast<std::size_t>(std::ceil(detections_per_scan / kMostSimulated));
  spec.radars.clear();
  for (std::size_t i = 0; i < radars * parts; ++i) {
    const std::size_t radar = i / parts;
    spec.radars.push_back(four[radar % four.size()]);
    spec.radars.back().config.id = static_cast<std::uint32_t>(radar + 1);
    spec.radars.back().mean_detections = detections_per_scan / static_cast<double>(parts);
  }
  simulator::AlignmentDrive drive(spec);
  vehicle_ = drive.vehicle();
  for (std::size_t i = 0; i < radars; ++i) vehicle_.radars[i] = spec.radars[i * parts].config;
  vehicle_.radars.resize(radars);
  EgoHistory ego;
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      ego.add(*event.ego);
      continue;
    }
    const std::size_t radar = event.radar / parts;
    auto detections = std::make_unique_for_overwrite<alignment::ScanDetections>();
    alignment::take_detections(*event.scan, vehicle_.radars[radar], *detections);
    if (event.radar % parts != 0) {
      append(*detections, *entries_.back().detections);
      continue;
    }
    entries_.push_back({radar, ego.at(event.scan->header.measurement_time_ns), std::move(detections)});
  }
  // Whole cycles only, so that the last is followed by the first.
  entries_.resize(entries_.size() - entries_.size() % radars);
}

std::size_t Load::give_scan(alignment::Method& method) {
  Entry& entry = entries_[next_];
  method.process(entry.radar, *entry.detections, entry.ego);
  entry.detections->time_ns += duration_ns_;  // for the next repetition
  next_ = (next_ + 1) % entries_.size();
  return entry.detections->count;
}

std::size_t Load::give_cycle(alignment::Method& method) {
  std::size_t detections = 0;
  for (std::size_t i = 0; i < vehicle_.radars.size(); ++i) detections += give_scan(method);
  return detections;
}

void Load::warm_up(alignment::Method& method) {
  for (std::size_t i = 0; i < entries_.size() / vehicle_.radars.size(); ++i) give_cycle(method);
}

CycleCost measure_cycles(Load& load, alignment::Method& method, std::size_t cycles) {
  using Clock = std::chrono::steady_clock;
  load.warm_up(method);
  std::vector<double> each_us, each_ns;
  each_us.reserve(cycles);
  each_ns.reserve(cycles);
  const std::size_t before = runtime::counted_allocations();
  const double before_s = thread_cpu_s();
  for (std::size_t i = 0; i < cycles; ++i) {
    const runtime::CountAllocations counting;
    const auto begin = Clock::now();
    const std::size_t detections = load.give_cycle(method);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
    each_us.push_back(us);
    each_ns.push_back(1e3 * us / static_cast<double>(detections));
  }
  const double mean_us = 1e6 * (thread_cpu_s() - before_s) / static_cast<double>(cycles);
  return {median(each_us), median(each_ns), mean_us, runtime::counted_allocations() - before};
}

std::vector<double> call_times_ms(Load& load, alignment::Method& method, std::size_t cycles) {
  std::vector<double> each_ms(cycles * load.vehicle().radars.size());
  for (double& call_ms : each_ms) {
    const double begin_s = thread_cpu_s();
    load.give_scan(method);
    call_ms = 1e3 * (thread_cpu_s() - begin_s);
  }
  return each_ms;
}

std::size_t count_allocations(Load& load, alignment::Method& method, std::size_t cycles) {
  const std::size_t before = runtime::counted_allocations();
  const runtime::CountAllocations counting;
  for (std::size_t i = 0; i < cycles; ++i) load.give_cycle(method);
  return runtime::counted_allocations() - before;
}

}  // namespace boresight::bench
