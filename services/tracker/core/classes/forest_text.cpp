#include "services/tracker/core/classes/forest_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <ratio>
#include <utility>
#include <vector>

namespace boresight::tracking {

namespace {

using extended_object::kRoadUserClasses;

constexpr std::string_view kVersion = "1";
constexpr std::array<std::string_view, kRoadUserClasses> kClasses = {"pedestrian", "two_wheeler", "car", "van",
                                                                     "truck"};
constexpr auto kThousandths = static_cast<std::uint32_t>(std::milli::den);
constexpr auto kLargestValue = static_cast<double>(std::numeric_limits<float>::max());

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  ObjectForest parse() {
    expect("version", 1);
    if (cell(1) != kVersion) fail("the version must be " + std::string(kVersion));
    read_head();
    advance();
    while (cell(0) == "tree") read_tree();
    if (cell(0) != "end") fail("the line must be \"tree\" or \"end\", not " + quoted(cell(0)));
    if (next()) fail("no line must be behind the end");
    if (forest_.table.trees.empty()) fail("the table must have a tree");
    return std::move(forest_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw ForestTextError(line_, problem); }
  [[nodiscard]] static std::string quoted(std::string_view text) {
    std::string shown = "\"";
    for (const char c : text.substr(0, std::array<char, 40>{}.size())) shown += c >= ' ' && c <= '~' ? c : '?';
    return shown + "\"";
  }

  [[nodiscard]] static std::string shown(double value) {
    std::array<char, 32> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end};
  }

  /// The next line that is neither empty nor a comment.
  bool next() {
    while (!text_.empty()) {
      const std::size_t end = text_.find('\n');
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
      ++line_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.empty() || line.front() == '#') continue;
      split(line);
      return true;
    }
    return false;
  }
  void split(std::string_view line) {
    cells_.clear();
    for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
      cells_.push_back(line.substr(0, comma));
      line.remove_prefix(comma + 1);
    }
    cells_.push_back(line);
  }
  void advance() {
    if (!next()) fail("the table must end with the line \"end\"");
  }
  [[nodiscard]] std::string_view cell(std::size_t i) const { return cells_[i]; }

  void expect_cells(std::size_t values) const {
    if (cells_.size() == values + 1) return;
    fail(std::string(cell(0)) + " must have " + std::to_string(values) + " values, not " +
         std::to_string(cells_.size() - 1));
  }
  void expect(std::string_view word, std::size_t values) {
    advance();
    if (cell(0) != word) fail("the line must begin with \"" + std::string(word) + "\", not " + quoted(cell(0)));
    expect_cells(values);
  }
  [[nodiscard]] double number(std::size_t i, double least, double most) const {
    const std::string_view text = cell(i);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !(value >= least && value <= most)) {
      fail(quoted(text) + " must be a number from " + shown(least) + " to " + shown(most));
    }
    return value;
  }
  [[nodiscard]] std::uint32_t whole(std::size_t i, std::uint32_t most) const {
    const std::string_view text = cell(i);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value > most) {
      fail(quoted(text) + " must be a whole number from 0 to " + std::to_string(most));
    }
    return value;
  }

  void read_head() {
    expect("classes", kClasses.size());
    for (std::size_t k = 0; k < kClasses.size(); ++k) {
      if (cell(k + 1) != kClasses[k]) fail("class " + std::to_string(k + 1) + " must be " + std::string(kClasses[k]));
    }
    expect("prior", kClasses.size());
    const auto prior = shares();
    std::copy(prior.begin(), prior.end(), forest_.table.prior_share.begin());
    for (const ForestNumber& of : forest_numbers()) {
      expect("number", 2);
      if (cell(1) != of.key) fail("the number must be " + std::string(of.key) + ", not " + quoted(cell(1)));
      of.value_of(forest_) = number(2, of.least, of.most);
    }
    for (std::size_t k = 0; k < kClassFeatures; ++k) {
      expect("feature", 2);
      const std::string_view name = name_of(static_cast<ClassFeature>(k));
      if (cell(1) != name) fail("the feature must be " + std::string(name) + ", not " + quoted(cell(1)));
      forest_.table.missing.push_back(static_cast<float>(number(2, -kLargestValue, kLargestValue)));
    }
  }

  /// The line "tree", and the nodes behind it until each side of each split is there.
  void read_tree() {
    expect_cells(0);
    std::vector<ForestNode>& nodes = forest_.table.nodes;
    forest_.table.trees.push_back(static_cast<std::uint32_t>(nodes.size()));
    std::vector<std::size_t> open;  // splits whose side of greater values is still to come
    do {
      advance();
      if (cell(0) == "split") {
        expect_cells(2);
        open.push_back(nodes.size());
        nodes.push_back({static_cast<std::uint16_t>(whole(1, kClassFeatures - 1)), 0,
                         static_cast<float>(number(2, -kLargestValue, kLargestValue))});
        continue;
      }
      if (cell(0) != "leaf") fail("the line must begin with \"split\" or \"leaf\", not " + quoted(cell(0)));
      read_leaf();
      if (open.empty()) break;
      nodes[open.back()].other = static_cast<std::uint32_t>(nodes.size());
      open.pop_back();
    } while (true);
    advance();
  }

  void read_leaf() {
    expect_cells(kClasses.size());
    forest_.table.nodes.push_back({ForestNode::kLeaf, static_cast<std::uint32_t>(forest_.table.leaves.size()), 0.0F});
    forest_.table.leaves.push_back(shares());
  }

  /// Of the classes, from the cells of the line.
  [[nodiscard]] std::array<float, kRoadUserClasses> shares() const {
    std::array<float, kRoadUserClasses> shares{};
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const std::uint32_t thousandths = whole(k + 1, kThousandths);
      shares[k] = static_cast<float>(thousandths) / static_cast<float>(kThousandths);
      sum += thousandths;
    }
    if (sum != kThousandths) fail("the shares must sum to " + std::to_string(kThousandths));
    return shares;
  }

  std::string_view text_;
  std::size_t line_ = 0;
  std::vector<std::string_view> cells_;
  ObjectForest forest_;
};

}  // namespace

ObjectForest parse_forest(std::string_view text) {
  return Parser(text).parse();
}

}  // namespace boresight::tracking
