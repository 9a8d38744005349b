#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

#include "services/common/recording/ip.hpp"
#include "services/common/recording/reader.hpp"
#include "services/simulator/wire/pcap_writer.hpp"
#include "tests/unit/recording/files.hpp"

namespace boresight::recording {
namespace {

using Packet = std::vector<std::uint8_t>;

std::vector<std::uint8_t> payload_of(std::size_t size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
  return bytes;
}

/// One UDP datagram as raw IPv4 packets of at most `step` bytes of data each.
std::vector<Packet> fragments(const std::vector<std::uint8_t>& payload, std::uint16_t identification,
                              std::size_t step) {
  std::vector<std::uint8_t> udp = {0x12, 0x34, 0xA4, 0x76, 0, 0, 0, 0};
  udp[4] = static_cast<std::uint8_t>((payload.size() + 8) >> 8);
  udp[5] = static_cast<std::uint8_t>((payload.size() + 8) & 0xFF);
  udp.insert(udp.end(), payload.begin(), payload.end());
  std::vector<Packet> packets;
  for (std::size_t at = 0; at < udp.size(); at += step) {
    const std::size_t size = std::min(step, udp.size() - at);
    const bool more = at + size < udp.size();
    const auto field = static_cast<std::uint16_t>(at / 8 | (more ? 0x2000u : 0u));
    const auto total = static_cast<std::uint16_t>(20 + size);
    Packet p = {0x45,
                0,
                static_cast<std::uint8_t>(total >> 8),
                static_cast<std::uint8_t>(total & 0xFF),
                static_cast<std::uint8_t>(identification >> 8),
                static_cast<std::uint8_t>(identification & 0xFF),
                static_cast<std::uint8_t>(field >> 8),
                static_cast<std::uint8_t>(field & 0xFF),
                64,
                17,
                0,
                0,
                10,
                0,
                0,
                1,
                10,
                0,
                0,
                2};
    p.insert(p.end(), udp.begin() + static_cast<std::ptrdiff_t>(at),
             udp.begin() + static_cast<std::ptrdiff_t>(at + size));
    packets.push_back(p);
  }
  return packets;
}

PacketResult feed(UdpDecoder& decoder, const std::vector<Packet>& packets, Frame& frame) {
  PacketResult result = PacketResult::kIgnored;
  for (const Packet& p : packets) result = decoder.decode(p, LinkLayer::kRawIp, frame);
  return result;
}

TEST(UdpDecoder, AWholeDatagramAndOneInFragmentsInAnyOrder) {
  UdpDecoder decoder;
  Frame frame;
  const auto payload = payload_of(5000);
  ASSERT_EQ(feed(decoder, fragments(payload_of(100), 1, 1480), frame), PacketResult::kFrame);
  EXPECT_EQ(frame.source.port, 0x1234);
  EXPECT_EQ(frame.destination.port, 42102);
  EXPECT_EQ(frame.source.address.to_v4(), 0x0A000001u);
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    auto packets = fragments(payload, static_cast<std::uint16_t>(100 + round), 8 * (10 + round));
    std::shuffle(packets.begin(), packets.end(), random);
    ASSERT_EQ(feed(decoder, packets, frame), PacketResult::kFrame) << round;
    ASSERT_TRUE(std::equal(payload.begin(), payload.end(), frame.payload.begin(), frame.payload.end()));
  }
}

TEST(UdpDecoder, TwoSendersAtATimeAreDistinguished) {
  UdpDecoder decoder;
  Frame frame;
  const auto a = payload_of(4000, 1), b = payload_of(4000, 2);
  const auto pa = fragments(a, 7, 1000), pb = fragments(b, 8, 1000);
  for (std::size_t i = 0; i + 1 < pa.size(); ++i) {
    EXPECT_EQ(decoder.decode(pa[i], LinkLayer::kRawIp, frame), PacketResult::kIncomplete);
    EXPECT_EQ(decoder.decode(pb[i], LinkLayer::kRawIp, frame), PacketResult::kIncomplete);
  }
  ASSERT_EQ(decoder.decode(pb.back(), LinkLayer::kRawIp, frame), PacketResult::kFrame);
  EXPECT_TRUE(std::equal(b.begin(), b.end(), frame.payload.begin(), frame.payload.end()));
  ASSERT_EQ(decoder.decode(pa.back(), LinkLayer::kRawIp, frame), PacketResult::kFrame);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), frame.payload.begin(), frame.payload.end()));
}

