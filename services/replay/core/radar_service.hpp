// The service that the replay offers in place of radars, for service discovery.
#pragma once

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/sd_server.hpp"

namespace boresight::replay {

/// Identifiers of interfaces/wire/boresight_service.md.
[[nodiscard]] inline someip::OfferedService radar_service() {
  namespace service = wire::boresight_service;
  return {service::kServiceId,
          service::kMajorVersion,
          service::kMinorVersion,
          {service::kEventgroupDetections, service::kEventgroupEgoMotion}};
}

}  // namespace boresight::replay
