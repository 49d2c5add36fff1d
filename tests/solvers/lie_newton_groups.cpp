// Newton's iterations on every group of matrices of fixed size.
#include <lagroid/groupoids/groups/linear.hpp>
#include <lagroid/groupoids/groups/orthogonal.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>

#include <gtest/gtest.h>

#include <type_traits>

using namespace lagroid;

namespace solvers_lie_newton_groups_tests {
namespace {

/// y = z tau(h g(y)) for a field that mixes the coordinates of y, by every iteration.
template <class G> void expect_implicit_steps(const ArrowOf<G>& z) {
  const GroupoidFibre<G> fibre(z);
  const auto g = [](const auto& y) {
    const auto x = G().coordinates_of_arrow(y);
    using S = typename std::decay_t<decltype(x)>::Scalar;
    Vector<S, G::dimension> out;
    for (int i = 0; i < G::dimension; ++i) out(i) = sin(x(i) + x((i + 1) % x.size()) * 0.5 + 0.3 * i);
    return out;
  };
  const ImplicitStep step{fibre, AutomaticField(fibre, g), 0.2};
  for (const auto iteration :
       {LieIteration::version1, LieIteration::version1_by_chart, LieIteration::version2, LieIteration::fixed_point}) {
    LieNewtonOptions options;
    options.iteration = iteration;
    const auto result = lie_newton(step, Vector<double, G::dimension>::Zero(), options);
    ASSERT_TRUE(result.converged()) << G::name() << ' ' << to_string(result.status);
    const Vector<double, G::dimension> v = 0.2 * step.field().g(result.y);
    EXPECT_LT((G().coordinates_of_arrow(fibre.at(v)) - G().coordinates_of_arrow(result.y)).norm(), 1e-12) << G::name();
    if (iteration != LieIteration::fixed_point) {
      EXPECT_LE(result.iterations, 6) << G::name();
    }
  }
}
TEST(LieNewtonGroups, SolveImplicitSteps) {
  expect_implicit_steps<SO2>(SO2::exp(Vector<double, 1>(0.3)));
  expect_implicit_steps<SO3>(SO3::exp(Vector<double, 3>(0.3, -1, 0.5)));
  Matrix<double, 3, 3> reflected = Matrix<double, 3, 3>::Identity();
  reflected(0, 0) = -1;
  expect_implicit_steps<Orthogonal<3>>(reflected);
  expect_implicit_steps<Orthogonal<4>>(Matrix<double, 4, 4>::Identity());
  expect_implicit_steps<SE2>(SE2::exp(Vector<double, 3>(0.3, -1, 0.5)));
  expect_implicit_steps<SE3>(SE3::exp(Vector<double, 6>(0.3, -0.2, 0.1, 1, 0.5, -1)));
  expect_implicit_steps<Linear<2>>(Linear<2>::exp(Vector<double, 4>(0.3, -0.2, 0.1, 0.2)));
  expect_implicit_steps<SpecialLinear<3>>(Matrix<double, 3, 3>::Identity());
}

}  // namespace
}  // namespace solvers_lie_newton_groups_tests
