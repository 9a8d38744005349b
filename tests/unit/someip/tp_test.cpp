// Reassembly of segmented messages: the rules of the specification, and reported problems of other stacks.
#include "services/ingest_gateway/codecs/someip/tp.hpp"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/someip/bytes.hpp"
#include "tests/unit/someip/sd_server.hpp"

namespace boresight::ingest::someip {
namespace {

using test::Bytes;
using test::Header;
using test::kMillisecond;
using test::segment;
using test::segments;

constexpr std::int64_t kTimeout_ns = 100 * kMillisecond;
const recording::Endpoint kSender = test::endpoint(0xC0A80714, 30501);

class Tp : public testing::Test {
 protected:
  TpResult take(const Bytes& datagram, const recording::Endpoint& sender = kSender) {
    MessageReader reader(datagram);
    Message message;
    EXPECT_EQ(reader.next(message), ReadResult::kMessage);
    const TpResult result = tp_.take(message, sender, now_ns_, complete_);
    if (result == TpResult::kComplete) payloads_.emplace_back(complete_.payload.begin(), complete_.payload.end());
    return result;
  }
  void take_all(const std::vector<Bytes>& datagrams) {
    for (const Bytes& datagram : datagrams) static_cast<void>(take(datagram));
  }

  std::mt19937 random_{7};
  TpReassembler tp_{4, 8192, kTimeout_ns};
  std::int64_t now_ns_ = 1'000 * kMillisecond;
  Message complete_;
  std::vector<Bytes> payloads_;
};

TEST_F(Tp, ReassemblesSegmentsOfScapyAndWritesThePlainHeader) {
  // scapy 2.5: SOMEIP(msg_type=TYPE_TP_NOTIFICATION, …)/Raw(bytes(range(40))), .fragment(16).
  EXPECT_EQ(take(test::from_hex("123480210000001c000000090102220000000001000102030405060708090a0b0c0d0e0f")),
            TpResult::kAccepted);
  EXPECT_EQ(take(test::from_hex("123480210000001c000000090102220000000011101112131415161718191a1b1c1d1e1f")),
            TpResult::kAccepted);
  ASSERT_EQ(take(test::from_hex("12348021000000140000000901022200000000202021222324252627")), TpResult::kComplete);

  Bytes payload(40);
  std::iota(payload.begin(), payload.end(), std::uint8_t{0});
  const Bytes plain = test::message({.session = 9}, payload);
  EXPECT_THAT(complete_.payload, testing::ElementsAreArray(payload));
  EXPECT_THAT(complete_.protected_data, testing::ElementsAreArray(std::span(plain).subspan(8)));
  const std::span<const std::uint8_t> whole(complete_.protected_data.data() - 8, plain.size());
  EXPECT_THAT(whole, testing::ElementsAreArray(plain));
  EXPECT_FALSE(complete_.tp);
  EXPECT_EQ(complete_.session, 9);
  EXPECT_EQ(tp_.statistics().completed, 1u);
}

TEST_F(Tp, AcceptsSegmentsInAnyOrderAndRepeated) {
  for (int round = 0; round < 500; ++round) {
    const Bytes payload = test::random_bytes(random_, 1 + random_() % 8192);
    std::vector<Bytes> parts =
        segments({.session = static_cast<std::uint16_t>(1 + round)}, payload, 16 * (1 + random_() % 87));
    const std::size_t distinct = parts.size();
    for (std::size_t copies = random_() % 3; copies > 0; --copies) parts.push_back(parts[random_() % distinct]);
    std::shuffle(parts.begin(), parts.end(), random_);
    take_all(parts);
    ASSERT_EQ(payloads_.size(), static_cast<std::size_t>(round) + 1) << "segments: " << distinct;
    ASSERT_EQ(payloads_.back(), payload);
  }
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 0u);
  EXPECT_EQ(tp_.statistics().bad_segments, 0u);
  EXPECT_GT(tp_.statistics().duplicates, 0u);
}

TEST_F(Tp, ALostSegmentDropsOnlyItsMessage) {
  const auto count = static_cast<std::uint16_t>(segments({}, Bytes(5000), 1392).size());
  for (std::uint16_t lost = 0; lost < count; ++lost) {
    const auto session = static_cast<std::uint16_t>(100 + 10 * lost);
    const Bytes damaged = test::random_bytes(random_, 5000), sound = test::random_bytes(random_, 5000);
    std::vector<Bytes> parts = segments({.session = session}, damaged, 1392);
    parts.erase(parts.begin() + lost);
    take_all(parts);
    EXPECT_EQ(payloads_.size(), lost);
    take_all(segments({.session = static_cast<std::uint16_t>(session + 1)}, sound, 1392));
    ASSERT_EQ(payloads_.size(), lost + 1u);
    EXPECT_EQ(payloads_.back(), sound);
  }
  EXPECT_EQ(tp_.statistics().dropped_incomplete, count);
}

TEST_F(Tp, ASegmentOfThePreviousMessageDoesNotDisturbTheNewOne) {
  const Bytes old_payload = test::random_bytes(random_, 64), new_payload = test::random_bytes(random_, 64);
  const auto old_parts = segments({.session = 0xFFFF}, old_payload, 32);
  const auto new_parts = segments({.session = 1}, new_payload, 32);
  EXPECT_EQ(take(old_parts[0]), TpResult::kAccepted);
  EXPECT_EQ(take(new_parts[0]), TpResult::kAccepted);  // the session wraps; the old message is dropped
  EXPECT_EQ(take(old_parts[1]), TpResult::kLate);
  EXPECT_EQ(take(new_parts[1]), TpResult::kComplete);
  EXPECT_EQ(payloads_.back(), new_payload);
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 1u);
  EXPECT_EQ(tp_.statistics().late_segments, 1u);
}

