// Derivatives of discrete flows against those of 256-bit arithmetic (tests/data/gradients.json).

#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace lagroid::sensitivity_reference_tests {
namespace {

using Json = nlohmann::json;

double number(const Json& text) { return std::stod(text.get<std::string>()); }
Eigen::MatrixXd matrix(const Json& rows) {
  Eigen::MatrixXd out(Eigen::Index(rows.size()), Eigen::Index(rows[0].size()));
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < out.cols(); ++j) out(i, j) = number(rows[std::size_t(i)][std::size_t(j)]);
  return out;
}
Json reference(const std::string& id) {
  const Json all = Json::parse(std::ifstream(LAGROID_TEST_DATA "/gradients.json"));
  for (const Json& each : all["cases"])
    if (each["id"] == id) return each;
  throw std::out_of_range(id);
}

/// Relative to the largest entry.
double defect(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected) {
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}
constexpr double tolerance = 1e-12;

/// Both parts of the result, start and parameters side by side; and the same once more, taken backwards.
template <class Sys>
std::vector<Eigen::MatrixXd> both_ways(const Sys& system, const State<typename Sys::GroupoidType>& start, long steps,
                                       const std::vector<std::string>& parameters) {
  const Sensitivities forward = sensitivities(system, start, {.steps = steps, .parameters = parameters});
  const auto state = [](const auto& node) {
    VariedVector out(node.object.size() + node.momentum.size());
    out << node.object, node.momentum;
    return out;
  };
  const RunGradient backward = gradient(system, start, state, {.steps = steps, .parameters = parameters});
  EXPECT_TRUE(forward.converged() && backward.converged());
  Eigen::MatrixXd one(forward.by_start.rows(), forward.by_start.cols() + forward.by_parameters.cols());
  one << forward.by_start, forward.by_parameters;
  Eigen::MatrixXd other(backward.by_start.rows(), one.cols());
  other << backward.by_start, backward.by_parameters;
  return {one, other};
}

TEST(GradientReference, Pendulum) {
  const Json expected = reference("C-pendulum");
  for (const Json& each : expected["discrete"]) {
    Pendulum pendulum;
    pendulum.gravity = 9.81;
    pendulum.h = number(each["h"]);
    for (const auto& found : both_ways(pendulum, {Vector<double, 1>(1.0), Vector<double, 1>(0.5)}, each["N"],
                                       {"mass", "length", "gravity"}))
      EXPECT_LE(defect(found, matrix(each["jacobian"])), tolerance);
  }
}

/// The planar Kepler problem of a body whose mass is a parameter.
struct HeavyBody : MechanicalSystem<HeavyBody, 2> {
  double body_mass = 1;
  double strength = 1;

  HeavyBody() { quadrature = Quadrature::trapezoid; }
  static auto parameters() {
    return std::tuple(parameter("mass", &HeavyBody::body_mass, "kg", "of the body", positive),
                      parameter("strength", &HeavyBody::strength, "N m^2", "of the attraction"));
  }
  template <class S = double> ParameterScalar<S> mass() const { return varied<S>(body_mass); }
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    return -varied<S>(strength) / sqrt(q.squaredNorm());
  }
};

TEST(GradientReference, Kepler) {
  const Json expected = reference("C-kepler");
  for (const Json& each : expected["discrete"]) {
    HeavyBody body;
    body.h = number(each["h"]);
    for (const auto& found : both_ways(body, {{0.7, 0}, {0, 1.3}}, each["N"], {"mass", "strength"}))
      EXPECT_LE(defect(found, matrix(each["jacobian"])), tolerance);
    Kepler kepler;
    kepler.h = body.h;
    for (const auto& found : both_ways(kepler, {{0.7, 0}, {0, 1.3}}, each["N"], {"strength"})) {
      Eigen::MatrixXd without_mass(4, 5);
      without_mass << matrix(each["jacobian"]).leftCols(4), matrix(each["jacobian"]).rightCols(1);
      EXPECT_LE(defect(found, without_mass), tolerance);
    }
  }
}

TEST(GradientReference, RigidBody) {
  const Json expected = reference("C-rigidbody");
  for (const Json& each : expected["discrete"]) {
    RigidBody body;
    body.h = number(each["h"]);
    body.rotation = each["retraction"] == "cayley" ? RotationMap::cayley : RotationMap::exponential;
    const Sensitivities found =
        sensitivities(body, {{}, {0.8, 0.6, 1.1}}, {.steps = each["N"], .parameters = {"inertia"}});
    ASSERT_TRUE(found.converged());
    Eigen::MatrixXd attitude(3, 6);
    attitude << found.by_start.topRightCorner(3, 3), found.by_parameters.topRows(3);
    Eigen::MatrixXd momentum(3, 6);
    momentum << found.by_start.bottomRightCorner(3, 3), found.by_parameters.bottomRows(3);
    EXPECT_LE(defect(attitude, matrix(each["jacobian_R_body"])), tolerance) << each["retraction"];
    EXPECT_LE(defect(momentum, matrix(each["jacobian_M"])), tolerance) << each["retraction"];
  }
}

}  // namespace
}  // namespace lagroid::sensitivity_reference_tests
