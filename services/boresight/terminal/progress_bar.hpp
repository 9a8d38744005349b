// A bar on the terminal for work of known size, a running figure for work of unknown size; silent where the output is
// no terminal.
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

  /// Where it is not, one may say a few words in lines instead.
  [[nodiscard]] bool is_terminal() const { return is_terminal_; }
  /// Whether anything is to be shown now: the terminal is redrawn ten times a second at most. Cheap enough to be asked
  /// for every few hundred frames.
  [[nodiscard]] bool is_due();
  void show(double share, std::string_view text = {});
  /// Makes room for a line of other output; the bar comes back with the next show().
  void wipe();

 private:
  std::string label_;
  std::FILE* stream_;
  bool is_terminal_;
  bool shown_ = false;
  std::int64_t next_ns_ = 0;
};

}  // namespace boresight::terminal
