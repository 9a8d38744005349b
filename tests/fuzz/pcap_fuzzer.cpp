// Whole recordings whose format the reader detects: captures, candump logs, and other files. Their stamps are converted
// to this ECU's clock.
#include <cstdlib>

#include <sys/mman.h>
#include <unistd.h>

#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

using namespace boresight::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = memfd_create("recording", MFD_CLOEXEC);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  static const std::string name = "/proc/self/fd/" + std::to_string(file);
  std::uint64_t problems = 0;
  try {
    const auto reader = open_recording(name, [&](const std::string&) { ++problems; });
    Frame frame;
    boresight::ingest::RecordingClock clock;
    bool jumped = false;
    std::uint64_t frames = 0;
    while (reader->next(frame)) {
      static_cast<void>(clock.map(frame.stamp_ns, 1'000'000, jumped));
      unsigned sum = 0;
      for (const std::uint8_t byte : frame.payload) sum += byte;
      if (++frames > size || sum > 255u * 65536u) std::abort();  // every frame takes at least a byte of the file
    }
    const Counts counts = reader->counts();
    if (counts.frames != frames || counts.problems != problems) std::abort();
    if (reader->next(frame)) std::abort();
    if (reader->progress().position_bytes > size) std::abort();
  } catch (const OpenError&) {
  }
  return 0;
}
