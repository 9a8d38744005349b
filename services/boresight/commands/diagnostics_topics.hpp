// The topics of `boresight diagnostics` beside health: tracks, alignment and services.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "services/health/dds/topic_reader.hpp"

namespace boresight {

struct TopicChoice {
  bool tracks = false;
  bool alignment = false;
  bool services = false;
  [[nodiscard]] bool any() const { return tracks || alignment || services; }
};

/// Adds --tracks, --alignment and --services, each of which excludes `other`.
void add_topic_options(CLI::App& command, TopicChoice& choice, CLI::Option* other);

/// Callbacks for the chosen topics, which print every sample; the text ends with a line feed.
[[nodiscard]] dds::TopicReader::Callbacks printing(const TopicChoice& choice, bool is_json,
                                                   const std::function<void(const std::string&)>& print);

}  // namespace boresight
