// config/schema/truth.md lists the columns that the readers require, and every figure of the judges.
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "services/boresight/score/detection_truth.hpp"
#include "services/boresight/score/mounting_truth.hpp"
#include "services/boresight/score/object_truth.hpp"
#include "services/boresight/score/score.hpp"
#include "tests/unit/schema_page.hpp"
#include "tests/unit/score/made_run.hpp"

namespace boresight::score {

namespace fs = std::filesystem;

namespace {

using schema_page::Cells;

const std::filesystem::path kPage = std::filesystem::path(BORESIGHT_SOURCE_DIR) / "config/schema/truth.md";

/// Columns of each table of the page: name of the table, then column and whether it is required.
std::map<std::string, std::map<std::string, bool>> documented_columns() {
  std::map<std::string, std::map<std::string, bool>> tables;
  for (const auto& [heading, rows] : schema_page::sections(schema_page::text_of(kPage.string()))) {
    std::string table;
    for (const Cells& row : rows) {
      if (row.size() < 4 || schema_page::code(row[1]).empty()) continue;
      if (!row[0].empty()) table = row[0];
      tables[table][schema_page::code(row[1])] = row[2] == "yes";
    }
  }
  return tables;
}

/// Whether a reader accepts a table without this column.
bool is_accepted_without(const std::string& table, const std::map<std::string, bool>& columns,
                         const std::string& absent) {
  const fs::path folder = made::folder("schema");
  const fs::path file = folder / table;
  std::string header;
  for (const auto& [column, required] : columns) {
    if (column != absent) header += (header.empty() ? "" : ",") + column;
  }
  made::write_file(file, header + "\n");
  try {
    if (table == "truth_objects.csv" || table == "boxes.csv") ObjectTruth reader(file, table == "boxes.csv", {});
    if (table == "truth_visibility.csv") Visibility reader(file);
    if (table == "truth_detections.csv" || table == "labels.csv") DetectionTruth reader(file, table == "labels.csv");
    if (table == "truth_sensors.csv") {
      TruthSource source;
      source.sensors = file;
      const VehicleConfig vehicle;
      MountingTruthReader reader(source, vehicle);
    }
  } catch (const InputError&) {
    return false;
  }
  return true;
}

TEST(TruthSchema, RequiredColumnsAreThoseOfTheReaders) {
  const auto tables = documented_columns();
  EXPECT_EQ(tables.size(), 6u);
  for (const auto& [table, columns] : tables) {
    EXPECT_TRUE(is_accepted_without(table, columns, "")) << table;
    for (const auto& [column, required] : columns) {
      EXPECT_EQ(is_accepted_without(table, columns, column), !required) << table << ": " << column;
    }
  }
}

TEST(TruthSchema, ListsEveryFigure) {
  const fs::path run = made::folder("figures_run"), truth = made::folder("figures_truth");
  made::write_run(run, 31, 0.0);
  made::write_truth(truth, 31);
  const Score result = score({run, find_truth(truth), nullptr, {}});
  const std::string page = schema_page::text_of(kPage.string());
  for (const judge::Figure& figure : result.figures.all()) {
    // The last word of the name stands in backticks, alone or at the end of a longer name.
    const std::size_t first = figure.name.find('.');
    std::string last = figure.name.substr(figure.name.rfind('.') + 1);
    if (last == "5_s") last = "at_least_0.5_s";
    if (figure.name.starts_with("detections.confusion.")) last = last == "rejected" ? "rejected" : "LABEL";
    if (last == "false_moving_per_scan_p90") last = "…_p90";
    if (figure.name.starts_with("health.radar") && last.starts_with("tolerance_")) continue;
    EXPECT_TRUE(page.find("`" + last + "`") != std::string::npos || page.find("." + last + "`") != std::string::npos)
        << figure.name;
    EXPECT_NE(page.find("`" + figure.name.substr(0, first) + "."), std::string::npos) << figure.name;
  }
}

}  // namespace
}  // namespace boresight::score
