#include "services/health/core/faults/fault_memory.hpp"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/state/frame.hpp"
#include "services/health/core/faults/codec.hpp"

namespace boresight::health {
namespace {

using namespace dtc_status;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

VehicleConfig vehicle_of(std::initializer_list<std::uint32_t> ids) {
  VehicleConfig vehicle;
  for (const std::uint32_t id : ids) {
    RadarConfig radar;
    radar.id = id;
    vehicle.radars.push_back(radar);
  }
  return vehicle;
}

/// Without debouncing.
FaultMemoryConfig immediate() {
  FaultMemoryConfig config;
  config.debounce = {};
  return config;
}

FreezeFrame frame_at(float speed_mps) {
  FreezeFrame frame;
  frame.time_ns = 1'700'000'000 * kSecond_ns;
  frame.uptime_ns = 5;
  frame.cycle = 2;
  frame.speed_mps = speed_mps;
  frame.estimate = {1.01F, 0.04F, -0.01F, 0.02F};
  for (std::size_t i = 0; i < frame.covariance.size(); ++i) frame.covariance[i] = static_cast<float>(i) * 1e-3F;
  frame.configuration = 0x0123456789ABCDEF;
  frame.software = {'1', '.', '2'};
  return frame;
}

constexpr Event kNoDataOf2{kind_of(RadarEvent::kNoData), 2};
constexpr Event kYawOf16{kind_of(RadarEvent::kYawMisaligned), 16};

TEST(TroubleCodes, AreUniqueOverAllSubjectsAndReadBack) {
  std::set<std::uint32_t> codes;
  for (const EventType& type : event_types()) {
    const std::size_t first = type.subject == Subject::kRadar ? 1 : 0;
    for (std::size_t i = 0; i < subjects_of(type.subject); ++i) {
      const Event event{type.kind, static_cast<std::uint8_t>(first + i)};
      const std::uint32_t dtc = dtc_of(event);
      EXPECT_TRUE(codes.insert(dtc).second) << code_text(dtc);
      EXPECT_EQ(event_of(dtc), event) << code_text(dtc);
      EXPECT_EQ(dtc_from_text(code_text(dtc)), dtc);
    }
  }
}

TEST(TroubleCodes, AreWrittenAsTheStandardsDo) {
  EXPECT_EQ(code_text(dtc_of({kind_of(RadarEvent::kYawMisaligned), 2})), "C1D02-78");
  EXPECT_EQ(code_text(dtc_of({EventKind::kServiceSilent, 4})), "U1A04-87");
  EXPECT_EQ(dtc_from_text("c1d02-78"), dtc_from_text("C1D02-78"));
  for (const char* const wrong :
       {"", "C1D02", "C1D02-7", "X1D02-78", "C1D0G-78", "C1D02+78", "C7D02-78", "C1D02-788"}) {
    EXPECT_FALSE(dtc_from_text(wrong)) << wrong;
  }
  EXPECT_FALSE(event_of(dtc_of({kind_of(RadarEvent::kNoData), 0}))) << "radar ids begin at 1";
  EXPECT_FALSE(event_of(0xFFFFFF));
}

TEST(FaultMemory, HasTheEventsOfItsVehicleOnly) {
  const FaultMemory memory(vehicle_of({2, 16}), immediate());
  EXPECT_NE(memory.find(kNoDataOf2), nullptr);
  EXPECT_NE(memory.find(kYawOf16), nullptr);
  EXPECT_EQ(memory.find({kind_of(RadarEvent::kNoData), 1}), nullptr);
  EXPECT_NE(memory.find({EventKind::kServiceSilent, 5}), nullptr);
  EXPECT_EQ(memory.find({EventKind::kServiceSilent, 6}), nullptr);
  EXPECT_EQ(memory.find({EventKind::kServiceSilent, 255}), nullptr);
  EXPECT_NE(memory.find({EventKind::kLoadChange}), nullptr);
}

TEST(FaultMemory, KeepsTheFirstAndTheLatestFreezeFrame) {
  FaultMemory memory(vehicle_of({2}), immediate());
  for (const float speed : {10.0F, 20.0F, 30.0F}) {
    memory.report(kNoDataOf2, TestResult::kFailed, 0, frame_at(speed));
    memory.report(kNoDataOf2, TestResult::kFailed, 0, frame_at(99.0F));
    memory.report(kNoDataOf2, TestResult::kPassed, 0, frame_at(99.0F));
  }
  const FaultRecord& record = *memory.find(kNoDataOf2);
  EXPECT_EQ(record.status.occurrences, 3);
  EXPECT_EQ(record.first.speed_mps, 10.0F);
  EXPECT_EQ(record.latest.speed_mps, 30.0F);
  EXPECT_EQ(memory.stored(), 1u);
}

TEST(FaultMemory, ReportsOfTheSameResultChangeNoRevision) {
  FaultMemory memory(vehicle_of({2}), immediate());
  memory.report(kNoDataOf2, TestResult::kFailed, 0, {});
  const std::uint64_t revision = memory.revision();
  EXPECT_GT(revision, 0u);
  for (int i = 0; i < 100; ++i) memory.report(kNoDataOf2, TestResult::kFailed, i, {});
  EXPECT_EQ(memory.revision(), revision);
  memory.report(kNoDataOf2, TestResult::kPassed, 0, {});
  EXPECT_GT(memory.revision(), revision);
}

TEST(FaultMemory, ACycleCountsOnceAndTheSameIdContinuesIt) {
  FaultMemory memory(vehicle_of({2}), immediate());
  memory.begin_cycle(77);
  EXPECT_EQ(memory.cycle(), 1u);
  memory.report(kNoDataOf2, TestResult::kFailed, 0, {});
  memory.begin_cycle(77);
  EXPECT_EQ(memory.cycle(), 1u);
  EXPECT_TRUE(memory.find(kNoDataOf2)->status.has(kTestFailedThisOperationCycle));
  memory.begin_cycle(78);
  EXPECT_EQ(memory.cycle(), 2u);
  EXPECT_FALSE(memory.find(kNoDataOf2)->status.has(kTestFailedThisOperationCycle));
  EXPECT_TRUE(memory.is_failed(kNoDataOf2)) << "the last known result stands";
}

TEST(FaultMemory, ClearDeletesOneCodeOrAll) {
  FaultMemory memory(vehicle_of({2, 16}), immediate());
  memory.report(kNoDataOf2, TestResult::kFailed, 0, frame_at(1.0F));
  memory.report(kYawOf16, TestResult::kFailed, 0, frame_at(1.0F));
  EXPECT_FALSE(memory.clear(dtc_of({kind_of(RadarEvent::kNoData), 1})));
  EXPECT_TRUE(memory.clear(dtc_of(kNoDataOf2)));
  EXPECT_EQ(memory.find(kNoDataOf2)->status.bits, kCleared);
  EXPECT_EQ(memory.find(kNoDataOf2)->latest.time_ns, 0);
  EXPECT_EQ(memory.stored(), 1u);
  memory.clear_all();
  EXPECT_EQ(memory.stored(), 0u);
  memory.report(kYawOf16, TestResult::kFailed, 0, {});
  EXPECT_EQ(memory.find(kYawOf16)->status.occurrences, 1) << "tested again";
}

TEST(FaultMemory, RestoredResultsStandUntilTestedAgain) {
  FaultMemoryConfig config = immediate();
  config.debounce[static_cast<std::size_t>(kNoDataOf2.kind)] = {.set_s = 1.0, .clear_s = 1.0};
  FaultMemory before(vehicle_of({2, 16}), config);
  before.begin_cycle(5);
  before.report(kNoDataOf2, TestResult::kFailed, 0, frame_at(10.0F));
  before.report(kNoDataOf2, TestResult::kFailed, kSecond_ns, frame_at(20.0F));
  std::vector<std::uint8_t> bytes(kMaxFaultMemoryBytes);
  bytes.resize(encode_fault_memory(before, bytes));
  FaultMemory after(vehicle_of({2, 16}), config);
  ASSERT_EQ(decode_fault_memory(bytes, after), StoredFaults::kTaken);
  EXPECT_TRUE(after.is_failed(kNoDataOf2));
  EXPECT_FALSE(after.find(kNoDataOf2)->tested_since_start);
  EXPECT_EQ(after.find(kNoDataOf2)->latest.speed_mps, 20.0F);
  after.begin_cycle(5);
  EXPECT_EQ(after.cycle(), 1u) << "the same operation cycle goes on";
  after.report(kNoDataOf2, TestResult::kPassed, 2 * kSecond_ns, {});
  EXPECT_TRUE(after.is_failed(kNoDataOf2)) << "not passed long enough";
  after.report(kNoDataOf2, TestResult::kPassed, 3 * kSecond_ns, {});
  EXPECT_FALSE(after.is_failed(kNoDataOf2));
  EXPECT_TRUE(after.find(kNoDataOf2)->tested_since_start);
  EXPECT_TRUE(after.find(kNoDataOf2)->status.has(kConfirmed));
}

TEST(FaultMemory, AFullMemoryIsReadBackExactly) {
  FaultMemory memory(vehicle_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}), immediate());
  memory.begin_cycle(1);
  float speed = 0.0F;
  for (const FaultRecord& record : memory.records()) {
    memory.report(record.event, TestResult::kFailed, 0, frame_at(speed += 1.0F));
  }
  std::vector<std::uint8_t> bytes(kMaxFaultMemoryBytes);
  const std::size_t size = encode_fault_memory(memory, bytes);
  ASSERT_GT(size, 0u) << "the capacity holds the largest memory";
  FaultMemory copy(vehicle_of({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}), immediate());
  ASSERT_EQ(decode_fault_memory(std::span(bytes).first(size), copy), StoredFaults::kTaken);
  std::vector<std::uint8_t> again(kMaxFaultMemoryBytes);
  ASSERT_EQ(encode_fault_memory(copy, again), size);
  EXPECT_EQ(bytes, again);
}