TEST_F(Tp, ARestartedSenderIsReceivedAtOnce) {
  EXPECT_EQ(take(segments({.session = 4000}, Bytes(64), 32)[0]), TpResult::kAccepted);
  take_all(segments({.session = 1}, Bytes(64, 5), 32));
  ASSERT_EQ(payloads_.size(), 1u);
  EXPECT_EQ(payloads_[0], Bytes(64, 5));
}

TEST_F(Tp, TheSameSessionIsAcceptedAgainLater) {
  take_all(segments({.session = 1}, Bytes(64, 5), 32));
  EXPECT_EQ(take(segments({.session = 1}, Bytes(64, 5), 32)[0]), TpResult::kDuplicate);
  now_ns_ += 50 * kMillisecond;
  take_all(segments({.session = 1}, Bytes(64, 6), 32));
  ASSERT_EQ(payloads_.size(), 2u);
  EXPECT_EQ(payloads_[1], Bytes(64, 6));
}

TEST_F(Tp, EveryPartOfTheKeySeparates) {
  const Bytes payload = test::random_bytes(random_, 48);
  const Header base{.service = 1, .method = 2, .client = 3, .session = 4};
  std::vector<std::pair<Header, recording::Endpoint>> sources(6, {base, kSender});
  sources[0].first.service = 9;
  sources[1].first.method = 9;
  sources[2].first.client = 9;
  sources[3].first.interface = 9;
  sources[4].first.type = 0x00;
  sources[5].second.port = 9;
  for (const auto& [header, sender] : sources) {
    // Half of each message: neither is complete.
    EXPECT_EQ(take(segment(base, payload, 0, 32, true)), TpResult::kAccepted);
    EXPECT_EQ(take(segment(header, payload, 32, 16, false), sender), TpResult::kAccepted);
    EXPECT_TRUE(payloads_.empty());
    static_cast<void>(tp_.expire(now_ns_ += 2 * kTimeout_ns));
  }
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 12u);
}

TEST_F(Tp, MessagesOfSeveralSendersInterleave) {
  std::vector<Bytes> expected;
  std::vector<std::vector<Bytes>> parts;
  for (int i = 0; i < 4; ++i) {
    expected.push_back(test::random_bytes(random_, 200));
    parts.push_back(segments({}, expected.back(), 48));
  }
  for (std::size_t part = 0; part < parts[0].size(); ++part) {
    for (std::uint32_t i = 0; i < 4; ++i)
      static_cast<void>(take(parts[i][part], test::endpoint(0x0A000001 + i, 30501)));
  }
  EXPECT_EQ(payloads_, expected);
}

TEST_F(Tp, TheOldestIsDroppedWhenAllSlotsAreBusy) {
  const Bytes payload(32, 1);
  for (std::uint16_t i = 0; i < 5; ++i, ++now_ns_) {
    EXPECT_EQ(take(segment({.method = i}, payload, 0, 16, true)), TpResult::kAccepted);
  }
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 1u);
  for (std::uint16_t i = 1; i < 5; ++i) {
    EXPECT_EQ(take(segment({.method = i}, payload, 16, 16, false)), TpResult::kComplete) << i;
  }
  // All are delivered: their slots are used before those of incomplete messages.
  EXPECT_EQ(take(segment({.method = 0}, payload, 0, 16, true)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({.method = 6}, payload, 0, 16, true)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({.method = 0}, payload, 16, 16, false)), TpResult::kComplete);
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 1u);
}

