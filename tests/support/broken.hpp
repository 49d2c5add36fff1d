#pragma once
/// When a law is broken, and not merely not found to hold.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/testing/law_report.hpp>

namespace lagroid::laws {

/// Whether a defect above its tolerance was seen. A law does not hold either where no sample could be asked, or where
/// an exception came in place of a defect; of a subject that is broken on purpose these show nothing. (In checked
/// builds arrows that do not compose throw before there is a defect.)
inline bool seen_broken(const Law& law) {
  return law.worst > law.tolerance || (checked_build && !law.first_failure.empty());
}

}  // namespace lagroid::laws
