#include "services/common/runtime/config/reader.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/runtime/config/former_keys.hpp"
#include "services/common/runtime/config/read_text.hpp"
#include "services/common/runtime/config/toml.hpp"
#include "services/common/runtime/config/toml_text.hpp"
#include "services/common/text/near_names.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::config {

namespace {

/// Capacities of an error message: a damaged file must not flood a log.
constexpr std::size_t kMaxReportedProblems = 50;
constexpr std::size_t kMaxProblemBytes = 4000;

std::string format_number(double value) {
  return fmt::format("{:g}", value);
}

std::string describe(const Range& allowed) {
  const bool has_min = std::isfinite(allowed.min);
  const bool has_max = std::isfinite(allowed.max);
  if (has_min && has_max) return fmt::format("{} … {}", format_number(allowed.min), format_number(allowed.max));
  if (has_min) return fmt::format("at least {}", format_number(allowed.min));
  if (has_max) return fmt::format("at most {}", format_number(allowed.max));
  return "any number";
}

/// A problem as one line of limited length, without control characters.
std::string shown(std::string problem) {
  if (problem.size() > kMaxProblemBytes) {
    std::size_t end = kMaxProblemBytes;
    while (end > 0 && (static_cast<unsigned char>(problem[end]) & 0xC0U) == 0x80U) --end;  // not inside a character
    problem = problem.substr(0, end) + " …";
  }
  return text::printable(std::move(problem));
}

std::string_view type_name(toml::node_type type) {
  switch (type) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

/// The text of a node; empty if the node is no string.
std::string string_of(const toml::node& node) {
  return decode_ascii(node.value<std::string>().value_or(""));
}

std::string problem_of_unknown_key(const std::string& key, const std::set<std::string, std::less<>>& known) {
  for (const RenamedKey& renamed : kRenamedKeys) {
    if (renamed.former == key && known.contains(renamed.current)) {
      return fmt::format("is called '{}' now", renamed.current);
    }
  }
  for (const MovedKey& moved : kMovedKeys) {
    if (moved.former == key && known.contains(moved.beside)) return fmt::format("is {} now", moved.current);
  }
  const std::vector<std::string> near = near_names(key, {known.begin(), known.end()});
  return fmt::format("unknown key; {}known here: {}", near.empty() ? "" : fmt::format("similar: '{}'; ", near.front()),
                     fmt::join(known, ", "));
}

}  // namespace

// One table of a document. The document owns its nodes; every reader shares in the document's ownership, so that it
// outlives all readers into it.
struct Reader::Node {
  struct Document;

  explicit Node(Document& owner) : document(&owner) {}

  Document* document;
  const toml::table* table = nullptr;  // nullptr: an absent table, where every key is absent
  std::string path;                    // "radar[1].source", empty at the root
  std::uint32_t line = 1;
  std::set<std::string, std::less<>> known;
  std::map<std::string, std::size_t, std::less<>> missing;  // required keys that are absent: index of their error

