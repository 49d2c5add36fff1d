#pragma once
/// The motion of a scene of bodies, joints and effects, one variational step after another:
///
///     L(q, g) = sum_b K_b(g_b) - h (U(q) + U(q g)) / 2,    C(q) = 0 for joints (of point masses this is RATTLE).
///
/// What joints tie together is solved together, for the multipliers alone, in time linear in the bodies of chains and
/// trees; bodies that nothing ties move one by one.
///
///     Scene scene;
///     const Body bob = scene.point_mass(1, {1, 0, 0}, {0, 0, 0});  // mass, place, velocity
///     scene.add(Rod{{scene.ground({0, 0, 0}), bob.centre}, 1});  // joints.hpp
///     Multibody motion(std::move(scene), 0.01);  // h
///     const StepReport report = motion.advance();
///
/// Requires a finite step and a scene whose joints hold at its start. The constructor throws std::invalid_argument for
/// joints whose gradient is not finite or vanishes in round-off, and for control or composition that the scene does not
/// admit; std::domain_error where one island mixes vakonomic joints with others, dampers or drag that do not go with
/// them. A step that does not converge changes nothing, and its report has the status.

#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/step/step_solver.hpp>
#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/scene.hpp>
#include <lagroid/systems/multibody/solver/workspace.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <cstddef>
#include <vector>

namespace lagroid::multibody {

struct Options {
  int max_iterations = 60;
  double tolerance = 0;  ///< 0: to round-off; else residuals this small, relative to their terms, are accepted
  /// Steps in proportion to |U|^(-3/2), U the energy of attractions by inverse squares; h is then the first of them
  /// (StepController). Of a scene with such effects alone, and no joints.
  bool controlled = false;
  /// Of a step, from steps of order 2 of its shares of h: of a scene whose step can be taken back (no damping, no
  /// constraints of velocities).
  Composition composition = compositions::single;
};

/// Integrates the discrete Lagrangian of a scene,
///     L(q, g) = sum_b K_b(g_b) - h (U(q) + U(q g)) / 2,   K = m |dx|^2 / (2 h) or h l(tau^{-1}(g) / h), l(w) = w.I w /
///     2,
/// on the product of its bodies' groupoids, with the object constraints C(q) = 0 of its joints: with multipliers on the
/// objects, RATTLE for point masses, of order 2, symmetric and (without damping) symplectic. A potential touches the
/// momenta at the nodes only, so that no term couples the arrows of two bodies: what is solved together is what joints
/// tie together (an island), for the multipliers alone, by elimination along the graph of the joints.
///
/// Damping c of a velocity is a pair of discrete forces -c xi / 2 at both ends of the arrow. Rows of `Vakonomic` joints
/// stand in the Lagrangian, L + <lambda, phi>: momenta then hold the multipliers, mu = F-(g, lambda).
class Multibody {
 public:
  /// The scene at its first node. Rows of joints that depend on others there are left out (`dependent_rows`), and
  /// joints that touch nothing that moves. Throws std::invalid_argument where a gradient is not finite or so small that
  /// its square is no normal number, and where steps are to be controlled or composed and the scene does not allow
  /// that; std::domain_error where one island obeys two principles.
  Multibody(Scene scene, double h, const Options& options = {});

  /// One step. Where it does not converge nothing changes, and the report has the status.
  StepReport advance();
  /// One step of another size, positive and not above the usual one, whatever controls these. Steps go on from a state
  /// that is restored.
  StepReport advance_by(double size);

  const SceneState& state() const { return state_; }
  /// What the scene is while it moves.
  const Model& model() const { return model_; }
  /// Of linear factors, on the arrow that led here by the last step.
  const std::vector<Vec>& displacements() const { return workspace_.displacement; }
  /// Goes on from a state with the same bits. Throws std::invalid_argument where it is none of this scene.
  void restore(const SceneState& state);
  /// Visits the state.
  void serialize(NumberArchive& archive);
  /// Goes on from here by usual steps, after one of another size, as from the node at which that state is, with its
  /// index, time, step and multipliers; controlled ones follow the time scale here.
  void end_part(const SceneState& node);

  /// What can be switched (Scene::begin_switch), and whether it acts. The first is all that has no name.
  const Switches& switches() const { return model_.switches; }
  /// By how much, over the sizes of their terms, joints that are off are violated at this node.
  double violation(int switched) const;
  /// Switches at this node. What was held until now goes on with the velocities that it had; of velocities that joints
  /// from now on do not allow, the next step leaves what they do, as an inelastic catch. Requires steps of equal size,
  /// and a small `violation`.
  void switch_to(const std::vector<char>& on);
  /// Goes on from where another motion is, of a scene that differs from this one in numbers alone. Momenta stay what
  /// they are, and of velocities that its joints do not allow the next step leaves what they do; at the start,
  /// controlled steps begin with the time scale there. Throws std::invalid_argument where it is none of such a scene.
  void go_on_from(const Multibody& other);
  /// Adds to the momentum of a linear factor (Scene::linear_of; of a planar body with its angular momentum), and to the
  /// angular momentum of what turns in its own frame; -1 for none. What joints do not allow of it the next step takes.
  void kick(int linear, const Vec& momentum, Attitude attitude, const Vec& spin);

  /// Back along the same trajectory: momenta change their signs.
  void reverse();
  /// Takes from the momenta what the joints do not allow; vakonomic ones keep their last multipliers.
  void make_tangent();

