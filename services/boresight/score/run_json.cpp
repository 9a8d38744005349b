// The files of a run folder that are JSON.
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "interfaces/messages/header.hpp"
#include "interfaces/messages/names.hpp"
#include "services/boresight/json/text.hpp"
#include "services/boresight/score/run_folder.hpp"

namespace boresight::score {

namespace {

using Json = json::Value;

constexpr std::size_t kLongestHealthLine = 60'000;

/// The numbers of a value with their paths: {"a": {"b": 1}} is "a.b" 1.
void flatten(const Json& value, const std::string& path, std::vector<std::pair<std::string, double>>& numbers) {
  if (value.is_number()) numbers.emplace_back(path, value.get<double>());
  if (value.is_array() || value.is_object()) {
    for (const auto& [key, each] : value.items()) flatten(each, path.empty() ? key : path + "." + key, numbers);
  }
}

/// The value of that name, up to `last`; none if there is no such name.
template <typename Enum>
std::optional<Enum> named(std::string_view word, Enum last) {
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
    if (word == name_of(static_cast<Enum>(i))) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace

RunHealth::RunHealth(const std::filesystem::path& folder)
    : source_(folder / "health.jsonl"), lines_(source_, kLongestHealthLine) {}

bool RunHealth::next(RunVerdicts& verdicts) {
  for (std::string_view line; lines_.next(line);) {
    ++line_number_;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const auto refuse = [&](const std::string& problem) {
      throw InputError(fmt::format("{}:{}: {}", source_.name(), line_number_, problem));
    };
    const Json value = Json::parse(line, nullptr, false);
    if (value.is_discarded() || !value.is_object()) refuse("is no JSON object");
    verdicts.radars.clear();
    const auto time_ns = value.find("time_ns"), t_s = value.find("t_s"), radars = value.find("radars");
    if (time_ns == value.end() || !time_ns->is_number_integer()) refuse("time_ns: a whole number is missing");
    if (std::abs(time_ns->get<double>()) > static_cast<double>(kLatest_ns)) {
      refuse(fmt::format("time_ns: allowed is -{0} … {0}", kLatest_ns));
    }
    if (t_s == value.end() || !t_s->is_number()) refuse("t_s: a number is missing");
    if (radars == value.end() || !radars->is_array()) refuse("radars: an array is missing");
    verdicts.time_ns = time_ns->get<std::int64_t>();
    verdicts.t_s = t_s->get<double>();
    for (const Json& radar : *radars) {
      if (!radar.is_object()) refuse("radars: holds what is no object");
      const auto id = radar.find("radar"), reason = radar.find("extended_qualifier");
      if (id == radar.end() || !id->is_number_unsigned() || id->get<std::uint64_t>() < 1 ||
          id->get<std::uint64_t>() > kMaxRadars) {
        refuse(fmt::format("radars: radar: a whole number 1 … {} is missing", kMaxRadars));
      }
      if (reason == radar.end() || !reason->is_string()) refuse("radars: extended_qualifier: a word is missing");
      const auto extended = named(reason->get<std::string>(), ExtendedQualifier::kWrongInput);
      if (!extended)
        refuse("radars: extended_qualifier: \"" + reason->get<std::string>().substr(0, 40) + "\" is no such word");
      const auto qualifier = radar.find("data_qualifier"), missed = radar.find("missed_scans");
      if (qualifier != radar.end() && !qualifier->is_string()) refuse("radars: data_qualifier: is no word");
      const auto data = qualifier != radar.end() ? named(qualifier->get<std::string>(), DataQualifier::kNotAvailable)
                                                 : DataQualifier::kNotAvailable;
      if (!data)
        refuse("radars: data_qualifier: \"" + qualifier->get<std::string>().substr(0, 40) + "\" is no such word");
      const auto explanation = radar.find("explanation");
      const auto is_beyond = [&radar](const char* axis) {
        const auto found = radar.find(axis);
        if (found == radar.end() || !found->is_object()) return false;
        const auto flag = found->find("beyond_tolerance");
        return flag != found->end() && flag->is_boolean() && flag->get<bool>();
      };
      verdicts.radars.push_back(
          {id->get<std::uint32_t>(),
           *extended == ExtendedQualifier::kMisaligned,
           *data,
           *extended,
           missed != radar.end() && missed->is_number_unsigned() ? missed->get<std::uint64_t>() : 0,
           explanation != radar.end() && explanation->is_string() ? explanation->get<std::string>() : "",
           {is_beyond("yaw"), is_beyond("pitch"), is_beyond("roll")}});
    }
    return true;
  }
  if (lines_.error() != 0) throw InputError(source_.name() + ": cannot be read");
  return false;
}

RunSummary read_run_summary(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  std::ifstream stream(file);
  const Json value = Json::parse(stream, nullptr, false);
  if (value.is_discarded() || !value.is_object()) throw InputError(file.string() + ": is no JSON object");
  RunSummary summary;
  if (const auto vehicle = value.find("vehicle"); vehicle != value.end()) {
    if (vehicle->is_string()) summary.vehicle = vehicle->get<std::string>();
    if (vehicle->is_object()) {
      for (const char* const key : {"file", "name"}) {
        const auto value = vehicle->find(key);
        if (summary.vehicle.empty() && value != vehicle->end() && value->is_string()) {
          summary.vehicle = value->get<std::string>();
        }
      }
    }
  }
  for (const char* const key : {"recording_s", "seconds"}) {
    if (const auto seconds = value.find(key); seconds != value.end() && seconds->is_number()) {
      summary.recording_s = seconds->get<double>();
    }
  }
  if (const auto begin = value.find("truth_begin_ns"); begin != value.end()) {
    if (!begin->is_number_integer()) throw InputError(file.string() + ": truth_begin_ns: is no whole number");
    summary.truth_begin_ns = begin->get<std::int64_t>();
  }
  if (const auto radars = value.find("radars"); radars != value.end() && radars->is_array()) {
    for (const Json& radar : *radars) {
      if (!radar.is_object()) continue;
      const auto id = radar.find("id"), name = radar.find("name");
      if (id == radar.end() || !id->is_number_unsigned() || name == radar.end() || !name->is_string()) continue;
      summary.radars.emplace_back(id->get<std::uint32_t>(), name->get<std::string>());
    }
  }
  if (const auto timing = value.find("timing"); timing != value.end()) flatten(*timing, "", summary.timing);
  return summary;
}

}  // namespace boresight::score
