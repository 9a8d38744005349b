// Drives as tables for the tests of the offline tool, and a check of JSON.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "services/simulator/alignment/drive.hpp"

namespace boresight::align::testing {

struct Tables {
  std::string drive, ego;
};

/// A cell of column `is_stationary`, from the truth.
using Truth = std::function<std::string(bool stationary)>;

/// Simulated, with every digit that floats have. Times begin at 1 s.
inline Tables simulated_tables(const simulator::AlignmentSpec& spec, const Truth& truth) {
  Tables tables{"t,radar,range,az,el,vr,is_stationary\n", "t,v,yaw_rate\n"};
  simulator::AlignmentDrive drive(spec);
  for (simulator::AlignmentEvent event; drive.next(event);) {
    if (event.ego != nullptr) {
      tables.ego += fmt::format("{:.6f},{},{}\n", event.time_s, event.ego->speed_mps, event.ego->yaw_rate_radps);
      continue;
    }
    const RadarScan& scan = *event.scan;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      const bool has_elevation = scan.has(scan_field::kElevation);
      tables.drive += fmt::format("{:.6f},{},{},{},{},{},{}\n", event.time_s, scan.header.source_id, scan.range_m[i],
                                  scan.azimuth_rad[i], has_elevation ? fmt::format("{}", scan.elevation_rad[i]) : "",
                                  scan.range_rate_mps[i], truth((*event.truth)[i].stationary));
    }
  }
  return tables;
}

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Whether the text is one JSON value and nothing else.
class JsonCheck {
 public:
  [[nodiscard]] static bool is_valid(std::string_view text) {
    JsonCheck check(text);
    return check.value() && (check.blank(), check.text_.empty());
  }

 private:
  explicit JsonCheck(std::string_view text) : text_(text) {}
  void blank() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) text_.remove_prefix(1);
  }
  bool take(char c) {
    blank();
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool word(std::string_view w) {
    if (text_.substr(0, w.size()) != w) return false;
    text_.remove_prefix(w.size());
    return true;
  }
  bool string() {
    if (!take('"')) return false;
    while (!text_.empty() && text_.front() != '"') {
      if (static_cast<unsigned char>(text_.front()) < 0x20) return false;
      const std::size_t size = text_.front() != '\\' ? 1 : text_.size() > 1 && text_[1] == 'u' ? 6 : 2;
      if (text_.size() < size) return false;
      text_.remove_prefix(size);
    }
    return take('"');
  }
  bool number() {
    std::size_t size = 0;
    while (size < text_.size() && std::string_view("+-.0123456789e").find(text_[size]) != std::string_view::npos) {
      ++size;
    }
    text_.remove_prefix(size);
    return size > 0;
  }
  bool list(char end, bool keys) {
    if (take(end)) return true;
    do {
      if (keys && !(string() && take(':'))) return false;
      if (!value()) return false;
    } while (take(','));
    return take(end);
  }
  bool value() {
    blank();
    if (text_.empty()) return false;
    if (text_.front() == '"') return string();
    if (take('{')) return list('}', true);
    if (take('[')) return list(']', false);
    return word("null") || word("true") || word("false") || number();
  }
  std::string_view text_;
};

}  // namespace boresight::align::testing
