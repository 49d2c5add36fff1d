#include <lagroid/systems/multibody/control/ipopt/scene_chart.hpp>

#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/systems/multibody/control/arrow_momenta.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace lagroid::multibody {

SceneChart::SceneChart(ControlledScene& scene, ScenePath origin)
    : scene_(scene), origin_(std::move(origin)), here_(scene, origin_, SceneTranscription::Coordinates::straight) {}

void SceneChart::stand_at(const TrajectoryDisplacement& x) {
  here_.stand_at(origin_);
  here_.try_displacement(x, 1);
  here_.accept();
}

/// The identity, but for the blocks of rotations: tau(v)^{-1} tau(v + e).
void SceneChart::retraction(long, const double* v, Retraction out) const {
  using J = SecondJet<double, 3>;
  const int n = 2 * scene_.n();
  std::fill(out.first, out.first + n * n, 0.0);
  std::fill(out.second, out.second + n * n * n, 0.0);
  for (int i = 0; i < n; ++i) out.first[i * n + i] = 1;
  for (int f = scene_.linear(); f < scene_.factors(); ++f) {
    const int at = 3 * f;
    Vector<double, 3> here;
    Vector<J, 3> near;
    for (int i = 0; i < 3; ++i) {
      here(i) = v[at + i];
      near(i) = J::variable(v[at + i], i);
    }
    const Mat back = SO3::inverse(turn_of(scene_.rotation(), here));
    const Matrix<J, 3, 3> between = back.cast<J>() * turn_of(scene_.rotation(), near);
    const Vector<J, 3> a = coordinates_of(scene_.rotation(), between);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        out.first[(at + i) * n + at + j] = a(i).gradient(j);
        for (int l = 0; l < 3; ++l) out.second[((at + i) * n + at + j) * n + at + l] = a(i).hessian(j, l);
      }
  }
}

TrajectoryChart::Range SceneChart::control_range(long stage, int control) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (control >= scene_.actuators()) return {-none, none};  // reactions of joints
  const Actuator& each = scene_.task().actuators[std::size_t(control)];
  const double u = origin_.controls[stage][control];
  return {each.lower - u, each.upper - u};
}

SceneSolution solve_scene_by_ipopt(ControlledScene& scene, ScenePath start, const ControlOptions& options) {
  SceneChart chart(scene, std::move(start));
  IpoptSolution found = solve_by_ipopt(chart, options);
  SceneSolution out;
  out.path = chart.path();
  out.costates = std::move(found.costates);
  out.inequality_multipliers = std::move(found.inequality_multipliers);
  out.report = std::move(found.report);
  refuse_wide_steps(scene, out);
  return out;
}

}  // namespace lagroid::multibody
