// Turned by going round: a free body's angular momentum, seen from the body, goes round an axis and comes back after a
// time T. By then the body has turned about its momentum by 2 E T / |mu|, the dynamic part, and by minus the solid
// angle that the momentum went round, the geometric one (Montgomery, American Journal of Physics 59, 1991). Three times
// round; the curves of the last panel meet where the path closes.
//
// Run it: build/release/bin/geometric_phase [FOLDER]
#include <lagroid/core/reduction/phase.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/run/run.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>

using namespace lagroid;

namespace {

// The momentum is fixed in space, so that the body alone tells where it points: a system on pairs of directions.
using Level = MomentumLevel<ShortestRotation, HeavyTop>;

// The period of a free body whose momentum goes round the axis of its largest moment, the third (Landau and Lifshitz,
// Mechanics, section 37).
double period(const Vector<double, 3>& inertia, double momentum, double energy) {
  const double of_first = momentum * momentum - 2 * energy * inertia(0);
  const double of_third = 2 * energy * inertia(2) - momentum * momentum;
  const double modulus = std::sqrt((inertia(1) - inertia(0)) * of_third / ((inertia(2) - inertia(1)) * of_first));
  return 4 * std::comp_ellint_1(modulus) * std::sqrt(inertia.prod() / ((inertia(2) - inertia(1)) * of_first));
}

// The solid angle of the triangle of a, b and the third axis.
double triangle(const Vector<double, 3>& a, const Vector<double, 3>& b) {
  return 2 * std::atan2(a(0) * b(1) - a(1) * b(0), 1 + a(2) + b(2) + a.dot(b));
}

// What is recorded beside the direction of the momentum: the phases, and the solid angle.
struct Phases {
  explicit Phases(const Level& level) : tally(level, HorizontalArrows::of_the_connection) {}

  void add(const ArrowOf<Level::GroupoidType>& b) {
    tally.add(b);
    swept += triangle(b.source, b.target);
  }

  PhaseTally<Level> tally;
  double swept = 0;
};

Presentation<Level> presentation_of(const Level& level, const std::shared_ptr<Phases>& phases) {
  auto p = plain_presentation<Level>(level, "Free body", {});
  p.extras.push_back(
      {{"phases", {"turned", "dynamic", "geometric", "- solid angle"}, "rad", "about the momentum", false, {}},
       [phases](const TrajectoryPoint<Level>& point, double* out) {
         if (point.index > 0) phases->add(point.step.arrow);
         out[0] = phases->tally.total()(0);
         out[1] = phases->tally.dynamic()(0);
         out[2] = phases->tally.geometric()(0);
         out[3] = -phases->swept;
       }});
  p.panels = {{"the momentum's path, seen from the body", "second axis", "first axis", "q2", {"q1"}, true},
              {"turn about the momentum", "t", "rad", "t", {"turned", "dynamic", "geometric"}},
              {"what going round has turned it by", "t", "rad", "t", {"geometric", "- solid angle"}}};
  return p;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int once_round = 400;  // steps
  HeavyTop body;
  body.inertia = {1, 1.5, 2.2};
  body.weight.setZero();
  const Vector<double, 3> direction(0.5, 0, std::sqrt(0.75));
  const State<HeavyTop::GroupoidType> start{direction, 1.7 * direction};
  const double momentum = start.momentum.norm();
  const double round = period(body.inertia, momentum, body.energy(start));
  body.h = round / once_round;

  const Level level({}, body, Vector<double, 1>(momentum));
  const auto phases = std::make_shared<Phases>(level);
  const RunResult result = run(level, level.state_below(start),
                               {.steps = 3 * once_round,
                                .name = "Free body",
                                .folder = argc > 1 ? argv[1] : "",
                                .presentation = presentation_of(level, phases)});
  if (!result.converged()) return 1;
  const double dynamic = phases->tally.dynamic()(0) / 3;
  const double geometric = phases->tally.geometric()(0) / 3;
  fmt::print("turned in {:.4f} s, once round: {:.4f} rad\n", round, dynamic + geometric);
  fmt::print("dynamic   {:.4f}, by the formula {:.4f}\n", dynamic, 2 * body.energy(start) * round / momentum);
  fmt::print("geometric {:.4f}, minus the solid angle {:.4f}\n", geometric, -phases->swept / 3);
  return std::abs(geometric + phases->swept / 3) < 1e-3 ? 0 : 1;
}
