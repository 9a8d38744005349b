// Terms of the page, explained.
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "services/boresight/report/sections/sections.hpp"

namespace boresight::report {

namespace {

struct Term {
  std::string_view name, meaning;
};

constexpr std::array kTerms = {
    Term{"Scan", "All detections of one radar in one measurement cycle."},
    Term{"Mounting error", "Rotation of a radar's actual mounting against its nominal mounting: yaw, pitch, roll."},
    Term{"Tolerance",
         "Largest mounting error that the vehicle file permits. A radar is reported as MISALIGNED if its "
         "error is significantly larger."},
    Term{"Speed scale", "True speed divided by the speed that the vehicle signals."},
    Term{"σ", "Standard deviation that the estimator states for its estimate."},
    Term{"NEES",
         "Normalised estimation error squared: squared errors relative to the stated covariance, per estimated "
         "parameter. It is 1 on average if the stated covariance is right."},
    Term{"Provenance",
         "Origin of a detection: direct reflection of a moving or of a stationary object, ghost of type 1 "
         "or 2, clutter, or ambiguity."},
    Term{"Ghost",
         "Detection of a moving object by way of a mirror, for example a guard rail. It appears where no object "
         "is. Type 1: last reflection at the object. Type 2: last reflection at the mirror."},
    Term{"Ambiguity",
         "Detection of a real reflection with a wrong range rate or angle, because the radar measures both only up to "
         "multiples of an interval."},
    Term{"Rejected by the corrector",
         "The detection corrector marked the detection as invalid, weak or outside the "
         "region of interest. No later stage uses it."},
    Term{"Check, aim", "A check must hold, or the run fails. An aim is a target value that a single drive may miss."},
};

}  // namespace

std::string render_terms() {
  std::string text = "<details><summary>Terms on this page</summary>\n<dl>\n";
  for (const Term& term : kTerms) text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", term.name, term.meaning);
  return text + "</dl></details>\n";
}

}  // namespace boresight::report
