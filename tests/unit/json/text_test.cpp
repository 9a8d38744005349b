// JSON as text: numbers, names and damaged characters.
#include "services/boresight/json/text.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace boresight::json {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(JsonText, NumbersThatAreNotFiniteBecomeNull) {
  const Value value = {{"a", kNaN}, {"b", HUGE_VAL}, {"c", significant(kNaN)}, {"d", shortest(std::nanf(""))}};
  EXPECT_EQ(line(value), "{\"a\":null,\"b\":null,\"c\":null,\"d\":null}\n");
}

TEST(JsonText, NamesKeepBlanksQuotesAndLettersAndDamagedBytesAreReplaced) {
  const std::string name = "front \"long\", größte\n\\";
  const std::string text = line({{"name", name}, {"damaged", "a\xFF"}});
  EXPECT_EQ(text, "{\"name\":\"front \\\"long\\\", größte\\n\\\\\",\"damaged\":\"a\xEF\xBF\xBD\"}\n");
  EXPECT_EQ(Value::parse(text).at("name").get<std::string>(), name);
}

TEST(JsonText, ControlCharactersAreEscapedAndTheValueStaysTheSame) {
  // CSI, which begins a command of a terminal; next line; delete; right-to-left override. No control: no-break space.
  const std::string name =
      "a\xC2\x9B"
      "31m\xC2\x85\x7F\xE2\x80\xAE\xC2\xA0ü";
  const std::string text = line({{"name", name}});
  EXPECT_EQ(text, "{\"name\":\"a\\u009b31m\\u0085\\u007f\\u202e\xC2\xA0ü\"}\n");
  EXPECT_EQ(Value::parse(text).at("name").get<std::string>(), name);
  EXPECT_EQ(document({{"\xC2\x80", 1}}), "{\n  \"\\u0080\": 1\n}\n");
}

TEST(JsonText, KeysStayInTheOrderInWhichTheyWereAdded) {
  Value value;
  value["z"] = 1;
  value["a"] = 2;
  EXPECT_EQ(line(value), "{\"z\":1,\"a\":2}\n");
  EXPECT_EQ(document(value), "{\n  \"z\": 1,\n  \"a\": 2\n}\n");
}

TEST(JsonText, NumbersHaveTheDigitsThatTheirSourceSupports) {
  EXPECT_EQ(line(shortest(0.3F)), "0.3\n");
  EXPECT_EQ(line(significant(1.0 / 3.0)), "0.333333333\n");
  EXPECT_EQ(line(significant(-123456789.4)), "-123456789.0\n");
  EXPECT_EQ(line(significant(-0.0)), "0.0\n");
  EXPECT_EQ(line(1700000000.123457), "1700000000.123457\n");
}

}  // namespace
}  // namespace boresight::json
