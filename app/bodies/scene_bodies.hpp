#pragma once
/// A scene of bodies while it is read: its bodies by name, and where they are at the start.

#include "../keys/key.hpp"

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/run/motion/shape.hpp>
#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/scene.hpp>

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// A body with its name and its state at the start.
template <class S = double> struct BasicNamedBody {
  std::string name;
  multibody::Body body;
  bool planar = false;
  int linear = -1;  ///< Scene::linear_of
  S mass = 0;
  multibody::Site mass_centre;  ///< where its weight acts
  Vector<S, 3> place = Vector<S, 3>::Zero();
  Matrix<S, 3, 3> attitude = Matrix<S, 3, 3>::Identity();
  S angle = 0;  ///< of a planar body
  Vector<S, 3> velocity = Vector<S, 3>::Zero();
  Vector<S, 3> angular_velocity = Vector<S, 3>::Zero();  ///< in space
  Vector<S, 3> inertia = Vector<S, 3>::Zero();           ///< principal moments; zero for a point mass
  double radius = 0;                                     ///< of a ball; else of no use
  std::string principle;                                 ///< of its constraints on arrows, if there are any
  Vector<S, 3> to_centre = Vector<S, 3>::Zero();  ///< from its reference point to its centre of mass, in its frame
};
using NamedBody = BasicNamedBody<>;

/// One end of a joint or a spring: a point of a body or of the ground.
template <class S = double> struct BasicAttachment {
  const BasicNamedBody<S>* body = nullptr;  ///< null: the ground
  Vector<S, 3> arm = Vector<S, 3>::Zero();
  Vector<S, 3> place = Vector<S, 3>::Zero();  ///< in space at the start
  multibody::Site site;
  bool moved = false;  ///< a point of the ground that moves

  multibody::Attitude attitude() const { return body ? body->body.attitude : multibody::Attitude{}; }
  /// A direction in space, in the frame of this body.
  Vector<S, 3> seen(const Vector<S, 3>& direction) const {
    return body ? Vector<S, 3>(body->attitude.transpose() * direction) : direction;
  }
  bool turns_in_space() const { return !body || body->body.attitude.index >= 0; }
  std::string name() const { return body ? body->name : "ground"; }
};
using Attachment = BasicAttachment<>;

/// A number of a scene by which derivatives are taken: where it stands, as effect.0.stiffness, and what it is.
struct VariedAt {
  std::string path;
  VariedNumber number;
  mutable bool is_read = false;  ///< as a number with a derivative
};

/// What the reader makes of a scene.
template <class S = double> struct BasicSceneBodies {
  using NamedBody = BasicNamedBody<S>;
  using Attachment = BasicAttachment<S>;

  multibody::BasicScene<S> scene;
  std::deque<NamedBody> bodies;  ///< ends point to them
  /// Straight connections to be drawn, and how thick (over the size of the scene).
  struct Line {
    Attachment from, to;
    double width;
    int switched_by = 0;  ///< Switches: it is drawn while that is on
  };
  std::vector<Line> lines;
  std::vector<Shape> scenery;  ///< what stands around: a plate
  bool projects = false;       ///< velocities are brought to what the joints allow
  bool nonholonomic = false;
  bool gyroscopic = false;  ///< by magnetic fields or the frame: momenta are not the canonical ones
  bool dissipates = false;  ///< damping takes energy
  bool driven = false;      ///< forces that are not derived from a potential
  bool timed = false;       ///< forces and motions that time gives: energy is not kept
  bool vakonomic = false;
  bool counts_cost = false;           ///< of the controls: the kinetic terms
  double damping_rate = 0;            ///< the largest drag over what it slows down, 1/s
  bool is_off = false;                ///< what is read now does not act at the start
  bool is_on_its_way = false;         ///< with other numbers: joints hold where the bodies are then, not at the start
  bool isolated = true;               ///< nothing acts from outside: momenta are conserved
  double extent = 0;                  ///< size of the scene at the start, m
  std::string reads;                  ///< the table that is read now, effect.0
  std::vector<VariedAt> varied = {};  ///< where S has derivatives

  /// Whether joints that are read now need not allow the velocities that bodies have at the start.
  bool is_free_to_start() const { return projects || is_free_in_place(); }
  /// Whether they need not hold where the bodies are at the start.
  bool is_free_in_place() const { return is_off || is_on_its_way; }

  /// What the table that is read now has at a key.
  S number(const Section& table, const KeyOf<Number>& key) const {
    return varied_number(key.name, read_key(table, key));
  }
  S number_or(const Section& table, const KeyOf<Number>& key, const S& fallback) const {
    return table.has(key.name) ? varied_number(key.name, read_key_or(table, key, 0)) : fallback;
  }
  std::vector<S> numbers(const Section& table, const KeyOf<NumberArray>& key) const;
  Vector<S, 3> vector(const Section& table, const KeyOf<NumberArray>& key) const;

  /// The ends of a table, by `end_keys`; without points, by the first of these.
  std::array<Attachment, 2> ends(const Section& table, bool with_points = true);
  /// The bodies named under `chosen_bodies`, each once, a chain by its own name too; all of them where it is missing.
  std::vector<const NamedBody*> chosen(const Section& table) const;
  const NamedBody& named(const Section& table, std::string_view key, const std::string& name) const;
  NamedBody& named(const Section& table, std::string_view key, const std::string& name) {
    return const_cast<NamedBody&>(std::as_const(*this).named(table, key, name));
  }
  /// The point of a body (null: the ground) that `key` of the table gives.
  Attachment end_of(const Section& table, std::string_view key, const NamedBody* body, const Vector<S, 3>& arm);
  /// A point of the ground, which `ground_keys` of the table may move.
  Attachment ground_of(const Section& table, const Vector<S, 3>& place);

 private:
  /// A number that was read at a key of the table that is read now.
  S varied_number(const std::string& key, double x) const;
  Vector<S, 3> varied_vector(const std::string& key, const std::vector<double>& x) const;
};
using SceneBodies = BasicSceneBodies<>;

