// Service discovery's description of the service that the replay offers in place of radars.
#pragma once

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/someip/sd_server.hpp"

namespace boresight::replay {

/// The identifiers of interfaces/wire/boresight_service.md.
[[nodiscard]] inline someip::OfferedService radar_service() {
  namespace service = wire::boresight_service;
  return {service::kServiceId,
          service::kMajorVersion,
          service::kMinorVersion,
          {service::kEventgroupDetections, service::kEventgroupEgoMotion}};
}

}  // namespace boresight::replay
