#pragma once
/// The motion of a scene.

#include <lagroid/solvers/compositions.hpp>
#include <lagroid/solvers/elimination.hpp>
#include <lagroid/solvers/step_control.hpp>
#include <lagroid/solvers/step_solver.hpp>
#include <lagroid/systems/multibody/scene.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
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

/// Marches the discrete Lagrangian of a scene,
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

  /// One step. Where it does not converge nothing changes, and the report says why.
  StepReport advance();

  /// All that the motion depends on: a scene restored to it goes on with the same bits.
  struct State {
    long index = 0;
    double dissipated = 0;
    std::vector<Vec> place, place_carry, momentum, momentum_carry, spin, spin_carry, turned;
    std::vector<Quaternion> attitude;
    std::array<std::vector<double>, 3> multipliers;  ///< of the last three steps, from which the next are guessed
    std::vector<std::vector<double>> stages;         ///< the same of each stage of a composed step, and its turns
    std::vector<double> clock;                       ///< time, and what controls the step
    /// What follows from places and attitudes. Computed anew at another place of the program it could differ in its
    /// last bits; where it is empty, it is.
    struct Derived {
      std::vector<Vec> x, forces, torques, gradients;
      std::vector<Mat> attitude;
      std::vector<double> terms, slopes, precision;
      double arrow_residual = 0;

      /// Visits the fields.
      template <class Archive> void persist(Archive& archive) {
        archive("x", x);
        archive("forces", forces);
        archive("torques", torques);
        archive("gradients", gradients);
        archive("attitude", attitude);
        archive("terms", terms);
        archive("slopes", slopes);
        archive("precision", precision);
        archive("arrow residual", arrow_residual);
      }
    } derived;
  };
  State state() const;
  /// Throws std::invalid_argument where it is no state of this scene.
  void restore(const State& state);
  /// Back along the same trajectory: momenta change their signs.
  void reverse();
  /// Takes from the momenta what the joints do not allow; vakonomic ones keep their last multipliers.
  void make_tangent();

  long index() const { return index_; }
  double time() const { return now_.time; }
  /// Of the step that led here (at the start, of the first).
  double step() const { return control_ ? h_ : whole_step_; }
  const Configuration& configuration() const { return now_; }

  /// Where a site and an attitude of the written scene are found in `configuration()`.
  Site operator()(Site s) const { return places_(s); }
  Attitude operator()(Attitude a) const { return places_(a); }
  /// Where `Scene::linear_of` is found in `configuration()` and in the momenta.
  int linear_place(int linear) const { return linear_places_[std::size_t(linear)]; }
  const Quaternion& quaternion(Attitude a) const { return quaternions_[std::size_t(places_(a).index)]; }

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
  double dissipated() const { return dissipated_; }
  /// The kinetic terms of the arrow that led here: its share of the cost of a control, J s.
  double arrow_cost() const;
  Vec linear_momentum(const Momenta& m) const;
  /// About the origin, in space.
  Vec angular_momentum(const Momenta& m) const;
  /// The largest |C| at this node, and |phi| on the arrow that led here, over the sizes of their terms.
  double constraint_residual() const;
  /// At the start, the largest rate at which a row of a joint is violated by the given velocities, over the size of its
  /// gradient times them; zero for consistent ones.
  double velocity_defect() const;

  /// The largest c h / (2 m) of a damper, m the inertia that it alone would move. Above one momenta and energies
  /// alternate about those of the motion, which places follow all the same.
  double hardest_damper() const;

  /// Whether its steps can be controlled: attractions act in it, and nothing else.
  bool has_time_scale() const;
  int islands() const { return int(islands_.size()); }
  int rows() const { return int(values_.size()); }
  int dependent_rows() const { return dependent_rows_; }
  /// Whether the last step was refused because rows left out as dependent no longer follow from the others. The first
  /// is, where they do not along the motion that begins with it.
  bool dependence_ended() const { return dependence_ended_; }
  /// Multipliers lambda of the constraints C, in the order of the islands' joints, of the last step (per h).
  const std::vector<double>& multipliers() const { return stages_.empty() ? earlier_[0] : stages_.back().earlier[0]; }
  /// Of all arrays that the motion needs beyond its effects' and joints' own, B.
  std::size_t memory() const;

 private:
  /// A part of a composed step, with what its next guess is made of.
  struct Stage {
    double step;
    std::array<std::vector<double>, 3> earlier;
    std::vector<Vec> turned;
  };
  struct Range {
    int first = 0;
    int last = 0;
    int size() const { return last - first; }
  };
  /// Joints of one kind in one island.
  struct Batch {
    const Joints* joints;
    Role role;
    int first;
    int count;
    int row;
    int gradient;
  };
  /// A gradient of a row that moves a factor.
  struct Entry {
    int gradient;
    int factor;
    int row;
    Role role;
    bool along_arrow;  ///< Joints::along_arrows
  };
  /// A gradient of a row along a point of the ground that moves.
  struct MovingEntry {
    int gradient;
    int row;
    int ground;
  };
  /// A point of the ground that moves.
  struct MovingGround {
    int site;
    Vec place, amplitude;
    double rate;
    Vec at(double time) const { return place + (1 - std::cos(rate * time)) * amplitude; }
    Vec velocity(double time) const { return rate * std::sin(rate * time) * amplitude; }
  };
  /// S(row a, row b) += (gradient of a) . (response to b).
  struct Pair {
    int gradient;
    int row;  ///< of a
    int entry;
    int value;
  };
  /// A gradient along a point of a body, which turns that body.
  struct Lever {
    int from;
    int to;
    int rotation;
    Vec arm;
  };
  struct PlanarLever {
    int from;
    int to;
    int site;
    int body;
  };
  /// A point fixed in a body.
  struct Arm {
    int site;
    int base;
    int rotation;
    Vec arm;
  };
  /// A linear factor on which the force -drag v acts; `response` is then no diagonal matrix.
  struct Dragged {
    int factor;
    Mat drag;
    Mat response;
  };
  struct Island {
    Range linear, dragged, rotations, arms, planar_arms, rows, batches, linear_entries, rotation_entries, linear_pairs,
        rotation_pairs, levers, planar_levers;
    bool vakonomic = false;
    bool moved = false;  ///< by the ground
    Elimination matrix;
  };

  void assemble(Scene& scene);
  void leave_out_dependent();
  /// Throws std::domain_error where what joints tie together obeys two principles.
  void require_one_principle(const Island& island) const;
  /// What follows from places and attitudes at this node.
  void begin();

  void act(const Configuration& at);
  bool next_is_finite() const;
  /// Half a step's impulse of the forces at this node.
  void kick();
  void place_arms(Configuration& at, const Range& arms, const Range& planar_arms) const;
  void correct(const Island& island, const double* multipliers);
  void try_place(const Island& island);
  /// Gradients along points fixed in bodies become those along their motions.
  void pull_back(const Configuration& at, const Island& island, std::vector<Vec>& gradients) const;
  /// The joints' reactions at this node.
  void react(const Island& island);
  /// Covectors of vakonomic rows, and the displacements under them, at the arrow as it stands; returns by how much
  /// these moved, over their size.
  double follow(const Island& island);
  void set_step(double h);
  /// Of the time scale |U|^(-3/2): d log / dt.
  double time_scale_rate() const;
  using Counts = std::function<bool(Role)>;
  /// D W D^T of the rows that count, at this node, with weights of the factors; one on the diagonal of the others.
  void gather(const Island& island, const std::vector<Vec>& linear_weights, const std::vector<Vec>& rotation_weights,
              const Counts& counts, Elimination& matrix) const;
  /// Inertia times velocity that the rows which count allow.
  Momenta tangent(const Counts& counts) const;
  /// What the first multipliers of vakonomic rows add to momenta.
  void add_multipliers(std::vector<Vec>& linear, std::vector<Vec>& spin, double times) const;
  /// The rate at which a row changes where nothing moves by itself: of grounds that move, of plates that turn.
  std::vector<double> imposed_rates() const;
  Motion motion() const { return {now_, next_, displacement_, turned_, h_}; }
  Role role(int row) const { return roles_[std::size_t(row)]; }
  bool factorise(Island& island);
  StepReport solve(Island& island);
  StepReport turn_freely(int rotation);
  void compose(const Composition& composition);
  /// One step of the size h_, which ends then.
  StepReport advance_by(double end);
  StepReport advance_by_stages();
  void save(State& state) const;
  bool stages_fit(const State& state) const;
  /// Solves all islands; what a step leaves behind that is not accepted is put right by `advance`.
  StepReport solve_all();
  /// Whether rows left out still follow from the others a good way along the motion that begins here.
  bool dependence_lasts();
  /// How far a step would change the gradients of the rows, over their size, were there no joints.
  double bent();
  void accept();
  /// The momentum that vakonomic rows take away again at the target; the forces of dampers there.
  void end_vakonomic();
  void end_damping();

  double h_;
  Options options_;
  double whole_step_;
  std::vector<Stage> stages_;  ///< of a composed step
  State before_;               ///< of it, to which a step that fails in between returns
  std::optional<StepController> control_;
  double time_carry_ = 0;
  long index_ = 0;
  Places places_;
  std::vector<int> linear_places_;
  std::vector<std::unique_ptr<Joints>> joints_;
  std::vector<std::unique_ptr<Effects>> effects_;

  // Linear factors (point masses, planar bodies) and rotations, each sorted by island, those of none first.
  Configuration now_, next_;
  std::vector<Quaternion> quaternions_, next_quaternions_;
  std::vector<char> planar_;
  std::vector<Vec> inertia_, moments_;
  std::vector<Vec> response_;  ///< displacement of a linear factor over its momentum, where no drag acts
  std::vector<Turn> turns_;
  std::vector<Vec> turn_damping_;
  std::vector<Dragged> dragged_;
  std::vector<int> damped_turns_;  ///< the rotations of which it is not zero

  std::vector<Vec> momentum_, momentum_carry_, place_carry_, spin_, spin_carry_;
  Loads loads_;

  // Of the step being solved.
  std::vector<Vec> impulse_, kicked_, displacement_;
  std::vector<Vec> spin_impulse_, spin_kicked_, spin_total_, turned_, turned_before_, turn_residual_;
  std::vector<double> spin_size_;  ///< of the terms that a residual is made of
  std::vector<Mat> turn_inverse_, turn_frame_;

  // Points fixed in bodies, those of no island last; those that effects act on.
  std::vector<Arm> arms_, planar_arms_, pushed_arms_, pushed_planar_arms_;

  Island free_;  ///< the factors of no island
  std::vector<Island> islands_;
  std::vector<Batch> batches_;
  std::vector<Entry> linear_entries_, rotation_entries_;
  std::vector<Pair> linear_pairs_, rotation_pairs_;
  std::vector<Lever> levers_;
  std::vector<PlanarLever> planar_levers_;
  std::vector<Vec> gradients_, next_gradients_, linear_response_, rotation_response_, rotation_gradient_;
  std::vector<int> factor_entries_;  ///< of each linear factor, where its entries begin
  std::vector<RowSize> sizes_;
  std::vector<double> multipliers_, values_, right_;
  std::vector<double> precision_, accepted_precision_;  ///< one over the size of a row: of this step, of the last
  std::array<std::vector<double>, 3> earlier_;          ///< multipliers of the last steps
  std::vector<char> left_out_;
  std::vector<Role> roles_;
  std::vector<double> softness_;                             ///< of damping rows: 2 / c; empty where there are none
  std::vector<Vec> drifts_, free_displacement_, reactions_;  ///< where there are vakonomic rows
  std::vector<MovingGround> moving_;
  std::vector<MovingEntry> moving_entries_;
  double dissipated_ = 0;
  double arrow_residual_ = 0;  ///< of the rows on the arrow that led here
  bool has_arrow_rows_ = false;
  bool has_vakonomic_ = false;
  int dependent_rows_ = 0;
  bool dependence_ended_ = false;
};

}  // namespace lagroid::multibody