/// A direction, of length one.
template <class S> Vector<S, 3> unit_of(const Vector<S, 3>& direction) {
  if constexpr (std::is_same_v<S, double>) {
    return direction.stableNormalized();
  } else {
    return direction / direction.norm();
  }
}

/// Of dampers.
inline constexpr NumberRule damping_rule{"positive, and below 1e100", [](double x) { return x > 1e-100 && x < 1e100; }};

/// A vector of space; without a fallback it must be given.
KeyOf<NumberArray> vector_key(std::string name, std::string unit, std::string meaning,
                              std::optional<multibody::Vec> fallback = {});

inline const KeyOf<Text> body_key{"body", {}, "", "the name of a body"};
inline const KeyOf<Texts> chosen_bodies{"bodies", {}, "", "names of bodies", {}, "all of them"};
/// What moves a point of the ground, and the ends of what ties two bodies.
std::vector<Key> ground_keys();
std::vector<Key> end_keys();

/// One generic function that reads a table, over numbers with derivatives, too. LAGROID_PLAIN_SCENES leaves those out
/// of a program that never asks for any.
class SceneReader {
 public:
  template <class Read> SceneReader(Read) : plain_(over<double, Read>) {
#ifndef LAGROID_PLAIN_SCENES
    varied_ = over<VariedNumber, Read>;
    second_ = over<multibody::SecondNumber, Read>;
#endif
  }
  void operator()(SceneBodies& bodies, const Section& table) const { plain_(bodies, table); }
  void operator()(BasicSceneBodies<VariedNumber>& bodies, const Section& table) const { varied_(bodies, table); }
  void operator()(BasicSceneBodies<multibody::SecondNumber>& bodies, const Section& table) const {
    second_(bodies, table);
  }

 private:
  template <class S, class Read> static void over(BasicSceneBodies<S>& bodies, const Section& table) {
    Read()(bodies, table);
  }
  void (*plain_)(SceneBodies&, const Section&);
  void (*varied_)(BasicSceneBodies<VariedNumber>&, const Section&) = nullptr;
  void (*second_)(BasicSceneBodies<multibody::SecondNumber>&, const Section&) = nullptr;
};

/// What a table's `kind` stands for.
struct SceneKind {
  const char* name;
  const char* about;
  SceneReader read;
  std::vector<Key> keys = {};  ///< besides `kind`
  bool has_switch = true;      ///< an event can switch it, by a name
};
/// Reads a table by its `kind`.
template <class S>
void read_kind(const std::vector<SceneKind>& kinds, BasicSceneBodies<S>& bodies, const Section& table);
/// The keys of all of them.
Table table_of(const std::vector<SceneKind>& kinds);
/// The kinds of [[body]], [[joint]] and [[effect]], as they are listed to users.
const std::vector<SceneKind>& body_kinds();
const std::vector<SceneKind>& joint_kinds();
const std::vector<SceneKind>& effect_kinds();
/// The keys of a scene of bodies.
Table bodies_table();

/// Whether the step of the scene is that of an action principle, and so symplectic in the canonical momenta.
inline bool is_variational(const SceneBodies& bodies) {
  return !bodies.dissipates && !bodies.driven && !bodies.nonholonomic;
}
/// Whether it is symplectic in its own momenta.
inline bool is_symplectic(const SceneBodies& bodies) { return is_variational(bodies) && !bodies.gyroscopic; }
/// Whether it goes back where these change their signs.
inline bool is_reversible(const SceneBodies& bodies) { return is_symplectic(bodies) && !bodies.timed; }

/// Whether steps of it can be composed to higher orders.
inline bool is_composable(const SceneBodies& bodies) {
  return !bodies.dissipates && !bodies.nonholonomic && !bodies.vakonomic && !bodies.gyroscopic;
}

/// Reads [[body]], [[joint]] and [[effect]]; `on_its_way` with numbers that are not those of its start.
SceneBodies read_scene_bodies(const Section& scene, bool on_its_way = false);
/// The same over numbers with derivatives, by those at these places. Throws std::invalid_argument, one line, for one
/// that is read as a plain number.
BasicSceneBodies<VariedNumber> read_varied_scene(const Section& scene, const std::vector<VariedAt>& varied);
/// The same over numbers with second derivatives, by places and attitudes alone (multibody::ControlledScene).
BasicSceneBodies<multibody::SecondNumber> read_second_scene(const Section& scene);

}  // namespace lagroid::app
