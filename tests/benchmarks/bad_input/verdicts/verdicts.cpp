#include "tests/benchmarks/bad_input/verdicts/verdicts.hpp"

#include <fstream>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace boresight::bench::bad_input {

namespace {
constexpr double kNever = std::numeric_limits<double>::infinity();
}  // namespace

History read_verdicts(const std::filesystem::path& health_jsonl) {
  std::ifstream in(health_jsonl);
  if (!in) throw std::runtime_error(health_jsonl.string() + ": cannot be read");
  History history;
  std::size_t number = 0;
  try {
    for (std::string line; std::getline(in, line);) {
      ++number;
      const nlohmann::json report = nlohmann::json::parse(line);
      for (const nlohmann::json& radar : report.at("radars")) {
        Verdict v;
        v.since_s = report.at("t_s").get<double>();
        const std::string effect = radar.at("data_qualifier").get<std::string>();
        v.reason = radar.at("extended_qualifier").get<std::string>();
        v.words = effect + " " + v.reason;
        v.is_available = effect == "AVAILABLE" || v.reason == "INITIALISING";
        std::vector<Verdict>& verdicts = history[radar.at("radar").get<unsigned>()];
        if (verdicts.empty() || verdicts.back().words != v.words) verdicts.push_back(v);
      }
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(health_jsonl.string() + ":" + std::to_string(number) + ": " + error.what());
  }
  return history;
}

Outcome outcome_of(const std::vector<Verdict>& verdicts, const Window& damage, const std::set<std::string>& right) {
  Outcome out{kNever, 0, false, kNever, ""};
  bool was_reported = false, is_available = true;
  double cleared_s = damage.end_s;
  for (const Verdict& v : verdicts) {
    const bool is_right = !v.is_available && right.contains(v.reason);
    if (v.since_s < damage.end_s) {
      out.at_end = v.words;
      out.is_right_at_end = is_right;
    }
    if (v.since_s >= damage.begin_s && v.since_s < damage.end_s) {
      if (is_right && out.right_after_s == kNever) out.right_after_s = v.since_s - damage.begin_s;
      if (v.is_available && was_reported && !is_available) ++out.returns;
      was_reported = was_reported || !v.is_available;
    }
    if (v.since_s >= damage.end_s && v.is_available && !is_available) cleared_s = v.since_s;
    is_available = v.is_available;
  }
  if (is_available) out.clear_after_s = cleared_s - damage.end_s;
  return out;
}

}  // namespace boresight::bench::bad_input
