#include "services/ghost_filter/core/classify/direct_echoes.hpp"

namespace boresight::ghosts {

DirectEchoes::DirectEchoes(std::size_t capacity) {
  echoes_.reserve(capacity);
  next_.reserve(capacity);
  clear();
}

void DirectEchoes::clear() {
  echoes_.clear();
  next_.clear();
  first_.fill(kNone);
}

void DirectEchoes::add(const DirectEcho& echo) {
  if (echoes_.size() == echoes_.capacity()) return;
  std::uint32_t& first = first_[sector_of<kSectors>(echo.direction)];
  next_.push_back(first);
  first = static_cast<std::uint32_t>(echoes_.size());
  echoes_.push_back(echo);
}

}  // namespace boresight::ghosts
