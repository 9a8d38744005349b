#include "services/replay/player.hpp"

#include <cstdio>
#include <iostream>
#include <string>

#include "services/common/recording/reader.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/core/pacing.hpp"

namespace boresight::replay {

namespace {

/// A damaged recording may have a problem per line: the first ones are logged, all are counted.
class ProblemLog {
 public:
  void operator()(const std::string& problem) {
    constexpr std::uint64_t kShown = 10;
    if (++count_ <= kShown) runtime::log::warning("{}", problem);
    if (count_ == kShown) runtime::log::warning("further problems of the recordings are counted, not logged");
  }

 private:
  std::uint64_t count_ = 0;
};

}  // namespace

PlayResult play(const PlayOptions& options, Sender& sender) {
  PlayResult result;
  ProblemLog problems;
  for (unsigned loop = 0; loop < options.loops && !result.stopped; ++loop) {
    const auto reader =
        recording::open_recordings(options.files, [&problems](const std::string& text) { problems(text); });
    Pacing pacing(options.speed);
    recording::Frame frame;
    std::int64_t first_ns = 0;
    bool any = false;
    std::int64_t step_end_ns = 0;
    double played_s = 0.0;
    while (reader->next(frame)) {
      if (!any) first_ns = frame.stamp_ns;
      if (!any) step_end_ns = frame.stamp_ns;
      any = true;
      const double at_s = static_cast<double>(frame.stamp_ns - first_ns) * 1e-9;
      if (at_s < options.start_s) continue;
      if (at_s > options.start_s + options.duration_s) break;
      if (options.step_s > 0.0) {
        if (frame.stamp_ns >= step_end_ns) {
          std::printf("%.3f s: Enter for the next %.3f s ", at_s, options.step_s);
          std::fflush(stdout);
          std::string line;
          if (!std::getline(std::cin, line)) result.stopped = true;
          step_end_ns = frame.stamp_ns + static_cast<std::int64_t>(options.step_s * 1e9);
        }
      } else {
        const std::int64_t now_ns = runtime::monotonic_now_ns();
        sender.wait_until(pacing.due_ns(frame.stamp_ns, now_ns));
      }
      result.stopped = result.stopped || runtime::stop_signalled();
      if (result.stopped) break;
      ++(sender.send(frame) ? result.sent : result.lost);
      played_s = at_s - options.start_s;
    }
    sender.end_recording();
    result.recorded_s += played_s;
    result.malformed += reader->problems();
  }
  return result;
}

}  // namespace boresight::replay
