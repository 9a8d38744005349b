// What was checked and whether it passed.
#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

std::string render_verdict(const ReportInput& input, const Summary& summary) {
  const std::size_t missed = summary.missed_aims();
  std::string text = fmt::format("<div class=\"verdict{}\"><b>{}</b>", summary.all_passed() ? "" : " bad",
                                 summary.all_passed() ? "All checks passed." : "Not all checks passed.");
  if (missed > 0)
    text += fmt::format(" <span class=\"warn\">{} {} missed.</span>", missed, missed == 1 ? "aim was" : "aims were");
  text += "<ul>\n";
  for (const Check& check : summary.checks) {
    text +=
        fmt::format("<li><span class=\"{}\">{}</span> {}</li>\n", check.passed ? "good" : (check.aim ? "warn" : "bad"),
                    check.passed ? "✓" : (check.aim ? "missed:" : "✗"), escape(check.what));
  }
  text += "</ul></div>\n";
  if (!input.truth.known())
    text += "<p class=\"faint\">No truth is known for this drive, so estimates are not compared with it.</p>\n";
  return text;
}

}  // namespace boresight::report