  [[nodiscard]] std::string key_path(std::string_view key) const {
    if (path.empty()) return std::string(key);
    return key.empty() ? path : fmt::format("{}.{}", path, key);
  }
  void note(std::uint32_t at_line, std::string_view key, std::string_view problem) const;
  [[nodiscard]] const toml::node* find(std::string_view key) {
    known.emplace(key);
    return table == nullptr ? nullptr : table->get(key);
  }
  void expect(const toml::node& node, std::string_view key, std::string_view wanted) const {
    note(node.source().begin.line, key, fmt::format("must be {}, but is {}", wanted, type_name(node.type())));
  }
  /// Completes the error of a required key that is absent.
  void add_what_is_allowed(std::string_view key, std::string_view allowed);
  [[nodiscard]] std::uint32_t line_of(std::string_view key) const {
    const toml::node* found = table == nullptr || key.empty() ? nullptr : table->get(key);
    return found == nullptr ? line : found->source().begin.line;
  }
  /// A node for a table below this one.
  [[nodiscard]] Node& add_child(std::string child_path, std::uint32_t child_line) const;
};

struct Reader::Node::Document {
  std::string file;
  toml::table root;
  std::vector<std::pair<std::uint32_t, std::string>> errors;  // line, message
  std::deque<Node> nodes;                                     // the root first; addresses stay
};

void Reader::Node::note(std::uint32_t at_line, std::string_view key, std::string_view problem) const {
  document->errors.emplace_back(at_line,
                                shown(fmt::format("{}:{}: {}: {}", document->file, at_line, key_path(key), problem)));
}

void Reader::Node::add_what_is_allowed(std::string_view key, std::string_view allowed) {
  const auto found = missing.find(key);
  if (found == missing.end()) return;
  document->errors[found->second].second += fmt::format("; {}", allowed);
  missing.erase(found);
}

Reader::Node& Reader::Node::add_child(std::string child_path, std::uint32_t child_line) const {
  Node& child = document->nodes.emplace_back(*document);
  child.path = std::move(child_path);
  child.line = child_line;
  return child;
}

namespace {

[[noreturn]] void throw_parse_error(const toml::parse_error& error, std::string_view file) {
  throw Error(shown(
      fmt::format("{}:{}: not valid TOML: {}", file, error.source().begin.line, decode_ascii(error.description()))));
}

}  // namespace

Reader Reader::parse(std::string_view text, std::string_view name) {
  const auto document = std::make_shared<Node::Document>();
  document->file = std::string(name);
  try {
    document->root = toml::parse(encode_ascii(text), name);
  } catch (const toml::parse_error& error) {
    throw_parse_error(error, name);
  } catch (const TomlAssertion&) {
    throw Error(fmt::format("{}: not valid TOML", name));
  }
  Node& root = document->nodes.emplace_back(*document);
  root.table = &document->root;
  return Reader(std::shared_ptr<Node>(document, &root));
}

Reader Reader::open(const std::filesystem::path& file) {
  return parse(read_text(file), file.string());
}

double Reader::number(std::string_view key, Range allowed, double fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) {
    node_->add_what_is_allowed(key, "allowed: " + describe(allowed));
    return fallback;
  }
  if (!node->is_number()) {
    node_->expect(*node, key, fmt::format("a number ({})", describe(allowed)));
    return fallback;
  }
  const double value = node->value<double>().value_or(fallback);
  if (!(value >= allowed.min && value <= allowed.max)) {
    reject(key, fmt::format("{} is out of range; allowed: {}", format_number(value), describe(allowed)));
    return fallback;
  }
  return value;
}

std::int64_t Reader::integer(std::string_view key, Range allowed, std::int64_t fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) {
    node_->add_what_is_allowed(key, "allowed: " + describe(allowed));
    return fallback;
  }
  if (!node->is_integer()) {
    node_->expect(*node, key, fmt::format("an integer ({})", describe(allowed)));
    return fallback;
  }
  const std::int64_t value = node->value<std::int64_t>().value_or(fallback);
  if (static_cast<double>(value) < allowed.min || static_cast<double>(value) > allowed.max) {
    reject(key, fmt::format("{} is out of range; allowed: {}", value, describe(allowed)));
    return fallback;
  }
  return value;
}

bool Reader::boolean(std::string_view key, bool fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) {
    node_->expect(*node, key, "true or false");
    return fallback;
  }
  return node->value<bool>().value_or(fallback);
}

std::string Reader::text(std::string_view key, std::string_view fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) return std::string(fallback);
  if (!node->is_string()) {
    node_->expect(*node, key, "a string");
    return std::string(fallback);
  }
  return string_of(*node);
}

std::vector<double> Reader::numbers(std::string_view key, std::size_t count, Range allowed,
                                    std::vector<double> fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) return fallback;
  const std::string wanted = fmt::format("an array of {} numbers ({})", count, describe(allowed));
  const toml::array* array = node->as_array();
  if (array == nullptr) {
    node_->expect(*node, key, wanted);
    return fallback;
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const double value = element.is_number() ? element.value<double>().value_or(NAN) : NAN;
    if (!(value >= allowed.min && value <= allowed.max)) {
      reject(key, fmt::format("element {} is not a number in range; must be {}", values.size() + 1, wanted));
      return fallback;
    }
    values.push_back(value);
  }
  if (values.size() != count) {
    reject(key, fmt::format("has {} elements; must be {}", values.size(), wanted));
    return fallback;
  }
  return values;
}

std::vector<std::int64_t> Reader::integers(std::string_view key, Range count, Range allowed,
                                           std::vector<std::int64_t> fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) return fallback;
  const toml::array* array = node->as_array();
  const std::string wanted = fmt::format("an array of integers ({}), their number {}", describe(allowed),
                                         count.min == count.max ? format_number(count.min) : describe(count));
  if (array == nullptr) {
    node_->expect(*node, key, wanted);
    return fallback;
  }
  const auto size = static_cast<double>(array->size());
  if (size < count.min || size > count.max) {
    reject(key, fmt::format("has {} elements; must be {}", array->size(), wanted));
    return fallback;
  }
  std::vector<std::int64_t> values;
  for (const toml::node& element : *array) {
    const std::int64_t value = element.value_exact<std::int64_t>().value_or(0);
    const auto number = static_cast<double>(value);
    if (!element.is_integer() || number < allowed.min || number > allowed.max) {
      reject(key, fmt::format("element {} is not an integer in range; must be {}", values.size() + 1, wanted));
      return fallback;
    }
    values.push_back(value);
  }
  return values;
}