TEST(UdpDecoder, ADatagramWithAMissingFragmentIsDroppedAndTheNextOneIsComplete) {
  UdpDecoder decoder;
  Frame frame;
  auto lost = 0;
  for (std::uint16_t i = 0; i < 40; ++i) {
    auto packets = fragments(payload_of(3000), i, 1000);
    if (i < 20) packets.erase(packets.begin() + 1);
    PacketResult result = PacketResult::kIgnored;
    for (const Packet& p : packets) {
      result = decoder.decode(p, LinkLayer::kRawIp, frame);
      lost += result == PacketResult::kFragmentLost ? 1 : 0;
    }
    if (i >= 20) {
      EXPECT_EQ(result, PacketResult::kFrame) << i;
    }
  }
  EXPECT_GE(lost, 4) << "dropped datagrams are reported";
}

TEST(UdpDecoder, ARepeatedFragmentIsIgnored) {
  UdpDecoder decoder;
  Frame frame;
  const auto payload = payload_of(3003);
  const auto packets = fragments(payload, 5, 1000);
  for (std::size_t i = 0; i + 1 < packets.size(); ++i) {
    EXPECT_EQ(decoder.decode(packets[i], LinkLayer::kRawIp, frame), PacketResult::kIncomplete);
    EXPECT_EQ(decoder.decode(packets[i], LinkLayer::kRawIp, frame), PacketResult::kIncomplete);
  }
  ASSERT_EQ(decoder.decode(packets.back(), LinkLayer::kRawIp, frame), PacketResult::kFrame);
  EXPECT_TRUE(std::equal(payload.begin(), payload.end(), frame.payload.begin(), frame.payload.end()));
  EXPECT_EQ(decoder.unfinished(), 0u);
  EXPECT_EQ(decoder.given_up(), 0u);
}

TEST(UdpDecoder, PartlyOverlappingFragmentsAreRejected) {
  const auto payload = payload_of(3000);
  const auto good = fragments(payload, 5, 1000);
  // The same data cut elsewhere: the middle fragment begins eight bytes too early or too late.
  for (const int shift : {-8, 8}) {
    UdpDecoder decoder;
    Frame frame;
    auto packets = good;
    Packet& middle = packets[1];
    const auto field = static_cast<std::uint16_t>((middle[6] << 8 | middle[7]) + shift / 8);
    middle[6] = static_cast<std::uint8_t>(field >> 8);
    middle[7] = static_cast<std::uint8_t>(field & 0xFF);
    bool lost = false;
    for (const Packet& p : packets) {
      const PacketResult result = decoder.decode(p, LinkLayer::kRawIp, frame);
      ASSERT_NE(result, PacketResult::kFrame) << shift;
      lost = lost || result == PacketResult::kFragmentLost;
    }
    EXPECT_TRUE(lost) << shift;
    EXPECT_EQ(feed(decoder, fragments(payload, 6, 1000), frame), PacketResult::kFrame) << "the next one is complete";
  }
}

