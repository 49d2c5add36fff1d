#pragma once
/// What is to be seen of a scene of bodies at a node.

#include "scene_bodies.hpp"

#include <lagroid/run/motion/observables.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <functional>
#include <set>
#include <vector>

namespace lagroid::app {

/// Places, attitudes and momenta of the `chosen` bodies, or of all; energy, and the momenta that nothing outside
/// changes.
class SceneNode final : public Observables {
 public:
  /// The motion and the bodies must outlive this.
  SceneNode(const multibody::Multibody& motion, const SceneBodies& bodies, const std::set<std::string>& chosen,
            bool controlled);
  SceneNode(const SceneNode&) = delete;
  SceneNode& operator=(const SceneNode&) = delete;

  /// Computes what is asked of the node that the motion has reached.
  void see(double cost);

  double energy() const { return kinetic_ + potential_; }
  const multibody::Multibody::Momenta& momenta() const { return momenta_; }

  long index() const override { return motion_.index(); }
  double time() const override { return motion_.time(); }
  Endpoint endpoint() const override;
  bool finite() const override;
  const std::vector<Field>& fields() const override { return fields_; }
  void read(std::size_t field, double* row) const override { read_[field](row); }
  const std::vector<Watched>& quantities() const override { return watched_; }
  double measure(std::size_t quantity, double* values) const override { return measure_[quantity](values); }
  Constrained constrained() const override { return motion_.rows() > 0 ? Constrained::promised : Constrained::no; }
  std::optional<double> residual() const override { return residual_; }
  std::span<const double> positions() const override;

 private:
  using Read = std::function<void(double*)>;
  using Measure = std::function<double(double*)>;

  void add(Columns columns, Read read);
  void watch(Watched quantity, Measure measure);
  void add_point(const std::string& name, multibody::Site site);
  void add_line(std::size_t number, const SceneBodies::Line& line,
                const std::function<bool(const NamedBody&)>& is_shown);
  void add_body(const NamedBody& body);
  const multibody::Vec& linear_momentum(int linear) const;
  double momentum_size() const;
  double angular_size() const;

  const multibody::Multibody& motion_;
  std::vector<const NamedBody*> shown_;
  std::vector<Field> fields_;
  std::vector<Read> read_;
  std::vector<Watched> watched_;
  std::vector<Measure> measure_;
  multibody::Multibody::Momenta momenta_;
  double cost_ = 0, kinetic_ = 0, potential_ = 0, residual_ = 0;
};

}  // namespace lagroid::app
