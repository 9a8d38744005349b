#include "deploy/roudi/pools.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <iceoryx_posh/mepoo/chunk_header.hpp>
#include <iceoryx_posh/mepoo/chunk_settings.hpp>

#include "deploy/catalogue/catalogue_text.hpp"
#include "interfaces/catalogue/catalogue.hpp"

namespace boresight::roudi {
namespace {

std::string file(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(BORESIGHT_SOURCE_DIR) / "deploy" / "roudi" / name).rdbuf();
  return text.str();
}

const Pool* pool_for(const Segment& segment, std::size_t payload_bytes) {
  for (const Pool& pool : segment.pools) {
    if (pool.chunk_bytes >= chunk_bytes_for(payload_bytes)) return &pool;
  }
  return nullptr;
}

TEST(RoudiPools, CommittedFilesAreWhatTheCatalogueAsksFor) {
  EXPECT_EQ(file("roudi.toml"), to_toml(single_segment())) << "build/bin/boresight catalogue --roudi";
  EXPECT_EQ(file("roudi-deployed.toml"), to_toml(segment_per_writer())) << "… --roudi --deployed";
}

TEST(RoudiPools, ChunksHoldEveryMessageAlignedToACacheLine) {
  for (const auto& topic : catalogue::kTopics) {
    const auto settings = iox::mepoo::ChunkSettings::create(static_cast<std::uint32_t>(topic.payload_bytes), 64);
    ASSERT_FALSE(settings.has_error());
    // RouDi adds the header to the configured size.
    EXPECT_LE(settings.value().requiredChunkSize(),
              chunk_bytes_for(topic.payload_bytes) + sizeof(iox::mepoo::ChunkHeader))
        << topic.name;
    EXPECT_EQ(chunk_bytes_for(topic.payload_bytes) % 8, 0U);
  }
}

TEST(RoudiPools, CountsCoverEveryQueueFullAndEveryWriterAtItsLimit) {
  const Segment all = single_segment().at(0);
  // By hand for the radar scans, which share their size with nothing: readers are three services, three monitors and
  // the replay, each with a queue of 4 × 16 radars and one in hand; in the corrector, the newest of 16 radars wait. The
  // gateway holds 8 loans and the last chunk. 7·65 + 16 + 9 = 480.
  ASSERT_NE(pool_for(all, sizeof(RadarScan)), nullptr);
  EXPECT_EQ(pool_for(all, sizeof(RadarScan))->count, 480U);
  std::size_t wanted = 0;
  std::size_t there = 0;
  for (const auto& topic : catalogue::kTopics) {
    const std::size_t readers = topic.readers.size() - 1 + catalogue::kMaxMonitors;
    wanted += readers * (catalogue::queue_capacity(topic) + 1) + topic.writers.size() * (topic.history + 9);
    wanted += topic.newest_first.size() * kMaxRadars;
  }
  for (const Pool& pool : all.pools) there += pool.count;
  EXPECT_GE(there, wanted);
  EXPECT_LE(there, wanted + 8 * all.pools.size());
}

TEST(RoudiPools, PoolsAscendAndEachSizeAppearsOnce) {
  for (const auto& segments : {single_segment(), segment_per_writer()}) {
    for (const Segment& segment : segments) {
      for (std::size_t i = 1; i < segment.pools.size(); ++i) {
        EXPECT_LT(segment.pools[i - 1].chunk_bytes, segment.pools[i].chunk_bytes);
      }
    }
  }
}

TEST(RoudiPools, EveryWriterHasItsOwnSegmentWithRoomForItsTopics) {
  const auto segments = segment_per_writer();
  EXPECT_EQ(segments.size(), catalogue::kNumberOfSupervisedServices);
  for (const Segment& segment : segments) {
    EXPECT_EQ(segment.reader_group, "boresight");
    for (const auto& topic : catalogue::kTopics) {
      for (std::size_t i = 0; i < catalogue::kNumberOfServices; ++i) {
        if (!segment.writer_group.ends_with(catalogue::kServiceNames[i])) continue;
        if (!topic.writers.contains(static_cast<catalogue::Service>(i))) continue;
        EXPECT_NE(pool_for(segment, topic.payload_bytes), nullptr) << topic.name;
      }
    }
  }
}

TEST(RoudiPools, EachSegmentHoldsWhatItsWriterAndAllReadersNeedAndHardlyMore) {
  for (const Segment& segment : segment_per_writer()) {
    std::size_t wanted = 0;
    for (const auto& topic : catalogue::kTopics) {
      for (std::size_t i = 0; i < catalogue::kNumberOfServices; ++i) {
        if (segment.writer_group != "boresight-" + std::string(catalogue::kServiceNames[i])) continue;
        if (!topic.writers.contains(static_cast<catalogue::Service>(i))) continue;
        // Queues and hands of all readers; 8 loans, the history and the last chunk of the one writer.
        const std::size_t readers = topic.readers.size() - 1 + catalogue::kMaxMonitors;
        wanted += readers * (catalogue::queue_capacity(topic) + 1) + topic.newest_first.size() * kMaxRadars;
        wanted += topic.history + 9;
      }
    }
    std::size_t there = 0;
    for (const Pool& pool : segment.pools) there += pool.count;
    EXPECT_GE(there, wanted) << segment.writer_group;
    EXPECT_LT(there, wanted + 8 * segment.pools.size()) << segment.writer_group;
  }
}

TEST(RoudiPools, SegmentsOfWritersHaveTheChunksOfTheSingleSegmentAndMoreOnlyForHeartbeats) {
  const Segment all = single_segment().at(0);
  const std::size_t status = chunk_bytes_for(sizeof(ServiceStatus));
  for (const Pool& pool : all.pools) {
    std::size_t count = 0;
    for (const Segment& segment : segment_per_writer()) {
      for (const Pool& of_writer : segment.pools)
        count += of_writer.chunk_bytes == pool.chunk_bytes ? of_writer.count : 0;
    }
    // A reader's queue of heartbeats may be full of those of one service, whichever it is.
    if (pool.chunk_bytes == status) {
      EXPECT_GT(count, pool.count);
    } else {
      EXPECT_EQ(count, pool.count) << pool.chunk_bytes;
    }
  }
}

TEST(RoudiPools, NoServiceMayWriteToTwoSegmentsOrToAllByReading) {
  // iceoryx ends a process that may write to two segments.
  const auto segments = segment_per_writer();
  for (const Segment& segment : segments) {
    EXPECT_NE(segment.writer_group, segment.reader_group);
    EXPECT_NE(segment.writer_group, "boresight-roudi") << "the group of RouDi may write to all segments";
    EXPECT_EQ(std::count_if(segments.begin(), segments.end(),
                            [&](const Segment& other) { return other.writer_group == segment.writer_group; }),
              1);
  }
}

TEST(CatalogueText, NamesEveryTopicOnceAPicture) {
  const std::string table = catalogue::to_table();
  const std::string markdown = catalogue::to_markdown();
  for (const auto& topic : catalogue::kTopics) {
    std::ostringstream row;
    row << "| " << topic.name << " | " << topic.type << " |";
    EXPECT_THAT(markdown, ::testing::HasSubstr(row.str()));
    std::ostringstream start;
    start << '\n' << topic.name << ' ';
    EXPECT_THAT(table, ::testing::HasSubstr(start.str()));
  }
  EXPECT_THAT(markdown, ::testing::HasSubstr("  tracker -- track_list --> ghost_filter\n"));
  EXPECT_THAT(table, ::testing::HasSubstr("every service"));
}

}  // namespace
}  // namespace boresight::roudi