TEST(FaultMemory, DamagedBytesAreRefusedAndChangeNothing) {
  FaultMemory memory(vehicle_of({2}), immediate());
  memory.report(kNoDataOf2, TestResult::kFailed, 0, frame_at(1.0F));
  std::vector<std::uint8_t> good(kMaxFaultMemoryBytes);
  good.resize(encode_fault_memory(memory, good));
  std::mt19937 random(1);
  FaultMemory target(vehicle_of({2}), immediate());
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::uint8_t> bytes = good;
    if (i % 2 == 0) bytes.resize(random() % bytes.size());
    if (!bytes.empty() && i % 3 != 0) bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    if (bytes == good) continue;
    EXPECT_EQ(decode_fault_memory(bytes, target), StoredFaults::kCorrupt);
  }
  EXPECT_EQ(target.stored(), 0u);
  std::vector<std::uint8_t> other = good;
  state::ByteWriter writer(other);
  state::begin_frame(writer, "BORFAULT", kFaultMemoryVersion + 1);
  ASSERT_GT(state::end_frame(writer), 0u);
  other.resize(writer.size());
  EXPECT_EQ(decode_fault_memory(other, target), StoredFaults::kOtherVersion);
}

TEST(FaultMemory, RecordsOfARemovedRadarAreLeftOut) {
  FaultMemory memory(vehicle_of({2, 16}), immediate());
  memory.report(kYawOf16, TestResult::kFailed, 0, {});
  memory.report(kNoDataOf2, TestResult::kFailed, 0, {});
  std::vector<std::uint8_t> bytes(kMaxFaultMemoryBytes);
  bytes.resize(encode_fault_memory(memory, bytes));
  FaultMemory smaller(vehicle_of({2}), immediate());
  ASSERT_EQ(decode_fault_memory(bytes, smaller), StoredFaults::kTaken);
  EXPECT_EQ(smaller.stored(), 1u);
}

TEST(FaultMemory, ReportsAllocateNothing) {
  FaultMemory memory(vehicle_of({2, 16}), FaultMemoryConfig{});
  const FreezeFrame frame = frame_at(1.0F);
  const std::uint64_t before = runtime::counted_allocations();
  {
    const runtime::CountAllocations counting;
    for (int i = 0; i < 1000; ++i) {
      for (const FaultRecord& record : memory.records()) {
        memory.report(record.event, i % 3 == 0 ? TestResult::kPassed : TestResult::kFailed, i * kSecond_ns, frame);
      }
    }
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::health
