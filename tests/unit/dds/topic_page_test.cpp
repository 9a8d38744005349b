#include "services/health/dds/topic_page.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "generated/alignment_estimatePubSubTypes.h"
#include "generated/diagnostic_arrayPubSubTypes.h"
#include "generated/fault_memoryPubSubTypes.h"
#include "generated/sensor_healthPubSubTypes.h"
#include "generated/service_statusPubSubTypes.h"
#include "generated/system_healthPubSubTypes.h"
#include "generated/track_listPubSubTypes.h"

namespace boresight::dds {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(fs::path(BORESIGHT_SOURCE_DIR) / path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(DdsTopicPage, IsInTheDocumentationAsItIs) {
  EXPECT_NE(text_of("docs/dds.md").find(topics_as_markdown()), std::string::npos)
      << "paste the output of `boresight catalogue --dds`";
}

TEST(DdsTopicPage, DescribesEveryTopicOnce) {
  for (const TopicQos& topic : kTopics) {
    const auto described =
        std::count_if(kTopicDescriptions.begin(), kTopicDescriptions.end(),
                      [&](const TopicDescription& d) { return std::string_view(d.qos->name) == topic.name; });
    EXPECT_EQ(described, 1) << topic.name;
  }
}

TEST(DdsTopicPage, NamesTypeAndKeyAsTheIdlDoes) {
  for (const TopicDescription& topic : kTopicDescriptions) {
    const std::string idl = text_of(fs::path("interfaces/idl") / topic.idl);
    const std::string type = topic.type;
    const std::string name = type.substr(type.rfind(':') + 1);
    const std::size_t begin = idl.find("struct " + name + " {");
    ASSERT_NE(begin, std::string::npos) << type;
    const std::string body = idl.substr(begin, idl.find("};", begin) - begin);
    const std::size_t key = body.find("@key");
    if (std::string_view(topic.key).empty()) {
      EXPECT_EQ(key, std::string::npos) << type;
    } else {
      ASSERT_NE(key, std::string::npos) << type;
      const std::string line = body.substr(key, body.find(';', key) - key);
      EXPECT_TRUE(line.ends_with(" " + std::string(topic.key))) << line;
    }
  }
}

TEST(DdsTopicPage, NamesTheTypeAsTheMiddlewareRegistersIt) {
  const std::array<std::shared_ptr<eprosima::fastdds::dds::TopicDataType>, kTopics.size()> types = {
      std::make_shared<diagnostics::SensorHealthPubSubType>(),
      std::make_shared<diagnostics::SystemHealthPubSubType>(),
      std::make_shared<perception::TrackListPubSubType>(),
      std::make_shared<diagnostics::AlignmentEstimatePubSubType>(),
      std::make_shared<diagnostics::ServiceStatusPubSubType>(),
      std::make_shared<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType>(),
      std::make_shared<diagnostics::FaultRecordPubSubType>(),
      std::make_shared<diagnostics::FaultMemoryStatePubSubType>(),
      std::make_shared<diagnostics::ClearCommandPubSubType>(),
      std::make_shared<diagnostics::CommandReplyPubSubType>()};
  for (std::size_t i = 0; i < types.size(); ++i) {
    EXPECT_STREQ(types[i]->getName(), kTopicDescriptions[i].type);
    EXPECT_EQ(types[i]->m_isGetKeyDefined, std::string_view(kTopicDescriptions[i].key) != "") << types[i]->getName();
  }
}

}  // namespace
}  // namespace boresight::dds
