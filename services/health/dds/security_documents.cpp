#include "services/health/dds/security_documents.hpp"

#include <ctime>
#include <optional>
#include <string_view>

#include <tinyxml2.h>

namespace boresight::dds {

namespace {

using Element = const tinyxml2::XMLElement;

/// Text of a child without blanks at its ends; empty without such a child.
std::string text_of(Element* parent, const char* name) {
  Element* const child = parent == nullptr ? nullptr : parent->FirstChildElement(name);
  if (child == nullptr || child->GetText() == nullptr) return {};
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::string_view text = child->GetText();
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin));
}

bool is_true(Element* parent, const char* name) {
  const std::string text = text_of(parent, name);
  return text == "true" || text == "1";
}

/// Whether the element `domains` of a rule has the domain.
bool covers(Element* rule, std::uint32_t domain) {
  Element* const domains = rule->FirstChildElement("domains");
  if (domains == nullptr) return false;
  for (Element* id = domains->FirstChildElement("id"); id != nullptr; id = id->NextSiblingElement("id")) {
    if (id->UnsignedText(domain + 1) == domain) return true;
  }
  for (Element* range = domains->FirstChildElement("id_range"); range != nullptr;
       range = range->NextSiblingElement("id_range")) {
    unsigned least = 0;
    unsigned most = UINT32_MAX;
    if (Element* const min = range->FirstChildElement("min")) min->QueryUnsignedText(&least);
    if (Element* const max = range->FirstChildElement("max")) max->QueryUnsignedText(&most);
    if (domain >= least && domain <= most) return true;
  }
  return false;
}

bool is_protected(Element* parent, const char* kind) {
  const std::string text = text_of(parent, kind);
  return !text.empty() && text != "NONE";
}

std::string problem_of_topics(Element* rule) {
  Element* const topics = rule->FirstChildElement("topic_access_rules");
  Element* topic = topics == nullptr ? nullptr : topics->FirstChildElement("topic_rule");
  if (topic == nullptr) return "has no topic_rule";
  const bool all_messages = is_protected(rule, "rtps_protection_kind");
  for (; topic != nullptr; topic = topic->NextSiblingElement("topic_rule")) {
    const std::string of_topic = " of topic_rule " + text_of(topic, "topic_expression");
    for (const char* const key : {"enable_read_access_control", "enable_write_access_control"}) {
      if (!is_true(topic, key)) return std::string(key) + of_topic + " must be true";
    }
    if (!all_messages && !is_protected(topic, "metadata_protection_kind")) {
      return "metadata_protection_kind" + of_topic + " must not be NONE";
    }
  }
  return {};
}

/// Seconds since the epoch of a local time as "2027-11-30T22:07:37"; what follows is ignored.
std::optional<std::int64_t> local_time_s(const std::string& text) {
  std::tm time{};
  if (strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &time) == nullptr) return std::nullopt;
  return std::mktime(&time);
}

std::string without_blanks(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ') result += c;
  }
  return result;
}

}  // namespace

std::string problem_of_governance(const std::string& xml, std::uint32_t domain) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) return "holds no XML document";
  Element* const root = document.FirstChildElement("dds");
  Element* const rules = root == nullptr ? nullptr : root->FirstChildElement("domain_access_rules");
  if (rules == nullptr) return "has no domain_access_rules";
  for (Element* rule = rules->FirstChildElement("domain_rule"); rule != nullptr;
       rule = rule->NextSiblingElement("domain_rule")) {
    if (!covers(rule, domain)) continue;
    // The first rule counts.
    if (text_of(rule, "allow_unauthenticated_participants") != "false") {
      return "allow_unauthenticated_participants must be false";
    }
    if (!is_true(rule, "enable_join_access_control")) return "enable_join_access_control must be true";
    for (const char* const kind : {"discovery_protection_kind", "liveliness_protection_kind"}) {
      if (!is_protected(rule, kind)) return std::string(kind) + " must not be NONE";
    }
    return problem_of_topics(rule);
  }
  return "has no rule for DDS domain " + std::to_string(domain);
}

Grant grant_of(const std::string& xml, const std::string& subject, std::uint32_t domain) {
  Grant result;
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    result.problem = "holds no XML document";
    return result;
  }
  Element* const root = document.FirstChildElement("dds");
  Element* const permissions = root == nullptr ? nullptr : root->FirstChildElement("permissions");
  Element* grant = permissions == nullptr ? nullptr : permissions->FirstChildElement("grant");
  result.problem = "grants nothing to " + subject;
  for (; grant != nullptr; grant = grant->NextSiblingElement("grant")) {
    if (without_blanks(text_of(grant, "subject_name")) != without_blanks(subject)) continue;
    Element* rule = grant->FirstChildElement("allow_rule");
    while (rule != nullptr && !covers(rule, domain)) rule = rule->NextSiblingElement("allow_rule");
    if (rule == nullptr) {
      result.problem = "grants " + subject + " nothing in DDS domain " + std::to_string(domain);
      continue;
    }
    Element* const validity = grant->FirstChildElement("validity");
    const auto begin_s = local_time_s(text_of(validity, "not_before"));
    const auto end_s = local_time_s(text_of(validity, "not_after"));
    if (!begin_s || !end_s) {
      result.problem = "has a grant without times as 2027-12-31T00:00:00 in its validity";
      continue;
    }
    return {.problem = {}, .not_before_s = *begin_s, .not_after_s = *end_s};
  }
  return result;
}

std::string problem_of_validity(const Grant& grant, std::int64_t now_s) {
  const auto date = [](std::int64_t time_s) {
    const auto time = static_cast<std::time_t>(time_s);
    std::tm local{};
    localtime_r(&time, &local);
    char text[sizeof "2027-12-31T00:00:00"];
    return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &local));
  };
  if (now_s < grant.not_before_s) return "is not valid before " + date(grant.not_before_s) + "; is the clock right?";
  if (now_s > grant.not_after_s) return "has expired on " + date(grant.not_after_s);
  return {};
}

}  // namespace boresight::dds
