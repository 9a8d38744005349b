#include "interfaces/catalogue/catalogue.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "deploy/catalogue/catalogue_text.hpp"

namespace boresight::catalogue {
namespace {

TEST(CatalogueText, TheDocumentationHasItAsItIs) {
  std::ifstream file(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "docs/architecture.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  ASSERT_FALSE(page.empty());
  EXPECT_NE(page.find(to_markdown()), std::string::npos) << "paste the output of `boresight catalogue --markdown`";
}

TEST(CatalogueText, NamesEveryTopic) {
  for (const Topic& topic : kTopics) {
    EXPECT_NE(to_table().find(topic.name), std::string::npos) << topic.name;
    EXPECT_NE(to_markdown().find(topic.type), std::string::npos) << topic.type;
  }
}

}  // namespace
}  // namespace boresight::catalogue
