#include <cmath>

#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/score/report_text.hpp"

namespace boresight::score {

std::string to_json(const std::vector<NamedScore>& scores, const std::string& truth, const std::string& version) {
  json::Value runs = json::Value::array();
  for (const NamedScore& each : scores) {
    json::Value figures = json::Value::object();
    for (const judge::Figure& figure : each.score.figures.all()) {
      // Not a number: there is no data.
      figures[figure.name] = std::isfinite(figure.value) ? json::Value(figure.value) : json::Value(nullptr);
    }
    runs.push_back({{"run", each.run}, {"figures", std::move(figures)}, {"notes", each.score.notes}});
  }
  const json::Value document = {
      {"tool", "boresight score"}, {"version", version}, {"format", 1}, {"truth", truth}, {"runs", std::move(runs)}};
  return json::document(document);
}

}  // namespace boresight::score
