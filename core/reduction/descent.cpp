#include <lagroid/core/reduction/descent.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string_view>

namespace lagroid {

namespace {

struct Words {
  std::string_view subject;
  bool plural = false;
};

Words words_of(Ingredient ingredient) {
  switch (ingredient) {
    case Ingredient::lagrangian:
      return {"the Lagrangian"};
    case Ingredient::constraint:
      return {"the constraint"};
    case Ingredient::object_constraint:
      return {"the object constraint"};
    case Ingredient::forces:
      return {"the forces", true};
    case Ingredient::distribution:
      return {"the distribution"};
    case Ingredient::routhian:
      return {"the Routhian"};
    case Ingredient::morphism:
      break;
  }
  return {"the morphism"};
}

}  // namespace

void detail::DescentTally::add(const double* there, const double* here, int count, std::span<const double> sample) {
  double difference = 0;
  double of_there = 0;
  double of_here = 0;
  for (int i = 0; i < count; ++i) {
    difference += (there[i] - here[i]) * (there[i] - here[i]);
    of_there += there[i] * there[i];
    of_here += here[i] * here[i];
  }
  difference = std::sqrt(difference);
  size_ = std::max({size_, std::sqrt(of_there), std::sqrt(of_here)});
  if (difference > largest_ || !std::isfinite(difference) || finding_.sample.empty()) {
    largest_ = std::isfinite(difference) ? difference : std::numeric_limits<double>::infinity();
    finding_.sample.assign(sample.begin(), sample.end());
  }
}

const DescentFinding* DescentReport::worst() const {
  const DescentFinding* found = nullptr;
  for (const auto& finding : findings) {
    if (finding.defect <= tolerance) continue;
    if (finding.ingredient == Ingredient::morphism) return &finding;
    if (found == nullptr || finding.defect > found->defect) found = &finding;
  }
  return found;
}

std::string DescentReport::sentence() const {
  const DescentFinding* finding = worst();
  if (finding == nullptr) return "";
  if (finding->sample.empty()) return "nothing was sampled, so that nothing is known to descend";
  std::ostringstream out;
  out.precision(6);
  const auto [subject, plural] = words_of(finding->ingredient);
  out << subject
      << (finding->ingredient == Ingredient::morphism   ? " is none"
          : finding->ingredient == Ingredient::routhian ? " is not that of the Lagrangian"
          : plural                                      ? " do not descend"
                                                        : " does not descend")
      << ": at the arrow (";
  for (std::size_t i = 0; i < finding->sample.size(); ++i) out << (i > 0 ? " " : "") << finding->sample[i];
  out << ") ";
  if (finding->ingredient == Ingredient::morphism)
    out << "a product, a lift or what stands for its image is off by " << finding->defect << " of its size";
  else if (finding->ingredient == Ingredient::routhian)
    out << "of the base its closed form, or the angle by it, is off by " << finding->defect << " of its size";
  else
    out << (plural ? "they differ, by " : "it differs, by ") << finding->defect << " of " << (plural ? "their" : "its")
        << " size, from what " << (plural ? "they are" : "it is") << " at the arrow that stands for the same image";
  return out.str();
}

}  // namespace lagroid
