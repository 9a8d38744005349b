#include "services/ingest_gateway/codecs/srr520.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ingest_gateway/memory_output.hpp"
#include "tests/unit/ingest_gateway/put_signal.hpp"
#include "tests/unit/ingest_gateway/times.hpp"

namespace boresight::ingest {
namespace {

namespace srr520_layout = wire::srr520;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

struct Srr520Frame {
  std::uint32_t id;
  Bytes bytes;
};

void put_big_endian(Bytes& bytes, std::size_t at, std::size_t size, std::uint64_t value) {
  for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> 8 * (size - 1 - i));
}

/// CRC-16/CCITT-FALSE, bit by bit.
std::uint16_t crc16(std::uint16_t crc, const Bytes& bytes, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool one = (crc >> 15 & 1) != (bytes[i] >> bit & 1);
      crc = static_cast<std::uint16_t>(crc << 1 ^ (one ? 0x1021 : 0));
    }
  }
  return crc;
}

/// A list of that kind: header, record frames, closing frame. Records are zero except those that the test writes.
class List {
 public:
  explicit List(std::size_t kind, unsigned entries = 0, unsigned sequence = 7) : kind_(kind) {
    const srr520_layout::ListLayout& list = srr520_layout::kLists[kind];
    Bytes header(srr520_layout::kHeaderBytes);
    header[srr520_layout::header::kSyncStatus] = srr520_layout::kSyncOk;
    header[srr520_layout::header::kSequenceCounter] = static_cast<std::uint8_t>(sequence);
    put_big_endian(header, srr520_layout::header::kSeconds, 4, 1000);
    put_big_endian(header, srr520_layout::header::kNanoseconds, 4, 25'000'000);
    put_big_endian(header, srr520_layout::header::kAmbiguousVelocity, 2, 39794);  // 21.4454 m/s; also the ego speed
    put_big_endian(header, list.count_offset, list.count_bytes, entries);
    frames.push_back({list.header_id, header});
    for (std::size_t i = 0; i < list.number_of_frames; ++i) {
      Bytes record(srr520_layout::kRecordFrameBytes);
      record[srr520_layout::kFrameNumber] = static_cast<std::uint8_t>(i);
      record[srr520_layout::kFrameSequence] = static_cast<std::uint8_t>(sequence);
      frames.push_back({list.record_id, record});
    }
    seal();
  }

  Bytes& header() { return frames.front().bytes; }
  std::span<std::uint8_t> detection(std::size_t i) {
    return std::span(frames[1 + i / 10].bytes)
        .subspan(i % 10 * srr520_layout::kDetectionBytes, srr520_layout::kDetectionBytes);
  }
  /// Appends or renews the closing frame.
  List& seal() {
    frames.resize(1 + srr520_layout::kLists[kind_].number_of_frames);
    std::uint16_t crc = 0xFFFF;
    for (const Srr520Frame& frame : frames) crc = crc16(crc, frame.bytes, frame.bytes.size());
    Bytes closing(srr520_layout::kClosingBytes);
    closing[srr520_layout::closing::kListId] = static_cast<std::uint8_t>(kind_);
    put_big_endian(closing, srr520_layout::closing::kCrc, 2, crc);
    frames.push_back({srr520_layout::kClosingId, closing});
    return *this;
  }

  std::vector<Srr520Frame> frames;

 private:
  std::size_t kind_;
};

class Srr520Test : public testing::Test {
 protected:
  void take(const Srr520Frame& frame) {
    recording::Frame view = can_frame(frame.id, frame.bytes);
    view.kind = recording::FrameKind::kCanFd;
    decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
    now_ns_ += 100'000;
  }
  void take(const List& list) {
    for (const Srr520Frame& frame : list.frames) take(frame);
  }
  /// A valid list is accepted after any input.
  void expect_recovery() {
    const std::size_t scans = output_.scans, faults = output_.all_faults();
    take(List(srr520_layout::kNearList));
    EXPECT_EQ(output_.scans, scans + 1);
    EXPECT_EQ(output_.all_faults(), faults) << output_.last_fault;
  }

