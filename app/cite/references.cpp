#include "references.hpp"

#include "../bodies/scene_bodies.hpp"
#include "../families/registry.hpp"
#include "../optimise/methods.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace lagroid::app {

namespace {

const Reference& named(std::string_view key) {
  const auto all = references();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Reference& r) { return r.key == key; });
  if (found == all.end()) throw std::logic_error("no reference " + std::string(key));
  return *found;
}

/// Systems on (T*S^2)^k.
std::vector<Use> uses_of_spheres(const SphereEntry& entry, const Section& time) {
  constexpr std::string_view rattle = "rattle";  // of pendulum chains, where no other is named
  std::vector<std::string> names{std::string(rattle)};
  for (const LieGroupMethod& method : lie_group_methods::all) names.emplace_back(method.name);
  const bool learned = entry.name == "learned_hamiltonian";
  std::vector<Use> uses;
  if (learned) uses = uses_of_learning();
  if (time.choice_or("method", learned ? names.back() : names.front(), names) == rattle) {
    uses.push_back({&named("marrero2015"), "discrete mechanics with constraints, of which RATTLE is a case"});
  } else {
    uses.push_back({&named("celledoni2022"), "Lie group integrators on products of T*S^2"});
  }
  return uses;
}

/// Steps of a size that varies, and the one method that papers were written on.
void add_uses_of_time(const std::string& mode, const std::string& method, std::vector<Use>& uses) {
  if (mode == "adaptive") uses.push_back({&named("kane1999"), "steps whose size keeps the discrete energy"});
  if (mode == "controlled") uses.push_back({&named("hairer2005"), "reversibly controlled steps"});
  if (method == "moser-veselov")
    uses.push_back({&named("hairer2006"), "the preprocessed discrete Moser-Veselov algorithm"});
}

std::vector<Use> uses_of_minimisation(const Section& scene) {
  std::vector<std::string> names;
  for (const auto& entry : optimisers()) names.emplace_back(entry.name);
  const std::string name = scene.section_or_empty("method").choice_or("name", names.front(), names);
  constexpr std::array<std::string_view, 3> competitors{"gradient-descent", "conjugate-gradients", "trust-region"};
  if (std::find(competitors.begin(), competitors.end(), name) != competitors.end()) return {};
  return {{&named("duruisseaux2022"), "accelerated optimisation by discrete constrained variational integrators"}};
}

}  // namespace

std::span<const Reference> references() {
  static const std::vector<Reference> all{
      {"marrero2015",
       "G",
       {{"Juan Carlos", "Marrero"}, {"David", "Martín de Diego"}, {"Ari", "Stern"}},
       "Symplectic groupoids and discrete constrained Lagrangian mechanics",
       "Discrete and Continuous Dynamical Systems",
       35,
       1,
       "367",
       "397",
       2015,
       "10.3934/dcds.2015.35.367",
       "1103.6250"},
      {"owren2000",
       "N",
       {{"Brynjulf", "Owren"}, {"Bruno", "Welfert"}},
       "The Newton iteration on Lie groups",
       "BIT Numerical Mathematics",
       40,
       1,
       "121",
       "145",
       2000,
       "10.1023/A:1022322503301",
       ""},
      {"duruisseaux2022",
       "V",
       {{"Valentin", "Duruisseaux"}, {"Melvin", "Leok"}},
       "Accelerated optimization on Riemannian manifolds via discrete constrained variational integrators",
       "Journal of Nonlinear Science",
       32,
       4,
       "42",
       "",
       2022,
       "10.1007/s00332-022-09795-9",
       "2104.07176"},
      {"celledoni2023",
       "H",
       {{"Elena", "Celledoni"}, {"Andrea", "Leone"}, {"Davide", "Murari"}, {"Brynjulf", "Owren"}},
       "Learning Hamiltonians of constrained mechanical systems",
       "Journal of Computational and Applied Mathematics",
       417,
       0,
       "114608",
       "",
       2023,
       "10.1016/j.cam.2022.114608",
       "2201.13254"},
      {"celledoni2022",
       "",
       {{"Elena", "Celledoni"}, {"Ergys", "Çokaj"}, {"Andrea", "Leone"}, {"Davide", "Murari"}, {"Brynjulf", "Owren"}},
       "Lie group integrators for mechanical systems",
       "International Journal of Computer Mathematics",
       99,
       1,
       "58",
       "88",
       2022,
       "10.1080/00207160.2021.1966772",
       "2102.12778"},
      {"iglesias2008",
       "",
       {{"David", "Iglesias"}, {"Juan Carlos", "Marrero"}, {"David", "Martín de Diego"}, {"Eduardo", "Martínez"}},
       "Discrete nonholonomic Lagrangian systems on Lie groupoids",
       "Journal of Nonlinear Science",
       18,
       3,
       "221",
       "276",
       2008,
       "10.1007/s00332-007-9012-8",
       "0704.1543"},
      {"kane1999",
       "",
       {{"Couro", "Kane"}, {"Jerrold E.", "Marsden"}, {"Michael", "Ortiz"}},
       "Symplectic-energy-momentum preserving variational integrators",
       "Journal of Mathematical Physics",
       40,
       7,
       "3353",
       "3371",
       1999,
       "10.1063/1.532892",
       ""},
      {"hairer2005",
       "",
       {{"Ernst", "Hairer"}, {"Gustaf", "Söderlind"}},
       "Explicit, time reversible, adaptive step size control",
       "SIAM Journal on Scientific Computing",
       26,
       6,
       "1838",
       "1851",
       2005,
       "10.1137/040606995",
       ""},
      {"hairer2006",
       "",
       {{"Ernst", "Hairer"}, {"Gilles", "Vilmart"}},
       "Preprocessed discrete Moser-Veselov algorithm for the full dynamics of a rigid body",
       "Journal of Physics A: Mathematical and General",
       39,
       42,
       "13225",
       "13235",
       2006,
       "10.1088/0305-4470/39/42/006",
       ""}};
  return all;
}

std::vector<Use> uses_of_learning() {
  return {{&named("celledoni2023"), "Hamiltonians on (T*S^2)^k learned through Lie group integrators"}};
}

std::vector<Use> uses_of(const Section& scene) {
  if (scene.has("problem")) return uses_of_minimisation(scene);
  const Section time = scene.section_or_empty("time");
  if (!scene.has("body"))
    if (const SphereEntry* spheres = sphere_system_of(scene)) return uses_of_spheres(*spheres, time);
  const std::string mode = time.choice_or("mode", "fixed", {"fixed", "adaptive", "controlled", "transformed"});
  const std::string method =
      time.choice_or("method", "variational", {"variational", "splitting", "moser-veselov", "runge-kutta"});
  std::vector<Use> uses{{&named("marrero2015"), "discrete constrained mechanics on Lie groupoids"}};
  add_uses_of_time(mode, method, uses);
  const bool bodies = scene.has("body");
  const auto nonholonomic = []<class Sys>(const Entry<Sys>&) { return Sys::principle == Principle::nonholonomic; };
  if (bodies ? read_scene_bodies(scene).nonholonomic : with_system_of(scene, nonholonomic))
    uses.push_back({&named("iglesias2008"), "nonholonomic constraints on Lie groupoids"});
  if (bodies) return uses;
  const std::string solver =
      scene.section_or_empty("solver").choice_or("method", "newton", {"newton", "shooting", "ceres"});
  if (mode != "transformed" && method == "variational" && solver == "newton")
    uses.push_back({&named("owren2000"), "Newton's iteration, carried from Lie groups to groupoids"});
  return uses;
}

}  // namespace lagroid::app
