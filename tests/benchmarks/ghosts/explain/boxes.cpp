#include "tests/benchmarks/ghosts/explain/boxes.hpp"

#include <cstdio>
#include <numbers>
#include <ostream>

namespace boresight::bench {

namespace {

struct Box {
  const char* what;
  std::uint32_t id;
  double age_s, x_m, y_m, heading_rad, length_m, width_m, vx_mps, vy_mps;
};

void write_box(std::uint64_t seed, const Observed& observed, const Box& box, std::ostream& out) {
  char text[200];
  std::snprintf(text, sizeof text, "%llu,%.4f,%u,%s,%u,%.2f,%.2f,%.2f,%.1f,%.2f,%.2f,%.2f,%.2f\n",
                static_cast<unsigned long long>(seed), observed.event.t_s, observed.scan.header.source_id, box.what,
                box.id, box.age_s, box.x_m, box.y_m, box.heading_rad * 180.0 / std::numbers::pi, box.length_m,
                box.width_m, box.vx_mps, box.vy_mps);
  out << text;
}

}  // namespace

const char* boxes_header() {
  return "seed,time_s,radar,what,id,age_s,x_vehicle_m,y_vehicle_m,heading_deg,length_m,width_m,"
         "vx_over_ground_mps,vy_over_ground_mps\n";
}

void write_boxes(std::uint64_t seed, const Observed& observed, std::ostream& out) {
  for (const closed_loop::Object& o : observed.objects) {
    write_box(seed, observed,
              {"object", o.id, observed.event.t_s, o.position_m.x(), o.position_m.y(), o.heading_rad, o.length_m,
               o.width_m, o.velocity_mps.x(), o.velocity_mps.y()},
              out);
  }
  for (std::uint32_t i = 0; i < observed.tracks.number_of_tracks; ++i) {
    const Track& t = observed.tracks.tracks[i];
    write_box(seed, observed,
              {t.status == TrackStatus::kConfirmed ? "track" : "tentative", t.tracking_id, t.age_s,
               t.position_vehicle_m[0], t.position_vehicle_m[1], t.heading_rad, t.length_m, t.width_m,
               t.velocity_over_ground_mps[0], t.velocity_over_ground_mps[1]},
              out);
  }
}

}  // namespace boresight::bench
