// The links that a vehicle needs: one a CAN interface and one a UDP port, however many radars share it.
#pragma once

#include <memory>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/links/link.hpp"

namespace boresight::ingest {

[[nodiscard]] std::vector<std::unique_ptr<Link>> make_live_links(const VehicleConfig& vehicle,
                                                                 const LinkEvents& events);

}  // namespace boresight::ingest
