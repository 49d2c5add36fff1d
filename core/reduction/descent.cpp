#include <lagroid/core/reduction/descent.hpp>

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
    case Ingredient::morphism:
      break;
  }
  return {"the morphism"};
}

}  // namespace

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
      << (finding->ingredient == Ingredient::morphism ? " is none"
          : plural                                    ? " do not descend"
                                                      : " does not descend")
      << ": at the arrow (";
  for (std::size_t i = 0; i < finding->sample.size(); ++i) out << (i > 0 ? " " : "") << finding->sample[i];
  out << ") ";
  if (finding->ingredient == Ingredient::morphism)
    out << "a product, a lift or what stands for its image is off by " << finding->defect << " of its size";
  else
    out << (plural ? "they differ, by " : "it differs, by ") << finding->defect << " of " << (plural ? "their" : "its")
        << " size, from what " << (plural ? "they are" : "it is") << " at the arrow that stands for the same image";
  return out.str();
}

}  // namespace lagroid