  Srr520 decoder_;
  MemoryOutput output_;
  std::int64_t now_ns_ = 5'000 * kMillisecond;
};

TEST_F(Srr520Test, DetectionsOfASoundListAreAScan) {
  List list(srr520_layout::kNearList, 12);
  put_big_endian(list.header(), srr520_layout::header::kCycleCounter, 4, 0x12345678);
  const auto record = list.detection(11);  // the second of the second frame
  put_raw(record, srr520_layout::kRange_m, 2048);
  put_raw(record, srr520_layout::kAzimuth_rad, 510);
  put_raw(record, srr520_layout::kRangeRate_mps, 1023 + 682);
  put_raw(record, srr520_layout::kRcs_dbsm, 126);
  put_raw(record, srr520_layout::kSnr_db, 15);
  put_raw(record, srr520_layout::kHypotheses[2], 1);
  const std::int64_t begin_ns = now_ns_;
  take(list.seal());
  ASSERT_EQ(output_.scans, 1u) << output_.last_fault;
  EXPECT_EQ(output_.all_faults(), 0u);
  const RadarScan& scan = *output_.scan;
  EXPECT_EQ(scan.number_of_valid_detections, 12u);
  EXPECT_EQ(scan.cycle_counter, 0x12345678u);
  EXPECT_EQ(output_.last_counter_bits, 32u);
  EXPECT_EQ(scan.dropped_detections, 0u);
  EXPECT_EQ(scan.integrity, 0u);
  EXPECT_EQ(scan.fields, scan_field::kRcs | scan_field::kSnr | scan_field::kAmbiguity);
  EXPECT_NEAR(scan.range_rate_max_mps, 21.4454 / 2, 1e-4);
  EXPECT_EQ(scan.range_rate_min_mps, -scan.range_rate_max_mps);
  EXPECT_NEAR(scan.range_m[11], 100.0 * 2048 / 4095, 1e-5);
  EXPECT_NEAR(scan.azimuth_rad[11], M_PI / 2, 1e-6);
  EXPECT_NEAR(scan.range_rate_mps[11], 10.0, 1e-5);
  EXPECT_NEAR(scan.rcs_dbsm[11], 20.0, 1e-5);
  EXPECT_NEAR(scan.snr_db[11], 36.5, 1e-5);
  EXPECT_EQ(scan.existence_probability[11], 1.0F);
  EXPECT_EQ(scan.elevation_rad[11], 0.0F);
  EXPECT_EQ(scan.range_std_m[11], 0.0F);
  EXPECT_EQ(scan.detection_flags[11], 0u);
  EXPECT_EQ(decode_srr520_detection(std::span<const std::uint8_t, srr520_layout::kDetectionBytes>(record)).hypotheses,
            1u << 2);
  // The first detection's codes are all zero; its range rate lies outside the unambiguous interval.
  EXPECT_NEAR(scan.azimuth_rad[0], -M_PI / 2, 1e-6);
  EXPECT_NEAR(scan.range_rate_mps[0], -15.0, 1e-6);
  EXPECT_EQ(scan.detection_flags[0], detection_flag::kAmbiguous);
  EXPECT_EQ(output_.last_reception.received_ns, begin_ns) << "that of the header frame";
  ASSERT_TRUE(output_.last_sensor);
  EXPECT_TRUE(output_.last_sensor->synchronised);
  EXPECT_EQ(output_.last_sensor->time_ns, 1'000'025'000'000);
}

