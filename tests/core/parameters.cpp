// Parameters that are declared once, and scenes of systems that say nothing else of scenes.

#include <scenes/any_system.hpp>

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace lagroid;
using namespace lagroid::app;

namespace core_parameters_tests {
namespace {

enum class Law { hooke, quartic };
constexpr std::array<std::string_view, 2> law_words{"hooke", "quartic"};

/// A mass on a spring in the plane, its parameters of any scalar.
template <class P> struct SpringOf : System<SpringOf<P>, Pair<2>> {
  double h = 0.05;
  P stiffness{4};
  Vector<double, 2> anchor{0.5, 0};
  Vector<double, 2> axis{1, 0};
  Law law = Law::hooke;

  static auto parameters() {
    return std::tuple(required(parameter("stiffness", &SpringOf::stiffness, "N/m", "of the spring", positive)),
                      parameter("anchor", &SpringOf::anchor, "m", "where it is fixed"),
                      direction("axis", &SpringOf::axis, "the axis along which it pulls"),
                      choice("law", &SpringOf::law, law_words, "of the force"));
  }
  std::optional<Refusal> refused() const {
    if (anchor.norm() > 100) return Refusal{{"anchor"}, "is too far away"};
    return std::nullopt;
  }

  template <class S, class T> S lagrangian(const PairArrow<S, 2>& g, const T& step) const {
    const Vector<S, 2> v = g.target - g.source;
    const Vector<S, 2> q = (g.target + g.source) * 0.5 - anchor.template cast<S>();
    const S square = q.squaredNorm();
    return v.squaredNorm() * (0.5 / step) -
           (law == Law::hooke ? square * (0.5 * stiffness) : square * square * (0.25 * stiffness)) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
};
using Spring = SpringOf<double>;

Section scene(const std::string& parameters, const std::string& rest = "") {
  return parse_scene("system = \"spring\"\n[parameters]\n" + parameters +
                         "\n[initial]\nposition = [1, 0]\nmomentum = [0, 1]\n[time]\nstep = 0.1\nsteps = 5\n" + rest,
                     "spring.toml", {});
}

/// The family of systems has read which one it is.
Section named(const Section& of) {
  EXPECT_EQ(of.choice("system", {"spring"}), "spring");
  return of;
}

/// The message of the SceneError.
template <class F> std::string refusal(const F& read) {
  try {
    read();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(Parameters, AreReadAsTheyAreDeclared) {
  const auto system = read_parameters<Spring>(scene("stiffness = 9\naxis = [0, 3]\nlaw = \"quartic\""));
  EXPECT_EQ(system.stiffness, 9);
  EXPECT_EQ(system.anchor(0), 0.5) << "as the constructor has it";
  EXPECT_EQ(system.axis(1), 1) << "a direction has unit length";
  EXPECT_EQ(system.law, Law::quartic);
}

TEST(Parameters, AreRefusedByNameAndRule) {
  const auto of = [](const std::string& parameters) {
    return refusal([&] { read_parameters<Spring>(scene(parameters)); });
  };
  EXPECT_NE(of("").find("stiffness"), std::string::npos) << of("");
  EXPECT_NE(of("stiffness = -1").find("parameters.stiffness: must be positive, got -1"), std::string::npos)
      << of("stiffness = -1");
  EXPECT_NE(of("stiffness = 1\nanchor = [1]").find("parameters.anchor"), std::string::npos);
  EXPECT_NE(of("stiffness = 1\naxis = [0, 0]").find("is no direction"), std::string::npos);
  EXPECT_NE(of("stiffness = 1\nlaw = \"cubic\"").find("hooke"), std::string::npos);
  EXPECT_NE(of("stiffness = 1\nanchor = [1000, 0]").find("parameters.anchor: is too far away"), std::string::npos);
}

TEST(Parameters, AreListedWithWhatTheConstructorMakesOfThem) {
  const auto keys = parameter_keys<Spring>();
  ASSERT_EQ(keys.size(), 4u);
  EXPECT_TRUE(keys[0].required());
  EXPECT_EQ(fallback_of(keys[1]), "0.5, 0");
  EXPECT_EQ(fallback_of(keys[3]), "hooke");
  EXPECT_EQ(meaning_of(keys[3]), "of the force: hooke or quartic");
  EXPECT_EQ(parameter_keys<Pendulum>().size(), 4u);
}

TEST(AnySystem, DeclaresTheKeysOfItsTables) {
  const SystemKeys keys = any_module<Spring>("spring", "a mass on a spring").keys();
  ASSERT_EQ(keys.initial.size(), 2u);
  EXPECT_EQ(keys.initial[0].name, "position");
  EXPECT_EQ(std::get<NumberArray>(keys.initial[1].value.is).size, 2u);
  ASSERT_EQ(keys.end.size(), 1u);
  EXPECT_EQ(keys.end[0].name, "position");
}

/// Derivatives by parameters take the same declaration.
TEST(Parameters, CarryAnyScalar) {
  using Seeded = SpringOf<Dual<double>>;
  int found = 0;
  for_each_parameter<Seeded>([&](const auto& p) {
    if constexpr (requires(Seeded & s) { (s.*p.member).derivative; }) {
      Seeded system;
      (system.*p.member).derivative = 1;
      EXPECT_EQ(p.name, "stiffness");
      EXPECT_EQ(system.stiffness.derivative, 1);
      ++found;
    }
  });
  EXPECT_EQ(found, 1);
}

TEST(AnySystem, IsReadFromItsParametersAndItsGroupoid) {
  const auto module = any_module<Spring>("spring", "a mass on a spring");
  const RunResult result = module.run(named(scene("stiffness = 4")), {.record = true});
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_EQ(result.steps, 5);
  EXPECT_EQ(result.system, "spring");
  const auto unknown = refusal([&] { module.run(named(scene("stiffness = 4\ncolour = 3")), {}); });
  EXPECT_NE(unknown.find("parameters.colour"), std::string::npos) << unknown;
  EXPECT_FALSE(module.read(named(scene("stiffness = 4")), {}).methods.empty());
  EXPECT_EQ(module.listed().groupoid, "Pair<2>");
}

TEST(AnySystem, HasBoundaryValues) {
  const auto module = any_module<Spring>("spring", "a mass on a spring");
  const Section ends = parse_scene(
      "system = \"spring\"\n[parameters]\nstiffness = 4\n[boundary]\nstart = { position = [1, 0] }\nend = { position = "
      "[0, 1] }\n[time]\nduration = 1\nsteps = 20\n",
      "ends.toml", {});
  const RunResult result = module.run(named(ends), {});
  EXPECT_TRUE(result.converged()) << result.message;
  EXPECT_EQ(result.stationary_paths.size(), 1u) << "of a quadratic action";
  EXPECT_THROW(module.read(named(ends), {}), SceneError) << "no initial value";
}

/// Factors of one kind are told apart by number.
TEST(AnySystem, SpeaksOfProducts) {
  using G = Product<SO2, SO3, SO2>;
  EXPECT_EQ(ArrowFormat<G>::keys(), (std::vector<std::string>{"angle1", "attitude", "angle2"}));
  const ArrowFormat<G> spoken{G()};
  const Section initial = parse_scene("angle2 = 0.25\nattitude = [0, 0, 1, 0]\n", "arrow.toml", {});
  const auto arrow = spoken.read(initial, "");
  const auto angles = spoken.coordinates(arrow, ObjectOf<G>());
  ASSERT_EQ(angles.size(), 2u);
  EXPECT_NEAR(angles[0], 0, 1e-16);
  EXPECT_NEAR(angles[1], 0.25, 1e-15);
  EXPECT_NEAR((*spoken.attitude(arrow))[2], 1, 1e-15);
  EXPECT_EQ(spoken.labels(""), (std::vector<std::string>{"angle1", "angle2"}));
}

}  // namespace
}  // namespace core_parameters_tests
