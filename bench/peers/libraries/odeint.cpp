// Boost.odeint. Its documentation (Steppers: Stepper overview) calls runge_kutta4 the good general scheme
// without error control, runge_kutta_dopri5 and runge_kutta_fehlberg78 those to put under error control by
// make_controlled, bulirsch_stoer very good where high precision is required, and the symplectic ones those for
// separable Hamiltonian systems. States are std::array, for which it has an algebra of its own.
#include "libraries.hpp"

#include <boost/numeric/odeint.hpp>

#include <memory>
#include <utility>

namespace peers {

namespace {

namespace odeint = boost::numeric::odeint;

/// The right-hand side as odeint calls it.
template <class P> struct RightHandSide {
  P problem;
  template <class State> void operator()(const State& y, State& dy, double) const { problem(y, dy); }
};

/// Steps of `do_step`, all of one length.
template <class P, class MakeStep>
Method equal_steps(const P& problem, std::string name, double order, double coarsest, const MakeStep& make_step) {
  return {"odeint", std::move(name), false, coarsest, ladder(order), [=](double end, double setting) -> Task {
            return [=] {
              const long steps = std::lround(end / setting);
              const double h = end / double(steps);
              auto step = make_step();
              auto y = problem.start();
              Watch<P> watch(problem);
              for (long i = 0; i < steps; ++i) {
                step(y, double(i) * h, h);
                watch.step([&] { return problem.coordinates(y); });
              }
              return watch.finish(problem.coordinates(y));
            };
          }};
}

/// Under error control; the tolerance is both absolute and relative.
template <class P, class MakeStepper>
Method controlled(const P& problem, std::string name, const MakeStepper& make_stepper) {
  return {"odeint", std::move(name), true, 1e-2, std::sqrt(10.0), [=](double end, double tolerance) -> Task {
            return [=] {
              auto y = problem.start();
              Watch<P> watch(problem);
              bool begun = false;
              odeint::integrate_adaptive(make_stepper(tolerance), RightHandSide<P>{problem}, y, 0.0, end,
                                         0.01 * problem.unit(), [&](const auto& at, double) {
                                           if (begun) watch.step([&] { return problem.coordinates(at); });
                                           begun = true;  // the first call is for the start
                                         });
              return watch.finish(problem.coordinates(y));
            };
          }};
}

/// p' = force(q), q' = p.
template <class P> Method symplectic(const P& problem) {
  static constexpr std::size_t half = P::unknowns / 2;
  using Half = std::array<double, half>;
  return equal_steps(problem, "McLachlan SB3A RKN 4", 4, problem.unit(), [=] {
    return [stepper = odeint::symplectic_rkn_sb3a_mclachlan<Half>(), problem](auto& y, double t, double h) mutable {
      std::pair<Half, Half> z;
      for (std::size_t i = 0; i < half; ++i) {
        z.first[i] = y[i];
        z.second[i] = y[i + half];
      }
      stepper.do_step([&](const Half& q, Half& force) { force = problem.force(q); }, z, t, h);
      for (std::size_t i = 0; i < half; ++i) {
        y[i] = z.first[i];
        y[i + half] = z.second[i];
      }
    };
  });
}

}  // namespace

template <class P> Methods odeint_methods(const P& problem) {
  using State = std::array<double, P::unknowns>;
  Methods out{
      equal_steps(problem, "RK4", 4, problem.unit(),
                  [=] {
                    return [stepper = odeint::runge_kutta4<State>(), problem](State& y, double t, double h) mutable {
                      stepper.do_step(RightHandSide<P>{problem}, y, t, h);
                    };
                  }),
      controlled(problem, "Dormand-Prince 5",
                 [](double tolerance) {
                   return odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
                 }),
  };
  Methods beyond{
      controlled(problem, "Fehlberg 78",
                 [](double tolerance) {
                   return odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<State>());
                 }),
      equal_steps(problem, "Fehlberg 78, equal steps", 8, 2 * problem.unit(),
                  [=] {
                    return [stepper = odeint::runge_kutta_fehlberg78<State>(), problem](State& y, double t,
                                                                                        double h) mutable {
                      stepper.do_step(RightHandSide<P>{problem}, y, t, h);
                    };
                  }),
      controlled(problem, "Bulirsch-Stoer",
                 [](double tolerance) { return odeint::bulirsch_stoer<State>(tolerance, tolerance); }),
  };
  if constexpr (requires(std::array<double, P::unknowns / 2> q) { problem.force(q); })
    beyond.push_back(symplectic(problem));
  for (Method& method : beyond) method.beyond = true;
  add(out, std::move(beyond));
  return out;
}

template Methods odeint_methods(const RigidBodyProblem&);
template Methods odeint_methods(const KeplerProblem&);
template Methods odeint_methods(const PendulumProblem&);
template Methods odeint_methods(const SphericalPendulumProblem&);
template Methods odeint_methods(const TopProblem&);
template Methods odeint_methods(const ChainProblem&);

std::string odeint_version() {
  return "Boost " + std::to_string(BOOST_VERSION / 100000) + "." + std::to_string(BOOST_VERSION / 100 % 1000);
}

}  // namespace peers
