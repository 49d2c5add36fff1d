#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>

#include <fmt/format.h>

#include <stdexcept>

namespace lagroid::learning {

PolynomialPotential::PolynomialPotential(int bodies, int degree) : bodies_(bodies), degree_(degree) {
  if (bodies < 1 || degree < 1)
    throw std::invalid_argument("a polynomial potential has bodies and a degree of one or more");
  int begin = -1;  // of the monomials of the degree before
  int end = 0;
  for (int d = 1; d <= degree; ++d) {
    // Coordinates come in falling order, so that each monomial is made once.
    for (int parent = begin; parent < end; ++parent) {
      const int last = parent < 0 ? 3 * bodies - 1 : monomials_[std::size_t(parent)].variable;
      for (int variable = 0; variable <= last; ++variable) monomials_.push_back({parent, variable});
      if (size() > most)
        throw std::invalid_argument(
            fmt::format("a polynomial of degree {} in {} coordinates has more than {} monomials; lower the degree, or "
                        "take a network",
                        degree, 3 * bodies, most));
    }
    begin = begin < 0 ? 0 : end;
    end = size();
  }
}

std::vector<int> PolynomialPotential::powers(int a) const {
  std::vector<int> out(std::size_t(3 * bodies_), 0);
  for (; a >= 0; a = monomials_[std::size_t(a)].parent) ++out[std::size_t(monomials_[std::size_t(a)].variable)];
  return out;
}

}  // namespace lagroid::learning
