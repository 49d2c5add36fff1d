#pragma once
/// What a law suite returns: for each law the worst defect over its samples, its tolerance, and whether it holds.
///
///     const laws::LawReport report = laws::groupoid_laws<SO3>();
///     std::cout << report;
///     return report.holds() ? 0 : 1;
///
/// Errors: `law(name)` throws std::out_of_range where the suite has no law of that name.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::laws {

/// The largest of some defects; a NaN among them makes it infinite, so that none is overlooked.
inline double worst(std::initializer_list<double> defects) {
  double largest = 0;
  for (const double d : defects) {
    if (!(d <= largest)) largest = d;
    if (std::isnan(d)) return std::numeric_limits<double>::infinity();
  }
  return largest;
}

/// One law: the worst defect over all samples, against the tolerance it was held to.
struct Law {
  std::string name;
  int samples = 0;
  double worst = 0;
  double tolerance = 0;
  std::string first_failure;    ///< the exception or the sample that broke it, if any
  int skipped = 0;              ///< samples at which it could not be tested
  std::string skipped_because;  ///< of the reasons, the commonest
  bool unjudged = false;        ///< too many were skipped

  bool holds() const { return samples > 0 && first_failure.empty() && worst <= tolerance && !unjudged; }
  std::string verdict() const { return holds() ? "holds" : unjudged ? "unjudged" : "BROKEN"; }
};

/// Every law of a suite on one subject.
struct LawReport {
  std::string subject;
  std::vector<Law> laws;

  bool holds() const {
    return !laws.empty() && std::all_of(laws.begin(), laws.end(), [](const Law& l) { return l.holds(); });
  }
  /// The law of that name; throws std::out_of_range if the suite has none.
  const Law& law(const std::string& name) const {
    for (const Law& l : laws)
      if (l.name == name) return l;
    throw std::out_of_range("no law named " + name);
  }
  friend std::ostream& operator<<(std::ostream& out, const LawReport& report) {
    out << report.subject << '\n';
    for (const Law& l : report.laws) {
      out << "  " << l.verdict() << "  " << l.name << ": worst defect " << l.worst << " (tolerance " << l.tolerance
          << ") over " << l.samples << " samples";
      if (l.skipped > 0) out << ", " << l.skipped << " skipped: " << l.skipped_because;
      if (!l.first_failure.empty()) out << "; " << l.first_failure;
      out << '\n';
    }
    return out;
  }
};

}  // namespace lagroid::laws
