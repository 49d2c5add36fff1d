#pragma once
/// Brings boundary-value problems of a system to algorithms that know its sizes alone (SizedSystem), and their
/// solutions back. So the algorithms are compiled once for a list of sizes, and a user's system need not compile them
/// again.

#include <lagroid/core/any_system/sized_system.hpp>
#include <lagroid/solvers/boundary/boundary_solver.hpp>
#include <lagroid/solvers/step/optional_members.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

/// An arrow as its coordinates, with zeros after them; and back.
template <DiscreteSystem Sys>
ArrowOf<typename SizedSystemOf<Sys>::GroupoidType> by_sizes(const Sys& system,
                                                            const ArrowOf<typename Sys::GroupoidType>& g) {
  using Coordinates = ArrowOf<typename SizedSystemOf<Sys>::GroupoidType>;
  Coordinates out = Coordinates::Zero();
  AnySystemOf<Sys>::put_arrow(system, g, out.data());
  return out;
}
template <DiscreteSystem Sys>
ArrowOf<typename Sys::GroupoidType> of_system(const Sys& system,
                                              const ArrowOf<typename SizedSystemOf<Sys>::GroupoidType>& g) {
  return AnySystemOf<Sys>::arrow(system, g.data());
}

/// Paths, and solutions with their paths.
template <DiscreteSystem Sys> Path<SizedSystemOf<Sys>> by_sizes(const Sys& system, const Path<Sys>& path) {
  Path<SizedSystemOf<Sys>> out;
  out.reserve(path.size());
  for (const auto& step : path) out.push_back({by_sizes(system, step.arrow), step.multipliers});
  return out;
}
template <DiscreteSystem Sys> Path<Sys> of_system(const Sys& system, const Path<SizedSystemOf<Sys>>& path) {
  Path<Sys> out;
  out.reserve(path.size());
  for (const auto& step : path) out.push_back({of_system(system, step.arrow), step.multipliers});
  return out;
}
template <DiscreteSystem Sys>
BoundarySolution<SizedSystemOf<Sys>> by_sizes(const Sys& system, const BoundarySolution<Sys>& solution) {
  return {solution, by_sizes(system, solution.path)};
}
template <DiscreteSystem Sys>
BoundarySolution<Sys> of_system(const Sys& system, const BoundarySolution<SizedSystemOf<Sys>>& solution) {
  return {solution, of_system(system, solution.path)};
}

/// Problems and stages.
template <DiscreteSystem Sys> BoundaryProblem<SizedSystemOf<Sys>> by_sizes(const BoundaryProblem<Sys>& problem) {
  return {by_sizes(problem.system), by_sizes(problem.system, problem.boundary)};
}
template <DiscreteSystem Sys> BoundaryStage<SizedSystemOf<Sys>> by_sizes(const BoundaryStage<Sys>& stage) {
  return {by_sizes(stage.problem), stage.steps};
}

template <DiscreteSystem Sys>
std::vector<BoundaryStage<SizedSystemOf<Sys>>> by_sizes(const std::vector<BoundaryStage<Sys>>& stages) {
  std::vector<BoundaryStage<SizedSystemOf<Sys>>> out;
  out.reserve(stages.size());
  for (const auto& stage : stages) out.push_back(by_sizes(stage));
  return out;
}

/// A solver of sizes as one of a system.
template <DiscreteSystem Sys> class BoundarySolverBySizes final : public BoundarySolver<Sys> {
 public:
  using Sized = SizedSystemOf<Sys>;
  BoundarySolverBySizes(BoundaryOptions options, std::unique_ptr<const BoundarySolver<Sized>> solver)
      : BoundarySolver<Sys>(options, solver->stationary_kind()), solver_(std::move(solver)) {}

  const BoundarySolver<Sized>& sized() const { return *solver_; }

 private:
  BoundarySolution<Sys> solve_from(const BoundaryProblem<Sys>& problem, Path<Sys> path,
                                   bool keep_multipliers) const override {
    const Sys& system = problem.system;
    return of_system(system, solver_->solve_from(by_sizes(problem), by_sizes(system, path), keep_multipliers));
  }

  std::unique_ptr<const BoundarySolver<Sized>> solver_;
};

/// A solver of one system, a user's own, as one of sizes. It is to be given that system's problems only.
template <DiscreteSystem Sys> class BoundarySolverOfSystem final : public BoundarySolver<SizedSystemOf<Sys>> {
 public:
  using Sized = SizedSystemOf<Sys>;
  explicit BoundarySolverOfSystem(const BoundarySolver<Sys>& solver)
      : BoundarySolver<Sized>({}, solver.stationary_kind()), solver_(&solver) {}

 private:
  BoundarySolution<Sized> solve_from(const BoundaryProblem<Sized>& problem, Path<Sized> path,
                                     bool keep_multipliers) const override {
    const Sys& system = static_cast<const AnySystemOf<Sys>&>(problem.system.asked()).system();
    return by_sizes(system, solver_->solve({system, of_system(system, problem.boundary)}, of_system(system, path),
                                           keep_multipliers));
  }

  const BoundarySolver<Sys>* solver_;
};

/// Any solver of a system, as algorithms of sizes want it.
template <DiscreteSystem Sys> class SizedBoundarySolver {
 public:
  using Sized = SizedSystemOf<Sys>;
  explicit SizedBoundarySolver(const BoundarySolver<Sys>& solver) : own_(solver) {
    const auto* by_sizes = dynamic_cast<const BoundarySolverBySizes<Sys>*>(&solver);
    solver_ = by_sizes ? &by_sizes->sized() : &own_;
  }
  SizedBoundarySolver(const SizedBoundarySolver&) = delete;
  SizedBoundarySolver& operator=(const SizedBoundarySolver&) = delete;

  const BoundarySolver<Sized>& operator*() const { return *solver_; }

 private:
  BoundarySolverOfSystem<Sys> own_;
  const BoundarySolver<Sized>* solver_;
};

namespace detail {

/// All solvers of sizes: complete where `boundary_methods.hpp` is included.
template <DiscreteSystem Sized> struct BoundarySolvers;
/// Whether the library has them compiled (boundary_sizes.hpp).
template <class Sized> inline constexpr bool boundary_sizes_compiled = false;

/// `make_boundary_solver` of sizes.
template <DiscreteSystem Sized>
std::unique_ptr<BoundarySolver<Sized>> make_sized_boundary_solver(BoundaryMethod method, BoundaryOptions options,
                                                                  StationaryKind kind);

}  // namespace detail

template <DiscreteSystem Sys>
std::unique_ptr<BoundarySolver<Sys>> make_boundary_solver(BoundaryMethod method, BoundaryOptions options,
                                                          StationaryKind kind) {
  using Sized = SizedSystemOf<Sys>;
  constexpr bool available = detail::boundary_sizes_compiled<Sized> || requires {
    sizeof(detail::BoundarySolvers<Sized>);
  };
  static_assert(
      available,
      "include <lagroid/solvers/boundary/boundary_methods.hpp>: the library has compiled no boundary values for a "
      "system of these sizes");
  static_assert(path_fits<Sys>,
                "path is there but does not fit: a const function path(boundary, steps) that returns a std::vector of "
                "arrows (see HasPath)");
  require_optional_members_to_fit<Sys>();
  if constexpr (available)
    return std::make_unique<BoundarySolverBySizes<Sys>>(
        options, detail::make_sized_boundary_solver<Sized>(method, options, kind));
}

}  // namespace lagroid
