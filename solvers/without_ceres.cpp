// In the place of what goes through Ceres, in a build without it.
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/solvers/missing_library.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/step/ceres_fibre.hpp>

namespace lagroid {

namespace {

[[noreturn]] void refuse(std::string_view asked) { throw MissingLibrary(asked, "Ceres", "libceres-dev"); }

}  // namespace

struct FibreProblem::Work {};

FibreProblem::FibreProblem(const FibreEquations&, int) { refuse("the solver \"ceres\" of a step"); }
FibreProblem::~FibreProblem() = default;
int FibreProblem::solve(double*, double*) { return 0; }

detail::CeresRoot detail::minimise_by_ceres(const ChartFunction&, Eigen::VectorXd, int) {
  refuse("the solver \"ceres\" of equations on fibres");
}

learning::Trained learning::train(const Model&, const Trajectories&, const Training&) {
  refuse("learning a Hamiltonian");
}

}  // namespace lagroid
