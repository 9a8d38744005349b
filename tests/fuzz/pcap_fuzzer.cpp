// Whole recordings whose format the reader detects: captures, candump logs, and other files. Their stamps are converted
// to this ECU's clock.
#include <cstdlib>

#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"
#include "tests/fuzz/memory_file.hpp"

using namespace boresight::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static boresight::fuzz::MemoryFile file;
  file.fill({data, size});
  std::uint64_t problems = 0;
  try {
    const auto reader = open_recording(file.path(), [&](const std::string&) { ++problems; });
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