TEST_F(Srr520Test, NearAndHrrListsAreScansOfTheirOwn) {
  take(List(srr520_layout::kNearList, 3));
  take(List(srr520_layout::kHrrList, 200));
  EXPECT_EQ(output_.scans, 2u);
  EXPECT_EQ(output_.scan->number_of_valid_detections, 200u);
  take(List(srr520_layout::kNearList, 500));
  EXPECT_EQ(output_.scan->number_of_valid_detections, 500u);
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Srr520Test, WhatIsNotAvailableIsMarkedInvalid) {
  List list(srr520_layout::kHrrList, 3);
  put_raw(list.detection(0), srr520_layout::kAzimuth_rad, 511);
  put_raw(list.detection(1), srr520_layout::kRangeRate_mps, 2047);
  put_raw(list.detection(2), srr520_layout::kRcs_dbsm, 127);
  put_big_endian(list.header(), srr520_layout::header::kAmbiguousVelocity, 2, 0);
  take(list.seal());
  ASSERT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.scan->detection_flags[0], detection_flag::kUnusable);
  EXPECT_EQ(output_.scan->detection_flags[1], detection_flag::kUnusable);
  EXPECT_EQ(output_.scan->detection_flags[2], 0u);
  EXPECT_EQ(output_.scan->rcs_dbsm[2], 0.0F);
  EXPECT_EQ(output_.scan->range_rate_max_mps, 0.0F) << "an ambiguous velocity of -100 m/s is invalid";
  EXPECT_FALSE(output_.scan->has(scan_field::kAmbiguity));
}

TEST_F(Srr520Test, AListWithAnyFrameMissingIsRejectedWhole) {
  for (std::size_t kind = 0; kind < srr520_layout::kLists.size(); ++kind) {
    take(List(kind));  // nothing is reported before the first header
    const List list(kind);
    for (std::size_t lost = 0; lost < list.frames.size(); ++lost) {
      SCOPED_TRACE(testing::Message() << srr520_layout::kLists[kind].name << " without frame " << lost);
      const std::size_t scans = output_.scans, readings = output_.ego_readings, faults = output_.all_faults();
      for (std::size_t i = 0; i < list.frames.size(); ++i) {
        if (i != lost) take(list.frames[i]);
      }
      now_ns_ += 60 * kMillisecond;
      decoder_.tick(now_ns_, output_);
      EXPECT_EQ(output_.scans, scans);
      EXPECT_EQ(output_.ego_readings, readings);
      EXPECT_EQ(output_.all_faults(), faults + 1) << "exactly one fault for one loss";
      EXPECT_THAT(output_.last_fault, HasSubstr("missing"));
      EXPECT_THAT(output_.last_fault, HasSubstr(std::string(srr520_layout::kLists[kind].name)));
      expect_recovery();
    }
  }
}

TEST_F(Srr520Test, OrderAndRepetitionDoNotMatter) {
  List list(srr520_layout::kNearList, 500);
  for (std::size_t i = 0; i < 500; ++i) put_raw(list.detection(i), srr520_layout::kRange_m, i + 1);
  list.seal();
  std::shuffle(list.frames.begin() + 1, list.frames.end() - 1, std::mt19937(1));
  list.frames.insert(list.frames.begin() + 20, list.frames[5]);
  take(list);
  ASSERT_EQ(output_.scans, 1u) << output_.last_fault;
  EXPECT_EQ(output_.all_faults(), 0u);
  for (unsigned i = 0; i < 500; ++i) ASSERT_NEAR(output_.scan->range_m[i], (i + 1u) * 100.0 / 4095, 1e-4);
}

TEST_F(Srr520Test, ARepeatedFrameWithOtherContentIsFoundByTheCrc) {
  List list(srr520_layout::kHrrList, 10);
  Srr520Frame forged = list.frames[3];
  forged.bytes[0] ^= 1;
  list.frames.insert(list.frames.begin() + 4, forged);
  take(list);
  EXPECT_EQ(output_.scans, 0u);
  EXPECT_EQ(output_.count(Fault::kWireValue), 1u);
  EXPECT_THAT(output_.last_fault, HasSubstr("CRC"));
}

