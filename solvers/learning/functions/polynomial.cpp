#include <lagroid/solvers/learning/functions/polynomial.hpp>

#include <fmt/format.h>

#include <random>
#include <stdexcept>

namespace lagroid::learning {

Polynomial::Polynomial(int inputs, int degree) : inputs_(inputs), degree_(degree) {
  if (inputs < 1 || degree < 1)
    throw std::invalid_argument("a polynomial has numbers to depend on, and a degree of one or more");
  int begin = -1;  // of the monomials of the degree before
  int end = 0;
  for (int d = 1; d <= degree; ++d) {
    // Coordinates come in falling order, so that each monomial is made once.
    for (int parent = begin; parent < end; ++parent) {
      const int last = parent < 0 ? inputs - 1 : monomials_[std::size_t(parent)].variable;
      for (int variable = 0; variable <= last; ++variable) monomials_.push_back({parent, variable});
      if (size() > most)
        throw std::invalid_argument(
            fmt::format("a polynomial of degree {} in {} coordinates has more than {} monomials; lower the degree, or "
                        "take a network",
                        degree, inputs, most));
    }
    begin = begin < 0 ? 0 : end;
    end = size();
  }
}

std::vector<int> Polynomial::powers(int a) const {
  std::vector<int> out(std::size_t(inputs_), 0);
  for (; a >= 0; a = monomials_[std::size_t(a)].parent) ++out[std::size_t(monomials_[std::size_t(a)].variable)];
  return out;
}

std::string Polynomial::formula(const Eigen::VectorXd& theta, std::span<const std::string> names,
                                std::size_t longest) const {
  std::string out;
  for (int a = 0; a < size(); ++a) {
    out += fmt::format("{}({})", a == 0 ? "" : " + ", theta(a));
    for (int at = a; at >= 0; at = monomials_[std::size_t(at)].parent)
      out += "*" + names[std::size_t(monomials_[std::size_t(at)].variable)];
  }
  return out.size() > longest ? std::string() : out;
}

Eigen::VectorXd Polynomial::start(unsigned seed) const {
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(size());
  if (seed == 0) return theta;
  std::mt19937 generator(seed);
  for (int a = 0; a < size(); ++a) {
    const int parent = monomials_[std::size_t(a)].parent;
    const bool quadratic = parent >= 0 && monomials_[std::size_t(parent)].parent < 0;
    if (quadratic) theta(a) = 0.5 * (double(generator()) / 4294967296.0) - 0.25;
  }
  return theta;
}

}  // namespace lagroid::learning