TEST_F(Tp, DropsMessagesAfterATimeout) {
  const auto parts = segments({}, Bytes(48, 1), 16);
  EXPECT_EQ(take(parts[0]), TpResult::kAccepted);
  EXPECT_EQ(tp_.expire(now_ns_ + kTimeout_ns), 0u);
  now_ns_ += kTimeout_ns + 1;
  // Without expire(): the old bytes do not count any more.
  EXPECT_EQ(take(parts[1]), TpResult::kAccepted);
  EXPECT_EQ(take(parts[2]), TpResult::kAccepted);
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 1u);
  EXPECT_EQ(tp_.expire(now_ns_ + kTimeout_ns + 1), 1u);
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 2u);
}

TEST_F(Tp, TheFirstOfOverlappingSegmentsIsKept) {
  // The specification's example, in units of 16 bytes: 0…2 are 1, 1…3 are 2; the message is 1112.
  EXPECT_EQ(take(segment({}, Bytes(64, 1), 0, 48, true)), TpResult::kAccepted);
  ASSERT_EQ(take(segment({}, Bytes(64, 2), 16, 48, false)), TpResult::kComplete);
  Bytes expected(64, 1);
  std::fill(expected.begin() + 48, expected.end(), std::uint8_t{2});
  EXPECT_EQ(payloads_[0], expected);
  EXPECT_EQ(tp_.statistics().overlaps, 1u);
}

TEST_F(Tp, BytesThatOverlapAreNotCountedTwice) {
  // 32 + 32 bytes of a message of 64: the second half is missing.
  EXPECT_EQ(take(segment({}, Bytes(64, 1), 0, 32, true)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({}, Bytes(64, 1), 48, 16, false)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({}, Bytes(64, 1), 16, 16, true)), TpResult::kDuplicate);
  EXPECT_TRUE(payloads_.empty());
}

TEST_F(Tp, RejectsContradictorySegmentsButTheMessageCanStillBeCompleted) {
  const Bytes payload = test::random_bytes(random_, 64);
  EXPECT_EQ(take(segment({}, payload, 0, 32, true)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({}, payload, 32, 20, true)), TpResult::kNotMultiple);
  EXPECT_EQ(take(segment({}, payload, 32, 0, true)), TpResult::kTooShort);
  EXPECT_EQ(take(test::message({.type = 0x22}, Bytes(3))), TpResult::kTooShort);
  EXPECT_EQ(take(test::message({.type = 0x22}, {})), TpResult::kTooShort);
  EXPECT_EQ(take(segment({.session = 0}, payload, 0, 32, true)), TpResult::kNoSession);
  EXPECT_EQ(take(segment({}, payload, 0, 16, false)), TpResult::kContradiction) << "ends before received bytes";
  EXPECT_EQ(tp_.statistics().bad_segments, 6u);
  ASSERT_EQ(take(segment({}, payload, 32, 32, false)), TpResult::kComplete);
  EXPECT_EQ(payloads_[0], payload);
  EXPECT_EQ(take(test::message({.type = 0x02}, Bytes(32))), TpResult::kNotASegment);
}

TEST_F(Tp, RejectsSegmentsBeyondTheStatedEnd) {
  const Bytes payload(96, 3);
  EXPECT_EQ(take(segment({}, payload, 32, 16, false)), TpResult::kAccepted);
  EXPECT_EQ(take(segment({}, payload, 48, 16, true)), TpResult::kContradiction);
  EXPECT_EQ(take(segment({}, payload, 48, 16, false)), TpResult::kContradiction);
  EXPECT_EQ(take(segment({}, payload, 32, 10, false)), TpResult::kContradiction);
  ASSERT_EQ(take(segment({}, payload, 0, 32, true)), TpResult::kComplete);
  EXPECT_EQ(payloads_[0].size(), 48u);
}

TEST_F(Tp, AnEmptyLastSegmentEndsAMessage) {
  // scapy's fragment() appends one if the length is a multiple of the segments'.
  EXPECT_EQ(take(segment({}, Bytes(32, 4), 0, 32, true)), TpResult::kAccepted);
  ASSERT_EQ(take(segment({}, Bytes(32, 4), 32, 0, false)), TpResult::kComplete);
  EXPECT_EQ(payloads_[0], Bytes(32, 4));
  EXPECT_EQ(tp_.statistics().duplicates + tp_.statistics().overlaps, 0u);
  EXPECT_EQ(take(segment({.method = 5}, Bytes(32, 4), 0, 0, false)), TpResult::kTooShort);
}