TEST(UdpDecoder, DifferentRepeatedBytesAndDataBeyondTheLastFragmentAreRejected) {
  Frame frame;
  {
    UdpDecoder decoder;
    auto packets = fragments(payload_of(3000), 5, 1000);
    Packet forged = packets[1];
    forged.back() ^= 1;
    EXPECT_EQ(feed(decoder, {packets[0], packets[1]}, frame), PacketResult::kIncomplete);
    EXPECT_EQ(decoder.decode(forged, LinkLayer::kRawIp, frame), PacketResult::kFragmentLost);
    EXPECT_EQ(feed(decoder, {packets[2], packets[3]}, frame), PacketResult::kIncomplete);
    EXPECT_EQ(decoder.given_up(), 1u);
  }
  {
    UdpDecoder decoder;
    const auto longer = fragments(payload_of(5000), 5, 1000);
    const auto shorter = fragments(payload_of(2500), 5, 1000);
    EXPECT_EQ(feed(decoder, {longer[4]}, frame), PacketResult::kIncomplete);
    EXPECT_EQ(feed(decoder, {shorter[2]}, frame), PacketResult::kFragmentLost) << "its end lies before data";
    EXPECT_EQ(feed(decoder, {longer[4]}, frame), PacketResult::kFragmentLost) << "data beyond the end";
  }
}

TEST(UdpDecoder, ASenderWithAConstantIdentificationIsDecodedAfterALoss) {
  UdpDecoder decoder;
  Frame frame;
  auto cut = fragments(payload_of(3000, 1), 0, 1000);
  cut.erase(cut.begin() + 1);
  const auto payload = payload_of(3000, 2);
  EXPECT_EQ(feed(decoder, cut, frame), PacketResult::kIncomplete);
  ASSERT_EQ(feed(decoder, fragments(payload, 0, 1000), frame), PacketResult::kFrame);
  EXPECT_TRUE(std::equal(payload.begin(), payload.end(), frame.payload.begin(), frame.payload.end()));
  EXPECT_EQ(decoder.given_up(), 1u);
}

TEST(UdpDecoder, FragmentsHalfAMinuteApartAreNotOfOneDatagram) {
  UdpDecoder decoder;
  Frame frame;
  const auto packets = fragments(payload_of(1500), 9, 1000);
  frame.stamp_ns = 1'000'000'000;
  EXPECT_EQ(feed(decoder, {packets[0]}, frame), PacketResult::kIncomplete);
  frame.stamp_ns = 32'000'000'000;
  EXPECT_EQ(feed(decoder, {packets[1]}, frame), PacketResult::kFragmentLost);
  EXPECT_EQ(decoder.unfinished(), 1u);
}

