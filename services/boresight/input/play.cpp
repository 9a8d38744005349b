#include "services/boresight/input/play.hpp"

namespace boresight::input {

void play(const std::vector<std::filesystem::path>& recordings, ingest::Gateway& gateway, Problems& problems,
          const std::function<void(const recording::Progress&)>& look) {
  const auto reader =
      recording::open_recordings(recordings, [&problems](const std::string& text) { problems.bad_line(text); });
  recording::Frame frame;
  for (std::uint64_t frames = 1; reader->next(frame); ++frames) {
    // The recording's own clock is the only one, so that the result depends on nothing else.
    gateway.take(frame, {frame.stamp_ns, 0, TimeSource::kLinkArrival});
    problems.good_line();
    constexpr std::uint64_t kFramesBetweenLooks = 256;
    if (frames % kFramesBetweenLooks == 0) look(reader->progress());
  }
  gateway.finish();
}

}  // namespace boresight::input
