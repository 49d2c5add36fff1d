#include "constrained_maps.hpp"

#include <lagroid/solvers/generating/chord_lagrangian.hpp>
#include <lagroid/solvers/generating/exact_generating_function.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace lagroid::app {

namespace {

/// Unit mass, length and gravity, e3 upwards.
struct Sphere {
  static constexpr int dimension = 3;
  static constexpr int constraints = 1;
  static constexpr const char* name = "spherical pendulum";
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.squaredNorm() * 0.5 + q(2);
  }
  template <class S> S lagrangian(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return v.squaredNorm() * 0.5 - q(2);
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};

struct Swing {
  static constexpr int dimension = 1;
  static constexpr int constraints = 0;
  static constexpr const char* name = "planar pendulum";
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::cos;
    return p(0) * p(0) * 0.5 - cos(q(0));
  }
};

/// The end of a motion by that many steps; not a number from a step on that failed.
template <class Map, class Move>
typename Map::Point integrate(const Map& map, const Move& move, typename Map::Point point, double end, int steps,
                              std::string& status) {
  for (int k = 0; k < steps; ++k)
    if (const SolveStatus found = move(map, point, end / steps); found != SolveStatus::converged) {
      status = to_string(found);
      point.q.setConstant(std::numeric_limits<double>::quiet_NaN());
      point.p.setConstant(std::numeric_limits<double>::quiet_NaN());
      break;
    }
  return point;
}

/// Measures the methods of one problem.
template <class M> class Study {
 public:
  using Point = Phase<M::dimension, M::constraints>;

  Study(const Point& start, double end, int coarsest, int refinements)
      : start_(start),
        end_(end),
        coarsest_(coarsest),
        refinements_(refinements),
        exact_(exact_arc(M{}, start.q, start.p, end)) {}

  template <class Map, class Move> MapMethod measure(std::string name, const Map& map, const Move& move) const {
    MapMethod out{M::name, std::move(name), {}};
    for (int k = 0, steps = coarsest_; k < refinements_; ++k, steps *= 2) {
      const Point end = integrate(map, move, start_, end_, steps, out.status);
      const auto tangent = project_momentum(M{}, end.q, end.p);
      out.errors.push_back(
          {steps, (end.q - exact_.q1).norm(), (end.p - exact_.p1).norm(), (tangent - exact_.p1).norm()});
    }
    return out;
  }
  template <class F> MapMethod measure(std::string name, const F& function) const {
    return measure(std::move(name), HamiltonianMap(function),
                   [](const auto& map, auto& point, double h) { return map.step(point, h); });
  }
  template <class Map> MapMethod composed(std::string name, const Map& map, const Composition& composition) const {
    return measure(std::move(name), map,
                   [&](const auto& each, auto& point, double h) { return composed_step(each, point, h, composition); });
  }

 private:
  Point start_;
  double end_;
  int coarsest_;
  int refinements_;
  decltype(exact_arc(M{}, Vector<double, M::dimension>(), Vector<double, M::dimension>(), 1.0)) exact_;
};

}  // namespace

std::vector<MapMethod> run_map_study(int coarsest, int refinements, const std::function<void(long, long)>& report) {
  using namespace quadrature_rules;
  constexpr double theta = 1;  // from e3
  const Phase<3, 1> above{{std::sin(theta), 0, std::cos(theta)}, {0.5 * std::cos(theta), 0.7, -0.5 * std::sin(theta)}};
  const Study<Sphere> sphere(above, 2, coarsest, refinements);
  const Study<Swing> swing({Vector<double, 1>(0.4), Vector<double, 1>(0.9)}, 8, coarsest, refinements);
  const TaylorHamiltonian<Sphere, 0> euler{};
  const HamiltonianMap rattle(ChordLagrangian<Sphere>{});
  const std::vector<std::function<MapMethod()>> all{
      [&] { return sphere.measure("type II r = 0", euler); },
      [&] { return sphere.measure("type III r = 0", adjoint_of(euler)); },
      [&] { return sphere.measure("type I trapezoid (RATTLE)", rattle.function()); },
      [&] { return sphere.measure("type II r = 1 trapezoid", TaylorHamiltonian<Sphere, 1>{}); },
      [&] {
        return sphere.measure("type II r = 2 Gauss", TaylorHamiltonian<Sphere, 2>{{}, gauss_2});
      },
      [&] {
        return sphere.measure("type II r = 3 Gauss", TaylorHamiltonian<Sphere, 3>{{}, gauss_2});
      },
      [&] { return sphere.composed("RATTLE triple jump", rattle, compositions::triple_jump); },
      [&] { return sphere.composed("RATTLE Suzuki", rattle, compositions::suzuki); },
      [&] { return sphere.composed("types II and III r = 0 Suzuki", SymmetrisedMap(euler), compositions::suzuki); },
      [&] {
        return swing.measure("type II r = 0", TaylorHamiltonian<Swing, 0>{{}, gauss_3});
      },
      [&] {
        return swing.measure("type II r = 1", TaylorHamiltonian<Swing, 1>{{}, gauss_3});
      },
      [&] {
        return swing.measure("type II r = 2", TaylorHamiltonian<Swing, 2>{{}, gauss_3});
      },
      [&] {
        return swing.measure("type II r = 3", TaylorHamiltonian<Swing, 3>{{}, gauss_3});
      },
      [&] {
        return swing.measure("type II r = 4", TaylorHamiltonian<Swing, 4>{{}, gauss_3});
      },
      [&] {
        return swing.measure("type II r = 4 trapezoid", TaylorHamiltonian<Swing, 4>{{}, trapezoid});
      }};
  std::vector<MapMethod> out;
  for (const auto& each : all) {
    out.push_back(each());
    report(long(out.size()), long(all.size()));
  }
  return out;
}

double map_order(const MapMethod& method, const std::function<double(const MapErrors&)>& error) {
  constexpr double round_off = 1e-11;
  double order = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 1; k < method.errors.size(); ++k)
    if (error(method.errors[k]) > round_off) order = std::log2(error(method.errors[k - 1]) / error(method.errors[k]));
  return order;
}

}  // namespace lagroid::app
