// Text of other participants, as a terminal shows it.
#include <gtest/gtest.h>

#include "services/boresight/diagnostics/diagnostics_text.hpp"
#include "services/boresight/diagnostics/fault_text.hpp"

namespace boresight::diagnostics_text {
namespace {

const std::string kHostile =
    "\x1b]0;title\x07\x1b[2J\x9b"
    "31m\xc2\x9b"
    "0m\rname\n\xe2\x80\xae";

/// Neither a control character of one byte, nor of two (C1), nor a change of the reading direction.
void expect_harmless(std::string text, bool is_page = false) {
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    EXPECT_TRUE(byte >= 0x20 || (is_page && c == '\n')) << "byte " << int{byte} << " in " << text;
    EXPECT_NE(byte, 0x7F);
  }
  for (const char* const sequence : {"\xc2\x9b", "\xe2\x80\xae", "\x1b"}) {
    EXPECT_EQ(text.find(sequence), std::string::npos) << text;
  }
}

TEST(HostileText, OfARadarIsHarmless) {
  diagnostics::SensorHealth s;
  s.radar_name(kHostile);
  s.vehicle_name(kHostile);
  s.explanation(kHostile);
  s.trouble_codes(kHostile);
  s.finding(kHostile);
  s.alignment_reason(kHostile);
  s.data_qualifier(static_cast<diagnostics::DataQualifier>(77));
  s.extended_qualifier(static_cast<diagnostics::ExtendedQualifier>(77));
  s.yaw().observable(true);
  s.yaw().effect(static_cast<diagnostics::AxisEffect>(77));
  s.time_ns(INT64_MIN);
  expect_harmless(to_line(s));
  s.time_ns(INT64_MAX);
  expect_harmless(to_line(s));
  const std::string json = to_json(s);
  EXPECT_EQ(json.find('\x1b'), std::string::npos);
  EXPECT_EQ(json.find('\n'), json.size() - 1) << "one line";
}

TEST(HostileText, OfTheSystemIsHarmless) {
  diagnostics::SystemHealth s;
  s.vehicle_name(kHostile);
  s.services(kHostile + ":dead " + kHostile);
  s.pipeline().trouble_codes(kHostile);
  s.overall(static_cast<diagnostics::DataQualifier>(77));
  expect_harmless(to_line(s));
  EXPECT_EQ(to_json(s).find('\x1b'), std::string::npos);
}

TEST(HostileText, OfAnArrayIsHarmless) {
  diagnostic_msgs::msg::dds_::DiagnosticArray_ array;
  array.header_().frame_id_(kHostile);
  diagnostic_msgs::msg::dds_::DiagnosticStatus_ status;
  status.level_(200);
  status.name_(kHostile);
  status.message_(kHostile);
  status.hardware_id_(kHostile);
  diagnostic_msgs::msg::dds_::KeyValue_ value;
  value.key_(kHostile);
  value.value_(kHostile);
  status.values_().push_back(value);
  array.status_().push_back(status);
  expect_harmless(to_lines(array));
  EXPECT_EQ(to_json(array).find('\x1b'), std::string::npos);
}

TEST(HostileText, OfAnAbsentSourceIsHarmless) {
  const dds::Presence presence{"topic", kHostile, kHostile, dds::Absence::kDeadline, 1'600'000'000};
  expect_harmless(to_line(presence, 0));
  EXPECT_NE(to_line(presence, 0).find("STALE since 1.6 s: no sample within the deadline"), std::string::npos);
  EXPECT_EQ(to_json(presence, 0).find('\x1b'), std::string::npos);
}

TEST(HostileText, OfAFaultRecordIsHarmless) {
  diagnostics::FaultRecord record;
  record.code(kHostile);
  record.name(kHostile);
  record.subject(kHostile);
  record.meaning(kHostile);
  record.remedy(kHostile);
  record.first().time_ns(1);
  record.first().software(kHostile);
  record.latest().time_ns(INT64_MAX);
  expect_harmless(fault_list({record}, kHostile), true);
  expect_harmless(fault_page(record), true);
  EXPECT_EQ(to_json(record).find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace boresight::diagnostics_text
