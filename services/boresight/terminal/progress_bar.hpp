// A progress bar on the terminal, or a running text if the amount of work is unknown. Silent if the output is no
// terminal.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace boresight::terminal {

/// "label [####    ]  50 %  text", fitted into `columns`; `share` beyond 0…1 is limited, a negative one means unknown.
[[nodiscard]] std::string render_bar(std::string_view label, double share, std::string_view text, int columns);

class ProgressBar {
 public:
  /// `stream` must outlive the bar.
  explicit ProgressBar(std::string label, std::FILE* stream = stderr);
  /// Wipes the bar.
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// False: the caller may print a few lines of progress instead.
  [[nodiscard]] bool is_terminal() const { return is_terminal_; }
  /// Whether to call show() now; limits it to ten times a second. Cheap enough for a call every few hundred frames.
  [[nodiscard]] bool is_due();
  void show(double share, std::string_view text = {});
  /// Clears the line for other output; the next show() draws the bar again.
  void wipe();

 private:
  std::string label_;
  std::FILE* stream_;
  bool is_terminal_;
  bool shown_ = false;
  std::int64_t next_ns_ = 0;
};

}  // namespace boresight::terminal
