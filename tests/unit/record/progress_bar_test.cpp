#include "services/boresight/terminal/progress_bar.hpp"

#include <cstdio>

#include <gtest/gtest.h>

namespace boresight::terminal {
namespace {

TEST(ProgressBar, ShowsShareAndTextAndNeverWraps) {
  EXPECT_EQ(render_bar("decoding", 0.5, "12 MB/s", 80), "decoding [###############               ]  50 %  12 MB/s");
  EXPECT_EQ(render_bar("decoding", 0.0, "", 80), "decoding [                              ]   0 %");
  EXPECT_EQ(render_bar("decoding", 7.0, "", 80), "decoding [##############################] 100 %");
  EXPECT_EQ(render_bar("recording", -1.0, "5 frames", 80), "recording  5 frames") << "the end is not known";
  EXPECT_EQ(render_bar("recording", -1.0, "5 frames", 12), "recording  ");
}

TEST(ProgressBar, IsSilentWhereThereIsNoTerminal) {
  std::FILE* const file = std::tmpfile();
  {
    ProgressBar bar("decoding", file);
    EXPECT_FALSE(bar.is_due());
    bar.show(0.5, "text");
  }
  EXPECT_EQ(std::ftell(file), 0);
  std::fclose(file);
}

}  // namespace
}  // namespace boresight::terminal
