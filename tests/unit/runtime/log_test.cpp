#include "services/common/runtime/log.hpp"

#include <string>

#include <gtest/gtest.h>

#include "services/common/text/printable.hpp"

namespace boresight {
namespace {

using text::LineBreaks;
using text::printable;

TEST(PrintableText, KeepsUtf8) {
  for (const char* const same : {"", "front left", "+2.5°", "größte – ±σ …", "雷达", "\U0001F697"})
    EXPECT_EQ(printable(same), same);
}

TEST(PrintableText, ReplacesControlCharactersOfBothRanges) {
  EXPECT_EQ(printable("\x1b[31mred\x1b[0m"), "?[31mred?[0m");
  EXPECT_EQ(printable("a\r\n\tb\x7f"), "a???b?");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "?31m")
      << "the control sequence introducer of eight bits";
  EXPECT_EQ(printable("\u2028x\u202ey\u2066z\ufeff"), "?x?y?z?") << "line separator, marks of direction";
}

TEST(PrintableText, ReplacesEachByteThatIsNotUtf8) {
  EXPECT_EQ(printable("\xff\xfe"), "??");
  EXPECT_EQ(printable("gr\xf6\xdf"
                      "te"),
            "gr??te")
      << "Latin-1";
  EXPECT_EQ(printable("\xc0\xaf"), "??") << "overlong";
  EXPECT_EQ(printable("\xe0\x80\xaf"), "???") << "overlong";
  EXPECT_EQ(printable("\xed\xa0\x80"), "???") << "a surrogate";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "????") << "beyond the last character";
  EXPECT_EQ(printable("\xc2"), "?") << "cut";
  EXPECT_EQ(printable("\xe2\x82"
                      "a\xb0"),
            "??a?");
}

TEST(PrintableText, ChangesNothingWhenAppliedTwice) {
  const std::string once = printable("\x1b[2J 2.5° \xff\n");
  EXPECT_EQ(printable(once), once);
}

TEST(PrintableText, KeepsLineBreaksOnRequest) {
  EXPECT_EQ(printable("a.toml:1: x\nb\x1b\n", LineBreaks::kKept), "a.toml:1: x\nb?\n");
}

TEST(Log, ShowsTextFromOutsideWithoutControlCharacters) {
  testing::internal::CaptureStderr();
  runtime::log::initialise("boresight-test");
  runtime::log::warning("radar {}: {:+.1f}°", "front\x1b]0;owned\x07\nforged line\xff", 2.5);
  const std::string logged = testing::internal::GetCapturedStderr();
  EXPECT_NE(logged.find("boresight-test: radar front?]0;owned??forged line?: +2.5°\n"), std::string::npos) << logged;
  EXPECT_EQ(logged.find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace boresight
