#include "services/boresight/record/recorder.hpp"

#include <stdexcept>

#include <poll.h>

#include "services/boresight/record/capture_error.hpp"

namespace boresight::record {

namespace {

std::filesystem::path unused(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) throw CaptureError(file.string() + ": exists already");
  return file;
}

}  // namespace

OutputFiles name_files(const CapturePlan& plan, const std::filesystem::path& out, const std::string& date_and_time) {
  const std::string extension = out.extension().string();
  const bool is_file = extension == ".log" || extension == ".pcap";
  OutputFiles files;
  if (is_file) {
    if (plan.can.empty() == plan.packets.empty() || plan.packets.size() > 1) {
      throw std::invalid_argument(out.string() + ": several files are needed; give a folder");
    }
    if ((extension == ".log") != plan.packets.empty()) {
      throw std::invalid_argument(out.string() + ": CAN goes into .log, packets go into .pcap");
    }
    if (plan.packets.empty()) {
      files.can = unused(out);
    } else {
      files.packets.push_back(unused(out));
    }
    return files;
  }
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error) throw CaptureError(out.string() + ": " + error.message());
  if (!plan.can.empty()) files.can = unused(out / ("boresight-" + date_and_time + ".log"));
  for (const PacketSource& source : plan.packets) {
    files.packets.push_back(unused(out / ("boresight-" + date_and_time + "-" + source.interface + ".pcap")));
  }
  return files;
}

Recorder::Recorder(const CapturePlan& plan, const std::filesystem::path& out, const std::string& date_and_time,
                   OnProblem on_problem)
    : on_problem_(std::move(on_problem)) {
  for (const std::string& interface : plan.can) can_.push_back(std::make_unique<CanCapture>(interface));
  for (const PacketSource& source : plan.packets) packets_.push_back(std::make_unique<PacketCapture>(source));
  const OutputFiles files = name_files(plan, out, date_and_time);
  if (!files.can.empty()) can_writer_ = std::make_unique<recording::CandumpWriter>(files.can);
  for (std::size_t i = 0; i < packets_.size(); ++i) {
    packet_writers_.push_back(packets_[i]->make_writer(files.packets[i]));
  }
}

void Recorder::tell(const std::string& problem) {
  if (problem.empty()) return;
  ++interruptions_;
  on_problem_(problem);
}

void Recorder::turn(int timeout_ms) {
  std::vector<pollfd> waiting;
  for (const auto& capture : can_) waiting.push_back({capture->descriptor(), POLLIN, 0});
  for (const auto& capture : packets_) waiting.push_back({capture->descriptor(), POLLIN, 0});
  static_cast<void>(poll(waiting.data(), waiting.size(), timeout_ms));  // a signal or an error is seen below
  std::string problem;
  for (const auto& capture : can_) {
    if (capture->descriptor() < 0) continue;
    capture->read(*can_writer_, problem);
    tell(problem);
  }
  for (std::size_t i = 0; i < packets_.size(); ++i) {
    if (!packets_[i]->is_open()) continue;
    packets_[i]->read(*packet_writers_[i], problem);
    tell(problem);
  }
}

void Recorder::each_second() {
  if (can_writer_) can_writer_->flush();
  for (const auto& writer : packet_writers_) writer->flush();
  for (const auto& capture : can_) {
    if (capture->descriptor() < 0) capture->reopen();
  }
  for (const auto& capture : packets_) {
    if (!capture->is_open()) capture->reopen();
  }
}

std::vector<FileSummary> Recorder::summaries() const {
  std::vector<FileSummary> list;
  if (can_writer_) {
    FileSummary summary{can_writer_->name(), "can", {0, can_writer_->bytes(), 0}};
    for (const auto& capture : can_) {
      summary.what += (&capture == &can_.front() ? " " : ", ") + capture->interface();
      summary.totals.frames += capture->frames();
      summary.totals.dropped += capture->dropped();
    }
    list.push_back(summary);
  }
  for (std::size_t i = 0; i < packets_.size(); ++i) {
    list.push_back({packet_writers_[i]->name(),
                    packets_[i]->interface(),
                    {packets_[i]->packets(), packet_writers_[i]->bytes(), packets_[i]->dropped()}});
  }
  return list;
}

Totals Recorder::totals() const {
  Totals sum;
  for (const FileSummary& summary : summaries()) {
    sum.frames += summary.totals.frames;
    sum.bytes += summary.totals.bytes;
    sum.dropped += summary.totals.dropped;
  }
  return sum;
}

}  // namespace boresight::record