TEST(UdpDecoder, DamagedHeadersAreNamed) {
  UdpDecoder decoder;
  Frame frame;
  const Packet good = fragments(payload_of(100), 1, 1480)[0];
  const auto with = [&](std::size_t at, std::uint8_t value) {
    Packet p = good;
    p[at] = value;
    return decoder.decode(p, LinkLayer::kRawIp, frame);
  };
  EXPECT_EQ(with(0, 0x41), PacketResult::kBadHeader) << "header of 4 bytes";
  EXPECT_EQ(with(0, 0x55), PacketResult::kIgnored) << "IP version 5";
  EXPECT_EQ(with(3, 0xFF), PacketResult::kTruncated) << "longer than captured";
  EXPECT_EQ(with(9, 6), PacketResult::kIgnored) << "TCP";
  EXPECT_EQ(with(25, 0xFF), PacketResult::kTruncated) << "UDP length";
  EXPECT_EQ(with(25, 3), PacketResult::kBadHeader);
  for (std::size_t size = 0; size < good.size(); ++size) {
    const Packet part(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(decoder.decode(part, LinkLayer::kRawIp, frame), PacketResult::kTruncated) << size;
  }
}

TEST(UdpDecoder, MutationsNeitherCrashNorInventMemory) {
  std::mt19937 random(4);
  UdpDecoder decoder;
  Frame frame;
  for (int round = 0; round < 30'000; ++round) {
    auto packets = fragments(payload_of(600), static_cast<std::uint16_t>(round), 200);
    for (Packet& p : packets) {
      if (random() % 2 == 0) p[random() % 28] = static_cast<std::uint8_t>(random());
      if (decoder.decode(p, LinkLayer::kRawIp, frame) != PacketResult::kFrame) continue;
      ASSERT_LE(frame.payload.size(), 65536u);
      unsigned sum = 0;
      for (const std::uint8_t b : frame.payload) sum += b;  // the sanitizer would find a view beyond the memory
      ASSERT_GE(sum, 0u);
    }
  }
}

TEST_F(Files, ABadLineIsNamedWithFileAndLineAndTheRestIsRead) {
  const auto file = write("drive.log", "(1.0) can0 123#01\n(1.1) can0 xyz#01\n\n(1.2) can0 123#02\nnonsense\n");
  const auto reader = open_recording(file, note_);
  Frame frame;
  int frames = 0;
  while (reader->next(frame)) ++frames;
  EXPECT_EQ(frames, 2);
  ASSERT_EQ(problems_.size(), 2u);
  EXPECT_NE(problems_[0].find("drive.log:2: "), std::string::npos) << problems_[0];
  EXPECT_NE(problems_[1].find("drive.log:5: "), std::string::npos) << problems_[1];
  EXPECT_EQ(reader->problems(), 2u);
}

TEST_F(Files, APcapOfFragmentsAndALogAreMergedByTime) {
  const auto big = payload_of(20'000);
  {
    simulator::wire::PcapWriter pcap(folder_ / "radar.pcap");
    for (int i = 0; i < 5; ++i) pcap.write(1'000'000'000 + i * 100'000'000LL, {0x0A000001, 5}, {0x0A000002, 6}, big);
  }
  const auto log = write("can.log", "(1.050000) can0 123#01\n(1.250000) can0 123#02\n(1.999999) can0 123#03\n");
  const auto reader = open_recordings({folder_ / "radar.pcap", log}, note_);
  Frame frame;
  std::vector<std::int64_t> stamps;
  std::string kinds;
  while (reader->next(frame)) {
    stamps.push_back(frame.stamp_ns);
    kinds += frame.kind == FrameKind::kUdp ? 'u' : 'c';
    if (frame.kind == FrameKind::kUdp) {
      ASSERT_TRUE(std::equal(big.begin(), big.end(), frame.payload.begin(), frame.payload.end()));
    }
  }
  EXPECT_EQ(kinds, "ucuucuuc");
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
  EXPECT_TRUE(problems_.empty());
}

TEST_F(Files, FilesThatCannotBeOpenedAreNamed) {
  const auto expect_named = [&](const std::vector<std::filesystem::path>& files, const std::string& name) {
    try {
      static_cast<void>(open_recordings(files, note_));
      ADD_FAILURE() << "opened";
    } catch (const OpenError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  expect_named({folder_ / "absent.log"}, "absent.log");
  expect_named({}, "");
  const auto cut = write("cut.pcap", std::string("\xd4\xc3\xb2\xa1\x02\x00", 6));
  expect_named({cut}, "cut.pcap");
}

TEST_F(Files, ATruncatedCaptureIsReadToItsEnd) {
  {
    simulator::wire::PcapWriter pcap(folder_ / "whole.pcap");
    for (int i = 0; i < 5; ++i) pcap.write(1'000'000'000 + i, {0x0A000001, 5}, {0x0A000002, 6}, payload_of(100));
  }
  std::filesystem::resize_file(folder_ / "whole.pcap", std::filesystem::file_size(folder_ / "whole.pcap") - 20);
  const auto reader = open_recording(folder_ / "whole.pcap", note_);
  Frame frame;
  int frames = 0;
  while (reader->next(frame)) ++frames;
  EXPECT_EQ(frames, 4);
  ASSERT_EQ(problems_.size(), 1u);
  EXPECT_NE(problems_[0].find("whole.pcap"), std::string::npos);
}

}  // namespace
}  // namespace boresight::recording
