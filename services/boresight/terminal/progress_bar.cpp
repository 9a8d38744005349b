#include "services/boresight/terminal/progress_bar.hpp"

#include <algorithm>
#include <chrono>

#include <sys/ioctl.h>
#include <unistd.h>

namespace boresight::terminal {

namespace {

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

std::string render_bar(std::string_view label, double share, std::string_view text, int columns) {
  constexpr int kWidth = 30;
  std::string line(label);
  if (share >= 0.0) {
    const double limited = std::min(share, 1.0);
    const int done = static_cast<int>(limited * kWidth);
    line += " [" + std::string(static_cast<std::size_t>(done), '#') +
            std::string(static_cast<std::size_t>(kWidth - done), ' ') + "] ";
    const std::string percent = std::to_string(static_cast<int>(limited * 100.0));
    line += std::string(3 - percent.size(), ' ') + percent + " %";
  }
  if (!text.empty()) line += "  " + std::string(text);
  // A wrapped line could not be overwritten.
  if (columns > 1 && line.size() >= static_cast<std::size_t>(columns))
    line.resize(static_cast<std::size_t>(columns) - 1);
  return line;
}

ProgressBar::ProgressBar(std::string label, std::FILE* stream)
    : label_(std::move(label)), stream_(stream), is_terminal_(isatty(fileno(stream)) != 0) {}

ProgressBar::~ProgressBar() {
  wipe();
}

bool ProgressBar::is_due() {
  constexpr std::int64_t kInterval_ns = 100'000'000;
  if (!is_terminal_) return false;
  const std::int64_t now = now_ns();
  if (now < next_ns_) return false;
  next_ns_ = now + kInterval_ns;
  return true;
}

void ProgressBar::show(double share, std::string_view text) {
  if (!is_terminal_) return;
  winsize size{};
  const int columns = ioctl(fileno(stream_), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
  std::fprintf(stream_, "\r%s\x1B[K", render_bar(label_, share, text, columns).c_str());
  std::fflush(stream_);
  shown_ = true;
}

void ProgressBar::wipe() {
  if (!shown_) return;
  std::fprintf(stream_, "\r\x1B[K");
  std::fflush(stream_);
  shown_ = false;
}

}  // namespace boresight::terminal
