#include "tests/benchmarks/alignment/common/load.hpp"

#include <chrono>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/statistics.hpp"

namespace boresight::bench {

Load::Load(std::size_t radars, double detections_per_scan, double seconds) : duration_ns_(std::llround(seconds * 1e9)) {
  simulator::AlignmentSpec spec = clean_drive(simulator::RoadKind::kMixed, seconds, 1);
  const auto four = spec.radars;
  spec.radars.clear();
  for (std::size_t i = 0; i < radars; ++i) {
    spec.radars.push_back(four[i % four.size()]);
    spec.radars.back().config.id = static_cast<std::uint32_t>(i + 1);
    spec.radars.back().mean_detections = detections_per_scan;
  }
  simulator::AlignmentDrive drive(spec);
  vehicle_ = drive.vehicle();
  EgoHistory ego;
  simulator::AlignmentEvent event;
  while (drive.next(event)) {
    if (event.ego != nullptr) {
      ego.add(*event.ego);
      continue;
    }
    auto detections = std::make_unique_for_overwrite<alignment::ScanDetections>();
    alignment::take_detections(*event.scan, vehicle_.radars[event.radar], *detections);
    entries_.push_back({event.radar, ego.at(event.scan->header.measurement_time_ns), std::move(detections)});
  }
  // Whole cycles only, so that the last is followed by the first.
  entries_.resize(entries_.size() - entries_.size() % radars);
}

std::size_t Load::give_cycle(alignment::Method& method) {
  std::size_t detections = 0;
  for (std::size_t i = 0; i < vehicle_.radars.size(); ++i) {
    Entry& entry = entries_[next_];
    method.process(entry.radar, *entry.detections, entry.ego);
    detections += entry.detections->count;
    entry.detections->time_ns += duration_ns_;  // for the next repetition
    next_ = (next_ + 1) % entries_.size();
  }
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
  for (std::size_t i = 0; i < cycles; ++i) {
    const runtime::CountAllocations counting;
    const auto begin = Clock::now();
    const std::size_t detections = load.give_cycle(method);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
    each_us.push_back(us);
    each_ns.push_back(1e3 * us / static_cast<double>(detections));
  }
  return {median(each_us), median(each_ns), runtime::counted_allocations() - before};
}

std::size_t count_allocations(Load& load, alignment::Method& method, std::size_t cycles) {
  const std::size_t before = runtime::counted_allocations();
  const runtime::CountAllocations counting;
  for (std::size_t i = 0; i < cycles; ++i) load.give_cycle(method);
  return runtime::counted_allocations() - before;
}

}  // namespace boresight::bench
