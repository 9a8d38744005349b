// Who may register with a RouDi that shares its group with nobody.
#pragma once

#include <string>

#include <sys/types.h>

#include "deploy/supervisor/leftovers.hpp"

namespace boresight::broker {

/// Number of the group with this name. Throws std::invalid_argument if the system has no such group.
[[nodiscard]] gid_t group_number(const std::string& name);

/// Gives RouDi's management memory and its registration socket to a group, whose members may then register. Every user
/// of RouDi's own group may write to all segments of shared memory, so no service may be in it. This process must own
/// the two files and be a member of `group`. Throws std::system_error, with the file's name, if that fails.
void admit(const supervisor::Places& places, gid_t group);

}  // namespace boresight::broker