TEST_F(Srr520Test, NoFlippedBitGoesThrough) {
  const List sound(srr520_layout::kHrrList, 20);
  List list = sound;
  for (std::size_t i = 0; i < list.frames.size(); ++i) {
    for (std::size_t bit = 0; bit < list.frames[i].bytes.size() * 8; ++bit) {
      if (i + 1 == list.frames.size() && bit >= 24) break;  // the last byte of the closing frame is not used
      const std::size_t faults = output_.all_faults();
      list.frames[i].bytes[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
      take(list);
      list.frames[i].bytes[bit / 8] = sound.frames[i].bytes[bit / 8];
      ASSERT_EQ(output_.scans, 0u) << "frame " << i << " bit " << bit;
      ASSERT_GT(output_.all_faults(), faults) << "frame " << i << " bit " << bit;
    }
  }
  expect_recovery();
}

TEST_F(Srr520Test, AFrameOfAWrongLengthRejectsItsList) {
  take(List(srr520_layout::kNearList));
  const List sound(srr520_layout::kHrrList, 20);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{20}, std::size_t{21}}) {
    for (const std::size_t size : {0u, 1u, 3u, 5u, 8u, 31u, 33u, 48u, 63u, 65u}) {
      List list = sound;
      list.frames[i].bytes.resize(size);
      const std::size_t scans = output_.scans, lengths = output_.count(Fault::kWireLength);
      take(list);
      EXPECT_EQ(output_.scans, scans) << "frame " << i << " of " << size << " bytes";
      EXPECT_GT(output_.count(Fault::kWireLength), lengths) << "frame " << i << " of " << size << " bytes";
      expect_recovery();
    }
  }
}

TEST_F(Srr520Test, FieldsOutOfTheirRangeAreRejectedThoughTheCrcIsRight) {
  const auto reject = [this](std::size_t at, std::size_t size, std::uint64_t value, const char* why) {
    List list(srr520_layout::kHrrList, 5);
    put_big_endian(list.header(), at, size, value);
    const std::size_t values = output_.count(Fault::kWireValue);
    take(list.seal());
    EXPECT_EQ(output_.scans, 0u) << why;
    EXPECT_EQ(output_.count(Fault::kWireValue), values + 1) << why;
    EXPECT_THAT(output_.last_fault, HasSubstr(why));
  };
  reject(23, 2, 201, "number of entries 201, allowed 0 … 200");
  reject(23, 2, 65535, "number of entries 65535, allowed 0 … 200");
  reject(srr520_layout::header::kSyncStatus, 1, 0, "sync status 0, allowed 1 … 3");
  reject(srr520_layout::header::kSyncStatus, 1, 4, "sync status 4, allowed 1 … 3");
  reject(srr520_layout::header::kNanoseconds, 4, 1'000'000'000,
         "nanoseconds of the stamp 1000000000, allowed 0 … 999999999");
  // In a record frame the list is rejected at once.
  List list(srr520_layout::kHrrList, 5);
  list.frames[2].bytes[srr520_layout::kFrameNumber] = 20;
  take(list.seal());
  EXPECT_THAT(output_.last_fault, HasSubstr("frame number 20, allowed 0 … 19"));
  list = List(srr520_layout::kHrrList, 5);
  list.frames[2].bytes[srr520_layout::kFrameSequence] = 8;
  take(list.seal());
  EXPECT_THAT(output_.last_fault, HasSubstr("sequence counter 8 in record frame 1, header has 7"));
  list = List(srr520_layout::kHrrList, 5);
  list.frames.back().bytes[0] = 3;
  take(list);
  EXPECT_EQ(output_.scans, 0u);
  expect_recovery();
}

TEST_F(Srr520Test, AnOpenListIsRejectedWhenAnotherBeginsOrNothingComes) {
  List list(srr520_layout::kNearList, 5);
  for (std::size_t i = 0; i < 30; ++i) take(list.frames[i]);
  take(List(srr520_layout::kHrrList, 5));
  EXPECT_EQ(output_.scans, 1u);
  EXPECT_EQ(output_.count(Fault::kWireLength), 1u);
  EXPECT_EQ(output_.last_fault, "SRR520 near list rejected: closing frame is missing, 29 of 50 record frames received");
  for (std::size_t i = 0; i < 30; ++i) take(list.frames[i]);
  const std::int64_t last_ns = now_ns_ - 100'000;
  decoder_.tick(last_ns + 50 * kMillisecond, output_);
  EXPECT_EQ(output_.all_faults(), 1u);
  decoder_.tick(last_ns + 50 * kMillisecond + 1, output_);
  EXPECT_EQ(output_.all_faults(), 2u);
  for (std::size_t i = 30; i < list.frames.size(); ++i) take(list.frames[i]);
  EXPECT_EQ(output_.all_faults(), 2u) << "the rest of a rejected list is dropped silently";
  EXPECT_EQ(output_.scans, 1u);
  expect_recovery();
}

