#include "tests/benchmarks/realism/rows/tables.hpp"

#include <algorithm>

namespace boresight::bench::realism {

namespace {

std::string text(const Measured& measured, int digits) {
  if (!measured.exists()) return "–";
  const std::string low = fixed(measured.low, digits);
  return measured.low == measured.high ? low : low + " … " + fixed(measured.high, digits);
}

Table empty_table(int section, const std::vector<Column>& columns) {
  Table table{"realism_" + std::to_string(section), section_title(section), {"figure", "unit", "R", "N"}, {}};
  for (const Column& column : columns) {
    table.header.push_back(column.profile);
    if (column.figures.size() > 1) table.header.emplace_back("interval");
    if (column.source != Source::kNone) table.header.emplace_back("verdict");
  }
  return table;
}

void count(const Verdict& verdict, Tally& tally) {
  tally.met += verdict.outcome == Outcome::kMet ? 1 : 0;
  tally.met_by_interval += verdict.outcome == Outcome::kMetByInterval ? 1 : 0;
  tally.missed += verdict.outcome == Outcome::kMissed ? 1 : 0;
  tally.without_data += verdict.outcome == Outcome::kNoData ? 1 : 0;
}

}  // namespace

bool Tables::all_met() const {
  return std::all_of(tallies.begin(), tallies.end(), [](const Tally& t) { return t.all_met(); });
}

std::vector<double> figures_of(const Statistics& statistics) {
  std::vector<double> figures;
  for (const Row& row : all_rows()) figures.push_back(row.figure(statistics));
  return figures;
}

Tables make_tables(const std::vector<Column>& columns) {
  Tables out;
  for (const Column& column : columns) out.tallies.push_back({column.profile});
  const std::vector<Row> rows = all_rows();
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    if (out.sections.size() < static_cast<std::size_t>(row.section)) {
      out.sections.push_back(empty_table(row.section, columns));
    }
    std::vector<std::string> cells{row.name, row.unit, text(row.radar_scenes, row.digits),
                                   text(row.nuscenes, row.digits)};
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::vector<double> of_seeds;
      for (const std::vector<double>& figures : columns[c].figures) of_seeds.push_back(figures[r]);
      const Spread figure = spread_of(of_seeds);
      const Verdict verdict = judge(row, columns[c].source, figure);
      cells.push_back(fixed(figure.median, row.digits));
      if (of_seeds.size() > 1) cells.push_back(text(Measured{figure.low, figure.high}, row.digits));
      if (columns[c].source != Source::kNone) cells.push_back(verdict.text(row.scale));
      count(verdict, out.tallies[c]);
    }
    out.sections[static_cast<std::size_t>(row.section - 1)].rows.push_back(std::move(cells));
  }
  std::erase_if(out.tallies, [](const Tally& tally) { return tally.judged() == 0; });
  return out;
}

}  // namespace boresight::bench::realism
