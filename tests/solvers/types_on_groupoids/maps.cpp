// Types I, II and III on vectors, and on a sphere: which are one map.
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace types_on_groupoids_maps_tests {
namespace {

using enum GeneratingType;
constexpr double h = 0.1;

TEST(TypesOnGroupoids, WithoutTaylorTermsAreRectanglesOfTypeOne) {
  expect_rectangles<Swing, SwingByMomentum>({Vector<double, 1>(1.0), Vector<double, 1>(0.3)}, false);
  expect_rectangles<Bead, BeadByMomentum>(bead_start, false);
}

struct Plane : Coupled {
  static constexpr int constraints = 0;
};
template <int R, GeneratingType Kind, const QuadratureRule& Rule> double away_from_the_map_of_vectors() {
  const State<Pair<2>> start{{0.7, -0.2}, {0.4, 0.5}};
  auto run = make(HamiltonianTaylor<Coupled, R, Kind, Rule>{{}, h}, start);
  Phase<2, 0> point{start.object, start.momentum};
  double worst = 0;
  for (int k = 0; k < 20; ++k) {
    const TaylorHamiltonian<Plane, R> function{{}, Rule};
    SolveStatus status;
    if constexpr (Kind == two) {
      status = HamiltonianMap(function).step(point, h);
    } else {
      status = HamiltonianMap(adjoint_of(function)).step(point, h);
    }
    if (!run.advance().converged() || status != SolveStatus::converged) return INFINITY;
    const auto& s = run.point().state;
    worst = std::max({worst, (s.object - point.q).norm(), (s.momentum - point.p).norm()});
  }
  return worst;
}
TEST(TypesOnGroupoids, OnPairsAreThoseOfVectors) {
  using namespace quadrature_rules;
  EXPECT_LT((away_from_the_map_of_vectors<0, two, trapezoid>()), agreement);
  EXPECT_LT((away_from_the_map_of_vectors<1, two, trapezoid>()), agreement);
  EXPECT_LT((away_from_the_map_of_vectors<1, three, trapezoid>()), agreement);
  EXPECT_LT((away_from_the_map_of_vectors<3, two, gauss_2>()), agreement);
}

struct TwoWells : ContinuousHamiltonian<TwoWells, Pair<1>> {
  template <class S> S hamiltonian(const Vector<S, 1>&, const Vector<S, 1>& p) const {
    return p(0) * p(0) * p(0) * p(0) * 0.25 - p(0) * p(0) * 0.5;
  }
};
TEST(TypesOnGroupoids, EnergyIsTheHamiltonianWhereItIsNotConvexToo) {
  for (const double p : {0.3, 0.9, 1.1}) {
    const Vector<double, 1> q(0.0), momentum(p);
    EXPECT_EQ((HamiltonianTaylor<TwoWells, 1>{{}, h}.energy({q, momentum})), TwoWells{}.hamiltonian(q, momentum)) << p;
  }
}

struct Bounded : ContinuousHamiltonian<Bounded, Pair<1>> {
  template <class S> S hamiltonian(const Vector<S, 1>&, const Vector<S, 1>& p) const {
    using std::sqrt;
    return sqrt(p(0) * p(0) + 1.0);  // no velocity beyond one
  }
};
TEST(TypesOnGroupoids, WithoutAMomentumAreNoNumbers) {
  const HamiltonianTaylor<Bounded, 1> system{{}, h};
  const PairArrow<double, 1> slow{Vector<double, 1>(0.0), Vector<double, 1>(0.5 * h)};
  const PairArrow<double, 1> fast{Vector<double, 1>(0.0), Vector<double, 1>(2 * h)};
  EXPECT_NEAR(system.lagrangian(slow), -h * std::sqrt(0.75), 1e-15);
  EXPECT_TRUE(std::isnan(system.lagrangian(fast)));
}

}  // namespace
}  // namespace types_on_groupoids_maps_tests
