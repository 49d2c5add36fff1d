// Three equal masses in the plane chase each other along one figure eight (Chenciner and Montgomery 2000; numbers by
// Simo): a system of one's own, its run and its ledger. docs/site/motion.py draws the front page's picture from it.
//
// Run it: build/release/bin/figure_eight [FOLDER]
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run.hpp>

#include <cmath>
#include <iostream>
#include <vector>

using namespace lagroid;

// L = |x'|^2 / 2 + sum 1 / |x_i - x_j|, by the trapezoidal rule: on arrows (x, x') of the pair groupoid of R^6.
struct ThreeBodies : System<ThreeBodies, Pair<6>> {
  double h = 0.005;

  template <class S> S potential(const Vector<S, 6>& x) const {
    using std::sqrt;
    S sum(0.0);
    for (int i = 2; i < 6; i += 2)
      for (int j = 0; j < i; j += 2) {
        const S east = x(i) - x(j), north = x(i + 1) - x(j + 1);
        sum -= S(1.0) / sqrt(east * east + north * north);
      }
    return sum;
  }
  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    return (g.target - g.source).squaredNorm() * 0.5 / step - (potential(g.source) + potential(g.target)) * 0.5 * step;
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  // What leaves L alone: moving all to the east, and turning all round the origin.
  using X = Vector<double, 6>;
  static X east(const X&) { return X{{1, 0, 1, 0, 1, 0}}; }
  static X round(const X& x) { return X{{-x(1), x(0), -x(3), x(2), -x(5), x(4)}}; }
  std::vector<Symmetry<ThreeBodies>> symmetries() const {
    return {{"momentum to the east", east}, {"angular momentum", round}};
  }
};

int main(int argc, char** argv) {
  const Vector<double, 6> at{{0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0}};
  const Vector<double, 6> momentum{{0.466203685, 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146}};
  const RunResult eight =
      run(ThreeBodies{}, {at, momentum}, {.steps = 1265, .name = "Three bodies", .folder = argc > 1 ? argv[1] : ""});
  std::cout << text_report(eight);
  return eight.converged() ? 0 : 1;
}
