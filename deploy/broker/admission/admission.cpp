#include "deploy/broker/admission/admission.hpp"

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <grp.h>
#include <unistd.h>

namespace boresight::broker {

gid_t group_number(const std::string& name) {
  const group* const entry = getgrnam(name.c_str());
  if (entry == nullptr) throw std::invalid_argument("there is no group '" + name + "'");
  return entry->gr_gid;
}

void admit(const supervisor::Places& places, gid_t group) {
  // The management memory first: a client needs both, and looks for the socket first.
  for (const std::filesystem::path& file :
       {places.shared_memory / supervisor::kManagementSegment, places.sockets / "roudi"}) {
    // A link is not followed: its target may be a segment.
    if (lchown(file.c_str(), static_cast<uid_t>(-1), group) != 0) {
      throw std::system_error(errno, std::generic_category(),
                              "cannot give " + file.string() + " to the members' group");
    }
  }
}

}  // namespace boresight::broker
