#include "services/health/dds/topic_page.hpp"

#include <string_view>

#include <fmt/format.h>

namespace boresight::dds {

namespace {

std::string duration_text(const TopicQos& topic, double periods) {
  if (periods <= 0.0) return "none";
  return topic.period_s > 0.0 ? fmt::format("{:g} s", periods * topic.period_s) : fmt::format("{:g} P", periods);
}

}  // namespace

std::string topics_as_markdown() {
  std::string table =
      "| topic | type | IDL | key | reliability | durability | depth | deadline | lease of liveliness | lifespan |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n";
  for (const TopicDescription& topic : kTopicDescriptions) {
    const TopicQos& qos = *topic.qos;
    const std::string_view key = topic.key;
    table += fmt::format("| `{}` | `{}` | [{}](../interfaces/idl/{}) | {} | {} | {} | {} | {} | {} | {} |\n", qos.name,
                         topic.type, topic.idl, topic.idl, key.empty() ? "none" : fmt::format("`{}`", key),
                         qos.reliability == Reliability::kReliable ? "reliable" : "best effort",
                         qos.durability == Durability::kTransientLocal ? "transient local" : "volatile",
                         qos.written_depth, duration_text(qos, qos.deadline_periods),
                         duration_text(qos, qos.lease_periods), duration_text(qos, qos.lifespan_periods));
  }
  return table;
}

}  // namespace boresight::dds
