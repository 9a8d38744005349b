#include "deploy/catalogue/catalogue_text.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::catalogue {

namespace {

constexpr std::size_t kColumns = 9;
using Row = std::array<std::string, kColumns>;

std::string names(const ServiceSet& services) {
  if (services.size() == kNumberOfSupervisedServices && !services.contains(Service::kMonitor)) return "every service";
  std::string text;
  for (std::size_t i = 0; i < kNumberOfServices; ++i) {
    if (services.contains(static_cast<Service>(i))) text += (text.empty() ? "" : ", ") + std::string(kServiceNames[i]);
  }
  return text;
}

std::vector<Row> rows() {
  std::vector<Row> result = {
      {"topic", "type", "bytes", "written by", "read by", "period", "deadline", "queue", "history"}};
  for (const Topic& t : kTopics) {
    const std::string each = t.per_radar ? " per radar" : "";
    result.push_back({std::string(t.name), std::string(t.type), std::to_string(t.payload_bytes), names(t.writers),
                      names(t.readers), std::to_string(t.period_ns / kMillisecond_ns) + " ms" + each,
                      std::to_string(t.deadline_ns / kMillisecond_ns) + " ms", std::to_string(queue_capacity(t)),
                      std::to_string(t.history)});
  }
  return result;
}

}  // namespace

std::string to_table() {
  const std::vector<Row> table = rows();
  std::array<std::size_t, kColumns> width{};
  for (const Row& row : table) {
    for (std::size_t i = 0; i < kColumns; ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string text;
  for (const Row& row : table) {
    std::string line;
    for (std::size_t i = 0; i < kColumns; ++i) line += row[i] + std::string(width[i] - row[i].size() + 2, ' ');
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string to_markdown() {
  std::string text;
  bool heading = true;
  for (const Row& row : rows()) {
    for (const std::string& cell : row) text += "| " + cell + " ";
    text += "|\n";
    for (std::size_t i = 0; heading && i < kColumns; ++i) text += "|---";
    if (heading) text += "|\n";
    heading = false;
  }
  text += "\n```mermaid\nflowchart LR\n";
  for (const Topic& t : kTopics) {
    if (t.writers.size() != 1) continue;  // the heartbeat: every service writes it
    for (std::size_t writer = 0; writer < kNumberOfSupervisedServices; ++writer) {
      if (!t.writers.contains(static_cast<Service>(writer))) continue;
      for (std::size_t reader = 0; reader < kNumberOfSupervisedServices; ++reader) {
        if (!t.readers.contains(static_cast<Service>(reader))) continue;
        text += "  " + std::string(kServiceNames[writer]) + " -- " + std::string(t.name) + " --> " +
                std::string(kServiceNames[reader]) + "\n";
      }
    }
  }
  return text + "```\n";
}

}  // namespace boresight::catalogue