TEST_F(Srr520Test, TheSensorClockRunsOnAcrossItsWrapWhereItIsNotSynchronised) {
  const auto time_ns = [this](std::uint32_t clock_us, std::uint8_t sync) {
    List list(srr520_layout::kNearList);
    list.header()[srr520_layout::header::kSyncStatus] = sync;
    put_big_endian(list.header(), srr520_layout::header::kSensorClock_us, 4, clock_us);
    take(list.seal());
    EXPECT_EQ(output_.last_sensor->synchronised, sync == srr520_layout::kSyncOk);
    return output_.last_sensor->time_ns;
  };
  const std::int64_t first_ns = time_ns(0xFFFF'FF00, 2);
  EXPECT_EQ(first_ns, 0xFFFF'FF00LL * 1000);
  EXPECT_EQ(time_ns(0x0000'0100, 3), first_ns + 512'000);
  EXPECT_EQ(time_ns(0x0000'0200, srr520_layout::kSyncOk), 1'000'025'000'000)
      << "the stamp of the vehicle's clock is preferred";
  EXPECT_EQ(time_ns(0x0000'0300, 2), first_ns + 1'024'000);
  EXPECT_LT(time_ns(0x0000'0000, 2), first_ns + 1'024'000) << "a reset of the sensor shows as a step back";
}

TEST_F(Srr520Test, TheObjectListTellsTheEgoMotion) {
  List list(srr520_layout::kObjectList, 40);
  put_big_endian(list.header(), srr520_layout::header::kEgoSpeed, 2, 32767 - 3277);  // 3277 steps of 200/65534 m/s back
  put_big_endian(list.header(), srr520_layout::header::kEgoYawRate, 2, 32767 + 10430);
  const std::int64_t begin_ns = now_ns_;
  take(list.seal());
  EXPECT_EQ(output_.scans, 0u);
  ASSERT_EQ(output_.ego_readings, 1u) << output_.last_fault;
  EXPECT_NEAR(output_.last_ego.speed_mps.value(), -10.001, 1e-3);
  EXPECT_TRUE(output_.last_ego.speed_is_signed);
  EXPECT_NEAR(output_.last_ego.yaw_rate_radps.value(), 1.0, 1e-4);
  EXPECT_FALSE(output_.last_ego.reverse);
  EXPECT_EQ(output_.last_reception.received_ns, begin_ns);
  put_big_endian(list.header(), srr520_layout::header::kEgoSpeed, 4, 0xFFFF'FFFF);  // and the yaw rate after it
  take(list.seal());
  ASSERT_EQ(output_.ego_readings, 2u);
  EXPECT_FALSE(output_.last_ego.speed_mps);
  EXPECT_FALSE(output_.last_ego.yaw_rate_radps);
  list.frames.back().bytes[1] ^= 1;
  take(list);
  EXPECT_EQ(output_.ego_readings, 2u);
  EXPECT_THAT(output_.last_fault, HasSubstr("SRR520 object list rejected: CRC"));
}

TEST_F(Srr520Test, TheStatusFrameTellsTheSensorsCondition) {
  const auto conditions = [this](std::size_t at, std::uint8_t value) {
    Srr520Frame status{srr520_layout::kStatusId, Bytes(srr520_layout::kStatusBytes)};
    status.bytes[srr520_layout::status::kSyncStatus] = srr520_layout::kSyncOk;
    status.bytes[at] = value;
    put_big_endian(status.bytes, srr520_layout::status::kCrc, 2,
                   crc16(0xFFFF, status.bytes, srr520_layout::status::kCrc));
    output_.conditions.reset();
    take(status);
    return output_.conditions.value_or(0xFFFF'FFFF);
  };
  EXPECT_EQ(conditions(0, 0), 0u);
  EXPECT_EQ(conditions(srr520_layout::status::kSyncStatus, 2), source_condition::kUnsynchronised);
  EXPECT_EQ(conditions(srr520_layout::status::kDefective, 0b01000000), source_condition::kDefective);
  EXPECT_EQ(conditions(srr520_layout::status::kDefective, 0b10101010), 0u) << "errors of the past";
  EXPECT_EQ(conditions(srr520_layout::status::kSupplyVoltage, 0b00000100), source_condition::kSupply);
  EXPECT_EQ(conditions(srr520_layout::status::kTemperature, 0b00000001), source_condition::kTemperature);
  EXPECT_EQ(conditions(srr520_layout::status::kDynamicsInvalid, 0b00000001), source_condition::kWithoutEgoMotion);
  EXPECT_EQ(conditions(srr520_layout::status::kDynamicsInvalid, 0b10111110), 0u);
  EXPECT_EQ(conditions(srr520_layout::status::kYawRateInvalid, 0b00000001), source_condition::kWithoutEgoMotion);
  EXPECT_EQ(output_.all_faults(), 0u);
  take({srr520_layout::kStatusId, Bytes(srr520_layout::kStatusBytes)});
  EXPECT_THAT(output_.last_fault, HasSubstr("SRR520 status frame: CRC 0000"));
  take({srr520_layout::kStatusId, Bytes(8)});
  EXPECT_EQ(output_.last_fault, "SRR520 status frame of 8 bytes, must be 64");
}

TEST_F(Srr520Test, WhatConcernsOthersIsIgnoredSilently) {
  const List list(srr520_layout::kNearList, 5);
  for (std::size_t i = 1; i < list.frames.size(); ++i) take(list.frames[i]);  // joined the bus in the middle of a list
  EXPECT_EQ(output_.all_faults(), 0u);
  for (const Srr520Frame& frame : list.frames) {
    recording::Frame view = can_frame(frame.id, frame.bytes);
    view.can_extended = true;
    decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
    view.can_extended = false;
    view.can_remote = true;
    decoder_.take(view, {now_ns_, 0, TimeSource::kLinkArrival}, output_);
  }
  take({53, Bytes(8)});
  take({600, Bytes(8)});
  take({0x201, Bytes(8)});
  EXPECT_EQ(output_.scans, 0u);
  EXPECT_EQ(output_.all_faults(), 0u);
}

TEST_F(Srr520Test, WithoutMemoryTheScanIsLostAndTheNextIsNot) {
  output_.refuse_memory = true;
  take(List(srr520_layout::kNearList, 5));
  EXPECT_EQ(output_.scans, 0u);
  output_.refuse_memory = false;
  expect_recovery();
}

TEST_F(Srr520Test, RandomFramesNeitherCrashNorGoThrough) {
  std::mt19937 random(520);
  const std::array<std::uint32_t, 8> ids{700, 800, 900, 901, 1100, 1101, 1200, 1201};
  const std::array<std::size_t, 6> sizes{0, 4, 4, 32, 64, 64};
  std::size_t sound = 0;
  for (int i = 0; i < 100'000; ++i) {
    Srr520Frame frame{ids[random() % ids.size()], Bytes(random() % 4 == 0 ? random() % 65 : sizes[random() % 6])};
    for (std::uint8_t& byte : frame.bytes) byte = static_cast<std::uint8_t>(random());
    if (frame.bytes.size() == 64 && random() % 2 == 0) frame.bytes[62] %= 50;
    if (frame.bytes.size() == 4) frame.bytes[0] %= 4;
    take(frame);
    if (i % 5000 == 0) {
      take(List(srr520_layout::kHrrList, 20));
      ++sound;
    }
  }
  EXPECT_EQ(output_.scans, sound) << "bad frames are rejected and do not disturb good ones";
  EXPECT_GT(output_.all_faults(), 1000u);
}

}  // namespace
}  // namespace boresight::ingest