  long index() const { return state_.index; }
  double time() const { return state_.at.time; }
  /// Of the step that led here (at the start, of the first).
  double step() const { return state_.control ? state_.step : step_; }
  const Configuration& configuration() const { return state_.at; }

  /// Where a site and an attitude of the written scene are found in `configuration()`.
  Site operator()(Site s) const { return model_.places(s); }
  Attitude operator()(Attitude a) const { return model_.places(a); }
  /// Where `Scene::linear_of` is found in `configuration()` and in the momenta.
  int linear_place(int linear) const { return model_.linear_places[std::size_t(linear)]; }
  /// Inertia (kg; in the plane kg, kg, kg m^2) and principal moments (kg m^2), as they are now.
  const Vec& inertia(int linear) const { return model_.factors.inertia[std::size_t(linear_place(linear))]; }
  const Vec& moments(Attitude a) const { return model_.factors.moments[std::size_t((*this)(a).index)]; }
  const Quaternion& quaternion(Attitude a) const { return state_.attitude[std::size_t((*this)(a).index)]; }

  /// Inertia times velocity at this node, tangent to the joints (as it is reported); in the order
  /// of `configuration()`: of places (kg m/s) and of attitudes (body angular momentum, kg m^2/s).
  struct Momenta {
    std::vector<Vec> linear;
    std::vector<Vec> spin;
  };
  Momenta momenta() const;

  double kinetic_energy(const Momenta& m) const;
  double potential_energy() const;
  /// What drag and dampers have taken since the start, J: the sum of xi.c xi / h over the arrows.
  double dissipated() const { return state_.dissipated; }
  /// The kinetic terms of the arrow that led here: its share of the cost of a control, J s.
  double arrow_cost() const;
  Vec linear_momentum(const Momenta& m) const;
  /// About the origin, in space.
  Vec angular_momentum(const Momenta& m) const;
  /// The largest |C| at this node, and |phi| on the arrow that led here, over the sizes of their terms.
  double constraint_residual() const;
  /// At the start, the largest rate at which a row of a joint is violated by the given velocities, over the size of its
  /// gradient times them, or over what velocities of this kinetic energy change it by at most, (2 T g M^{-1} g)^(1/2),
  /// where that is larger: what `make_tangent` leaves may be rounding of what was given. Zero for consistent ones.
  double velocity_defect(double kinetic_energy = 0) const;
  /// Of the velocities that were given, with what the joints do not allow.
  double given_kinetic_energy() const { return kinetic_energy(given()); }

  /// The largest c h / (2 m) of a damper, m the inertia that it alone would move. Above one momenta and energies
  /// alternate about those of the motion, which places follow all the same.
  double hardest_damper() const;

  /// Whether its steps can be controlled: attractions act in it, and nothing else.
  bool has_time_scale() const;
  int islands() const { return int(model_.islands.size()); }
  int rows() const { return int(model_.rows.roles.size()); }
  int dependent_rows() const { return model_.rows.dependent; }
  /// Whether the last step was refused because rows left out as dependent no longer follow from the others. The first
  /// is, where they do not along the motion that begins with it.
  bool dependence_ended() const { return workspace_.dependence_ended; }
  /// Multipliers lambda of the constraints C, in the order of the islands' joints, of the last step (per h).
  const std::vector<double>& multipliers() const {
    return (state_.stages.empty() ? state_.guess : state_.stages.back()).multipliers[0];
  }
  /// Of all arrays that the motion needs beyond its effects' and joints' own, B.
  std::size_t memory() const;

 private:
  /// What follows from places and attitudes at the node where the state stands.
  void begin();
  /// The workspace of steps from a state that was set.
  void follow_state();
  void leave_out_dependent();
  /// Of rows that are switched on anew nothing is known, and those that are off have neither values nor gradients.
  void forget_rows();
  void compose(const Composition& composition);

  /// One step of the size that inertia is set to, which ends at the time `end`.
  StepReport advance_to(double end);
  /// A step of stages. Where one of them fails, the state is again what it was before the first.
  StepReport advance_by_stages(double start, double end);
  /// Solves for the arrow that begins here, and finds what acts at its target.
  StepReport solve();
  /// Whether rows left out still follow from the others a good way along the motion that begins here.
  bool dependence_lasts();
  /// How far a step would change the gradients of the rows, over their size, were there no joints.
  double bent();

  /// Moves on along the arrow.
  void accept();

  /// Of the time scale |U|^(-3/2): d log / dt.
  double time_scale_rate() const;
  /// Inertia times velocity at this node, projected to satisfy the rows whose role `counts`.
  Momenta tangent(const Model::Counts& counts) const;
  /// Inertia times velocity at the start: what was given, without the multipliers.
  Momenta given() const;
  /// Adds to momenta `times` the part that is due to the first multipliers of vakonomic rows.
  void add_multipliers(std::vector<Vec>& linear, std::vector<Vec>& spin, double times) const;
  /// The rate at which a row changes where nothing moves by itself: of grounds that move, of plates that turn.
  std::vector<double> imposed_rates() const;

  StepOptions options_;
  double step_;
  std::vector<double> stage_steps_;  ///< of a composed step
  Model model_;
  SceneState state_;
  SceneState before_;  ///< where a composed step began
  Workspace workspace_;
};

}  // namespace lagroid::multibody
