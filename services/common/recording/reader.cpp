#include "services/common/recording/reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "services/common/recording/candump_reader.hpp"
#include "services/common/recording/pcap_reader.hpp"
#include "services/common/recording/pcapng_reader.hpp"

namespace boresight::recording {

namespace {

class MergedReader : public Reader {
 public:
  explicit MergedReader(std::vector<std::unique_ptr<Reader>> readers) {
    for (auto& reader : readers) sources_.push_back({std::move(reader), {}, false, false});
  }
  bool next(Frame& frame) override {
    Source* earliest = nullptr;
    for (Source& source : sources_) {
      // Only now: the last delivered payload stays valid until this call.
      if (!source.loaded && !source.ended) source.ended = !(source.loaded = source.reader->next(source.frame));
      if (source.loaded && (earliest == nullptr || source.frame.stamp_ns < earliest->frame.stamp_ns)) {
        earliest = &source;
      }
    }
    if (earliest == nullptr) return false;
    frame = earliest->frame;
    earliest->loaded = false;
    return true;
  }
  Counts counts() const override {
    Counts sum;
    for (const Source& source : sources_) {
      const Counts counts = source.reader->counts();
      sum.frames += counts.frames;
      sum.problems += counts.problems;
      sum.error_frames += counts.error_frames;
      sum.ignored += counts.ignored;
      sum.backwards += counts.backwards;
    }
    return sum;
  }
  Progress progress() const override {
    Progress sum;
    bool known = true;
    for (const Source& source : sources_) {
      const Progress progress = source.reader->progress();
      sum.position_bytes += progress.position_bytes;
      sum.total_bytes += progress.total_bytes;
      known = known && progress.total_bytes > 0;
    }
    if (!known) sum.total_bytes = 0;
    return sum;
  }

 private:
  struct Source {
    std::unique_ptr<Reader> reader;
    Frame frame;
    bool loaded;
    bool ended;
  };
  std::vector<Source> sources_;
};

/// Formats that are not supported but likely to be tried: one clear error instead of an error per line.
std::string_view known_but_unsupported(std::span<const std::uint8_t> head) {
  struct Format {
    std::string_view magic, name;
  };
  using namespace std::string_view_literals;
  constexpr std::array<Format, 6> kFormats = {{{"\x1F\x8B"sv, "compressed by gzip; unpack it first"},
                                               {"\xFD\x37zXZ"sv, "compressed by xz; unpack it first"},
                                               {"\x28\xB5\x2F\xFD"sv, "compressed by zstd; unpack it first"},
                                               {"LOGG"sv, "a Vector BLF log, which is not supported"},
                                               {"MDF     "sv, "an ASAM MDF file, which is not supported"},
                                               {"#ROSBAG"sv, "a ROS bag, which is not supported"}}};
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  for (const Format& format : kFormats) {
    if (text.starts_with(format.magic)) return format.name;
  }
  return {};
}

}  // namespace

std::unique_ptr<Reader> open_recording(const std::filesystem::path& file, OnProblem on_problem,
                                       const ReadOptions& options) {
  auto source = std::make_unique<ByteSource>(file);
  if (is_pcapng(source->head())) {
    return std::make_unique<PcapngReader>(std::move(source), std::move(on_problem), options);
  }
  if (is_pcap(source->head())) {
    return std::make_unique<PcapReader>(std::move(source), std::move(on_problem), options);
  }
  if (const std::string_view format = known_but_unsupported(source->head()); !format.empty()) {
    throw OpenError(source->name() + ": is " + std::string(format));
  }
  return std::make_unique<CandumpReader>(std::move(source), std::move(on_problem));
}

std::unique_ptr<Reader> open_recordings(const std::vector<std::filesystem::path>& files, const OnProblem& on_problem,
                                        const ReadOptions& options) {
  if (files.empty()) throw OpenError("no recording given");
  std::vector<std::unique_ptr<Reader>> readers;
  for (const auto& file : files) readers.push_back(open_recording(file, on_problem, options));
  if (readers.size() == 1) return std::move(readers.front());
  return std::make_unique<MergedReader>(std::move(readers));
}

}  // namespace boresight::recording