std::vector<std::string> Reader::texts(std::string_view key, std::vector<std::string> fallback) {
  const toml::node* node = node_->find(key);
  if (node == nullptr) return fallback;
  const toml::array* array = node->as_array();
  if (array == nullptr || !(array->empty() || array->is_homogeneous<std::string>())) {
    node_->expect(*node, key, "an array of strings");
    return fallback;
  }
  std::vector<std::string> values;
  for (const toml::node& element : *array) values.push_back(string_of(element));
  return values;
}

int Reader::choice_index(std::string_view key, const std::vector<std::string_view>& words) {
  const toml::node* node = node_->find(key);
  const std::string wanted = fmt::format("one of \"{}\"", fmt::join(words, "\", \""));
  if (node == nullptr) {
    node_->add_what_is_allowed(key, "must be " + wanted);
    return -1;
  }
  if (!node->is_string()) {
    node_->expect(*node, key, wanted);
    return -1;
  }
  const std::string word = string_of(*node);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    reject(key, fmt::format("\"{}\" is unknown; must be {}", word, wanted));
    return -1;
  }
  return static_cast<int>(found - words.begin());
}

double Reader::angle_deg(std::string_view key, Range allowed_deg, double fallback_rad) {
  return number(key, allowed_deg, fallback_rad / kRadiansPerDegree) * kRadiansPerDegree;
}

bool Reader::has(std::string_view key) const {
  return node_->table != nullptr && node_->table->contains(key);
}

void Reader::require(std::string_view key) {
  node_->known.emplace(key);
  if (has(key)) return;
  node_->missing.emplace(key, node_->document->errors.size());
  node_->note(node_->line, key, "is missing");
}

Reader Reader::table(std::string_view key) {
  const toml::node* found = node_->find(key);
  Node& child = node_->add_child(node_->key_path(key), node_->line);
  if (found != nullptr) {
    child.line = found->source().begin.line;
    child.table = found->as_table();
    if (child.table == nullptr) node_->expect(*found, key, "a table");
  }
  return Reader(std::shared_ptr<Node>(node_, &child));
}

std::vector<Reader> Reader::tables(std::string_view key, Range count) {
  std::vector<Reader> readers;
  const toml::node* found = node_->find(key);
  if (found == nullptr) return readers;
  const toml::array* array = found->as_array();
  if (array == nullptr) {
    node_->expect(*found, key, fmt::format("an array of tables ([[{}]])", key));
    return readers;
  }
  const auto size = static_cast<double>(array->size());
  if (size < count.min || size > count.max) {
    reject(key, fmt::format("has {} tables; their number must be {}", array->size(), describe(count)));
  }
  for (const toml::node& element : *array) {
    Node& child =
        node_->add_child(fmt::format("{}[{}]", node_->key_path(key), readers.size()), element.source().begin.line);
    child.table = element.as_table();
    if (child.table == nullptr) child.note(child.line, "", "must be a table");
    readers.push_back(Reader(std::shared_ptr<Node>(node_, &child)));
  }
  return readers;
}

void Reader::skip(std::string_view key) {
  node_->known.emplace(key);
}

void Reader::skip_others() {
  if (node_->table == nullptr) return;
  for (const auto& [key, value] : *node_->table) node_->known.emplace(key.str());
}

void Reader::reject(std::string_view key, std::string_view problem) {
  node_->note(node_->line_of(key), key, problem);
}

std::string Reader::place(std::string_view key) const {
  return fmt::format("{}:{}: {}", node_->document->file, node_->line_of(key), node_->key_path(key));
}

void Reader::finish() {
  auto& errors = node_->document->errors;
  std::size_t unreported = 0;
  for (const Node& node : node_->document->nodes) {
    if (node.table == nullptr) continue;
    for (const auto& [key, value] : *node.table) {
      if (node.known.contains(key.str())) continue;
      if (errors.size() >= kMaxReportedProblems) {
        ++unreported;
        continue;
      }
      const std::string name = decode_ascii(key.str());
      node.note(key.source().begin.line, name, problem_of_unknown_key(name, node.known));
    }
  }
  if (errors.empty()) return;
  std::stable_sort(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (errors.size() > kMaxReportedProblems) {
    unreported += errors.size() - kMaxReportedProblems;
    errors.resize(kMaxReportedProblems);
  }
  std::string message;
  for (const auto& [line, text] : errors) message += (message.empty() ? "" : "\n") + text;
  if (unreported > 0) message += fmt::format("\n{}: {} more problems", node_->document->file, unreported);
  throw Error(message);
}

}  // namespace boresight::config
