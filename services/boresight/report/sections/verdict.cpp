// What was checked and whether it passed.
#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

std::string render_verdict(const ReportInput& input, const Summary& summary) {
  std::string text = fmt::format("<div class=\"verdict{}\"><b>{}</b><ul>\n", summary.all_passed() ? "" : " bad",
                                 summary.all_passed() ? "Everything worked." : "Not everything worked.");
  for (const Check& check : summary.checks) {
    text += fmt::format("<li><span class=\"{}\">{}</span> {}</li>\n", check.passed ? "good" : "bad",
                        check.passed ? "✓" : "✗", escape(check.what));
  }
  text += "</ul></div>\n";
  if (!input.truth.known()) text += "<p class=\"faint\">No truth is known for this drive.</p>\n";
  return text;
}

}  // namespace boresight::report
