#include "references.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace lagroid::app {

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

const Reference& reference(std::string_view key) {
  const auto all = references();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Reference& r) { return r.key == key; });
  if (found == all.end()) throw std::logic_error("no reference " + std::string(key));
  return *found;
}

std::vector<Use> uses_of_learning() {
  return {{&reference("celledoni2023"), "Hamiltonians on (T*S^2)^k learned through Lie group integrators"}};
}

}  // namespace lagroid::app
