// Writes the gateway's output to shared memory.
#pragma once

#include "services/common/runtime/node.hpp"
#include "services/ingest_gateway/core/sink.hpp"
#include "services/ingest_gateway/live_links.hpp"

namespace boresight::ingest {

class BusSink : public Sink {
 public:
  explicit BusSink(runtime::Node& node);

  RadarScan* begin_scan() override;
  void publish_scan(std::uint32_t radar_id, const MeasurementTime& time) override;
  void discard_scan() override { scan_ = {}; }
  EgoMotion* begin_ego() override;
  void publish_ego(const MeasurementTime& time) override;
  void fault(Fault fault, std::string_view what, std::uint32_t radar_id) override;

  SourceStatistics& statistics(std::uint32_t radar_id) override { return node_.source_statistics(radar_id); }

  void send(const recording::Frame& frame) override {
    if (links_ != nullptr) links_->send(frame);
  }
  void join(const recording::Endpoint& group, std::string_view interface) override {
    if (links_ != nullptr) links_->join(group, interface);
  }
  void leave(const recording::Endpoint& group, std::string_view interface) override {
    if (links_ != nullptr) links_->leave(group, interface);
  }

  /// Live links for outgoing frames; without links, as with recordings, frames are not sent.
  void use(Links& links) { links_ = &links; }
  /// Call when a frame is taken from its link: begins the ingest stage.
  void frame_begins(std::int64_t now_ns) { begin_ns_ = now_ns; }

 private:
  runtime::Node& node_;
  runtime::Publisher<RadarScan> scans_;
  runtime::Publisher<EgoMotion> egos_;
  runtime::Loan<RadarScan> scan_;
  runtime::Loan<EgoMotion> ego_;
  std::int64_t begin_ns_ = 0;
  Links* links_ = nullptr;
};

}  // namespace boresight::ingest
