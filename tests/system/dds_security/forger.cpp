#include "tests/system/dds_security/forger.hpp"

#include <type_traits>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <signal.h>

#include "generated/sensor_healthPubSubTypes.h"
#include "services/health/dds/topics.hpp"

namespace boresight {

namespace {

namespace fast = eprosima::fastdds::dds;

constexpr double kPeriod_s = 0.05;

void secure_without_checks(fast::DomainParticipantQos& qos, const std::string& folder) {
  const auto set = [&qos](const std::string& name, const std::string& value) {
    qos.properties().properties().emplace_back("dds.sec." + name, value);
  };
  const std::string file = "file://" + folder + "/";
  set("auth.plugin", "builtin.PKI-DH");
  set("access.plugin", "builtin.Access-Permissions");
  set("crypto.plugin", "builtin.AES-GCM-GMAC");
  set("auth.builtin.PKI-DH.identity_ca", file + "identity_ca.pem");
  set("auth.builtin.PKI-DH.identity_certificate", file + "certificate.pem");
  set("auth.builtin.PKI-DH.private_key", file + "private_key.pem");
  set("access.builtin.Access-Permissions.permissions_ca", file + "permissions_ca.pem");
  set("access.builtin.Access-Permissions.governance", file + "governance.p7s");
  set("access.builtin.Access-Permissions.permissions", file + "permissions.p7s");
}

/// What the health service offers with the default period of a second; a reader of ours matches nothing less.
template <typename Qos>
Qos as_health_service() {
  Qos qos;
  qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  qos.deadline().period = eprosima::fastrtps::Duration_t(1, 500'000'000);
  qos.liveliness().lease_duration = eprosima::fastrtps::Duration_t(1, 500'000'000);
  if constexpr (std::is_same_v<Qos, fast::DataWriterQos>) {
    qos.liveliness().announcement_period = eprosima::fastrtps::Duration_t(0, 500'000'000);
  }
  return qos;
}

}  // namespace

Forger::Forger(std::uint32_t domain, const std::string& credentials)
    : child_(std::make_unique<harness::Child>(
          [this, domain, credentials] { return run(*counts_, domain, credentials); })) {}

Forger::~Forger() {
  child_->send(SIGKILL);
}

int Forger::run(Counts& counts, std::uint32_t domain, const std::string& credentials) {
  while (!counts.may_begin) harness::sleep_s(kPeriod_s);
  fast::DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};  // where the service is
  qos.transport().user_transports.push_back(udp);
  if (!credentials.empty()) secure_without_checks(qos, credentials);
  fast::DomainParticipant* const participant =
      fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
  if (participant == nullptr) return counts.failed = true, 1;
  const fast::TypeSupport type(new diagnostics::SensorHealthPubSubType());
  type.register_type(participant);
  fast::Topic* const topic =
      participant->create_topic(dds::kSensorHealthTopic.name, type.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  fast::DataWriter* const writer = participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                                       ->create_datawriter(topic, as_health_service<fast::DataWriterQos>());
  fast::DataReader* const reader = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
                                       ->create_datareader(topic, as_health_service<fast::DataReaderQos>());
  if (writer == nullptr || reader == nullptr) return counts.failed = true, 1;
  diagnostics::SensorHealth forged;
  forged.radar_id(kForgedRadar);
  forged.radar_name("front_right");
  forged.vehicle_name("demo");
  forged.time_ns(kForgedTime_ns);
  forged.data_qualifier(diagnostics::AVAILABLE);
  for (;;) {
    writer->write(&forged);
    diagnostics::SensorHealth received;
    fast::SampleInfo info;
    while (reader->take_next_sample(&received, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data && received.time_ns() != kForgedTime_ns) ++counts.read;
    }
    harness::sleep_s(kPeriod_s);
  }
}

}  // namespace boresight
