// Strict reading of TOML: every key must be known, of the right type and in range, or the file is refused with a
// message that names file, line, key and what is allowed. All errors of a file are reported together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boresight::config {

/// Errors of a configuration; what() has one line per error, each "file:line: key: problem".
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Closed interval of allowed values.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// One TOML table. Getters return the value, or `fallback` if the key is absent. If the value is not allowed, they note
/// an error and return the fallback, so that one run shows all errors. `Reader::finish` of the ROOT throws if any error
/// was noted.
class Reader {
 public:
  /// Parses a file; throws Error if it cannot be read or is not TOML.
  [[nodiscard]] static Reader open(const std::filesystem::path& file);
  /// Parses text, for tests; `name` stands in for the file's name in errors.
  [[nodiscard]] static Reader parse(std::string_view text, std::string_view name);

  [[nodiscard]] double number(std::string_view key, Range allowed, double fallback);
  [[nodiscard]] std::int64_t integer(std::string_view key, Range allowed, std::int64_t fallback);
  [[nodiscard]] bool boolean(std::string_view key, bool fallback);
  [[nodiscard]] std::string text(std::string_view key, std::string_view fallback);
  /// Fixed-length list of numbers, each in `allowed`.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, Range allowed,
                                            std::vector<double> fallback);
  /// List of integers, each in `allowed`, as many as `count` allows.
  [[nodiscard]] std::vector<std::int64_t> integers(std::string_view key, Range count, Range allowed,
                                                   std::vector<std::int64_t> fallback);
  /// List of strings, of any length.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key, std::vector<std::string> fallback);
  /// One of the given words; `choices` pairs the word with its value.
  template <typename T>
  [[nodiscard]] T choice(std::string_view key, const std::vector<std::pair<std::string_view, T>>& choices, T fallback) {
    std::vector<std::string_view> words;
    for (const auto& [word, value] : choices) words.push_back(word);
    const int index = choice_index(key, words);
    return index < 0 ? fallback : choices[static_cast<std::size_t>(index)].second;
  }
  /// Angle given in degrees under a key that ends in `_deg`, returned in radians; `allowed_deg` in degrees.
  [[nodiscard]] double angle_deg(std::string_view key, Range allowed_deg, double fallback_rad);

  [[nodiscard]] bool has(std::string_view key) const;
  /// Notes an error if the key is absent. A getter called afterwards adds the allowed values to the error.
  void require(std::string_view key);
  /// Sub-table; an empty one if absent.
  [[nodiscard]] Reader table(std::string_view key);
  /// Array of tables ([[key]]), as many as `count` allows; empty if absent.
  [[nodiscard]] std::vector<Reader> tables(std::string_view key, Range count = {});

  /// Takes a key as known without reading it: it belongs to another reader.
  void skip(std::string_view key);
  /// The same of all keys of this table that are not read.
  void skip_others();

  /// Notes an error at this key (or at the table, with an empty key), for checks across keys.
  void reject(std::string_view key, std::string_view problem);
  /// "file:line: key" as in errors, for errors that are found after the file was read.
  [[nodiscard]] std::string place(std::string_view key) const;
  /// Call on the root after everything was read. Unknown keys of every table visited are errors: the error of a renamed
  /// key names the key of today, that of any other key lists the known keys. Throws Error if anything was noted.
  void finish();

 private:
  struct Node;
  explicit Reader(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  [[nodiscard]] int choice_index(std::string_view key, const std::vector<std::string_view>& words);
  std::shared_ptr<Node> node_;
};

}  // namespace boresight::config
