// Keys of a TOML table that set the members of a struct, described by name, member and allowed range.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "services/common/runtime/config/reader.hpp"

namespace boresight::simulator {

/// A key of a table: the member that it sets, and its allowed range. Lists have the length of the member.
template <typename Spec, typename Member>
struct Key {
  std::string_view name;
  Member Spec::*member;
  config::Range allowed;
};
template <typename Spec, typename Member>
Key(std::string_view, Member Spec::*, config::Range) -> Key<Spec, Member>;

/// A list whose numbers must increase.
template <typename Spec, std::size_t N>
struct Increasing {
  std::string_view name;
  std::array<double, N> Spec::*member;
  config::Range allowed;
};
template <typename Spec, std::size_t N>
Increasing(std::string_view, std::array<double, N> Spec::*, config::Range) -> Increasing<Spec, N>;

/// An angle, in degrees in the file.
template <typename Spec>
struct Angle {
  std::string_view name;
  double Spec::*member;
  config::Range allowed_deg;
};
template <typename Spec>
Angle(std::string_view, double Spec::*, config::Range) -> Angle<Spec>;

/// The upper end of an interval. If the key is absent, it is at least the lower end.
template <typename Spec>
struct UpperEnd {
  std::string_view name;
  double Spec::*member;
  config::Range allowed;
  double Spec::*lower;
};
template <typename Spec>
UpperEnd(std::string_view, double Spec::*, config::Range, double Spec::*) -> UpperEnd<Spec>;

/// No key: a condition on two keys that stand before it.
template <typename Spec>
struct NotLess {
  std::string_view name;
  double Spec::*member;
  std::string_view other_name;
  double Spec::*other;
};
template <typename Spec>
NotLess(std::string_view, double Spec::*, std::string_view, double Spec::*) -> NotLess<Spec>;

template <std::size_t N>
void read_list(config::Reader& r, std::string_view name, config::Range allowed, std::array<double, N>& values) {
  const std::vector<double> read = r.numbers(name, N, allowed, {values.begin(), values.end()});
  std::copy_n(read.begin(), N, values.begin());
}

template <typename Spec>
void read_key(config::Reader& r, Spec& s, const Key<Spec, double>& key) {
  s.*key.member = r.number(key.name, key.allowed, s.*key.member);
}

template <typename Spec>
void read_key(config::Reader& r, Spec& s, const Key<Spec, std::uint32_t>& key) {
  s.*key.member = static_cast<std::uint32_t>(r.integer(key.name, key.allowed, s.*key.member));
}

template <typename Spec, std::size_t N>
void read_key(config::Reader& r, Spec& s, const Key<Spec, std::array<double, N>>& key) {
  read_list(r, key.name, key.allowed, s.*key.member);
}

template <typename Spec, std::size_t N>
void read_key(config::Reader& r, Spec& s, const Increasing<Spec, N>& key) {
  std::array<double, N> read = s.*key.member;
  read_list(r, key.name, key.allowed, read);
  if (std::adjacent_find(read.begin(), read.end(), std::greater_equal<>()) == read.end()) {
    s.*key.member = read;
  } else if (r.has(key.name)) {
    r.reject(key.name, "must increase from number to number");
  }
}

template <typename Spec>
void read_key(config::Reader& r, Spec& s, const Angle<Spec>& key) {
  s.*key.member = r.angle_deg(key.name, key.allowed_deg, s.*key.member);
}

template <typename Spec>
void read_key(config::Reader& r, Spec& s, const UpperEnd<Spec>& key) {
  s.*key.member = r.number(key.name, key.allowed, std::max(s.*key.member, s.*key.lower));
}

template <typename Spec>
void read_key(config::Reader& r, Spec& s, const NotLess<Spec>& condition) {
  if (s.*condition.member < s.*condition.other) {
    r.reject(condition.name, "must not be less than " + std::string(condition.other_name));
  }
}

/// Reads a table with these keys. A table that has the member `on` also has the key.
template <typename Spec, typename... Keys>
void read_keys(config::Reader table, Spec& spec, const std::tuple<Keys...>& keys) {
  if constexpr (requires { spec.on; }) spec.on = table.boolean("on", spec.on);
  std::apply([&](const auto&... key) { (read_key(table, spec, key), ...); }, keys);
}

}  // namespace boresight::simulator