TEST_F(Tp, AMessageThatIsTooLongIsRejectedOnceAndUsesNoMemory) {
  const Bytes payload(8192 + 16, 1);
  const auto parts = segments({}, payload, 1392);
  EXPECT_EQ(take(parts[0]), TpResult::kAccepted);
  EXPECT_EQ(take(parts.back()), TpResult::kOverSize);
  EXPECT_EQ(take(parts[1]), TpResult::kRefused);
  EXPECT_EQ(take(parts.back()), TpResult::kRefused);
  EXPECT_EQ(tp_.statistics().over_size, 1u);
  EXPECT_EQ(tp_.statistics().dropped_incomplete, 1u);
  Bytes far = segment({.session = 8}, payload, 0, 16, true);
  for (std::size_t i = 16; i < 20; ++i) far[i] = 0xFF;
  EXPECT_EQ(take(far), TpResult::kOverSize);
  take_all(segments({.session = 9}, Bytes(8192, 2), 1392));
  EXPECT_EQ(payloads_.size(), 1u);
}

TEST_F(Tp, TheReturnCodeIsThatOfTheLastSegment) {
  EXPECT_EQ(take(segment({.type = 0x80, .return_code = 0}, Bytes(32), 0, 16, true)), TpResult::kAccepted);
  ASSERT_EQ(take(segment({.type = 0x80, .return_code = 9}, Bytes(32), 16, 16, false)), TpResult::kComplete);
  EXPECT_EQ(complete_.return_code, 9);
  EXPECT_EQ(complete_.protected_data[7], 9);
}

TEST_F(Tp, EveryFaultHasADescription) {
  for (const TpResult result : {TpResult::kNotASegment, TpResult::kNoSession, TpResult::kTooShort,
                                TpResult::kNotMultiple, TpResult::kContradiction, TpResult::kOverSize}) {
    EXPECT_TRUE(is_fault(result));
    EXPECT_FALSE(describe(result).empty());
  }
  for (const TpResult result :
       {TpResult::kAccepted, TpResult::kComplete, TpResult::kDuplicate, TpResult::kLate, TpResult::kRefused}) {
    EXPECT_FALSE(is_fault(result));
  }
}

TEST_F(Tp, AllocatesNothing) {
  std::vector<Bytes> parts;
  for (std::uint16_t session = 1; session < 20; ++session) {
    for (Bytes& part : segments({.session = session}, Bytes(8000, 1), 1392)) parts.push_back(std::move(part));
    if (session % 3 == 0) parts.pop_back();
  }
  const std::uint64_t before = runtime::counted_allocations();
  std::uint64_t completed = 0;
  {
    const runtime::CountAllocations counting;
    for (const Bytes& part : parts) {
      MessageReader reader(part);
      Message message, complete;
      if (reader.next(message) != ReadResult::kMessage) continue;
      completed += tp_.take(message, kSender, now_ns_ += kMillisecond, complete) == TpResult::kComplete ? 1 : 0;
    }
    static_cast<void>(tp_.expire(now_ns_ + kTimeout_ns));
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
  EXPECT_EQ(completed, 13u);
}

TEST_F(Tp, ChangedSegmentsNeverHarmTheMessagesOfOthers) {
  const Bytes payload = test::random_bytes(random_, 300);
  const Header other{.service = 0x5678};
  const recording::Endpoint other_sender = test::endpoint(0x0A000001, 1);
  std::uint64_t delivered = 0;
  for (int i = 0; i < 20'000; ++i) {
    now_ns_ += kMillisecond;
    const auto session = static_cast<std::uint16_t>(1 + i % 0xFFFF);
    const auto good = segments({.service = other.service, .session = session}, payload, 112);
    const auto disturbed = segments({.session = session}, payload, 112);
    for (std::size_t part = 0; part < good.size(); ++part) {
      const Bytes datagram = test::mutated(random_, disturbed[part]);
      MessageReader reader(datagram);
      Message message, complete;
      for (ReadResult result; (result = reader.next(message)) != ReadResult::kEnd;) {
        if (result != ReadResult::kMessage) continue;
        if (tp_.take(message, kSender, now_ns_, complete) == TpResult::kComplete) {
          ASSERT_LE(complete.payload.size(), 8192u);
        }
      }
      if (take(good[part], other_sender) == TpResult::kComplete) {
        ++delivered;
        ASSERT_EQ(payloads_.back(), payload);
        payloads_.clear();
      }
    }
  }
  EXPECT_EQ(delivered, 20'000u);
}

}  // namespace
}  // namespace boresight::ingest::someip
