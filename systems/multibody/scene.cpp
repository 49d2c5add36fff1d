#include <lagroid/systems/multibody/scene.hpp>

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/systems/multibody/control/second_number.hpp>

namespace lagroid::multibody {

template <class S>
Body BasicScene<S>::point_mass(const S& mass, const Vector<S, 3>& place, const Vector<S, 3>& velocity) {
  linear_.push_back({Vector<S, 3>::Constant(mass), place, velocity});
  sites_.push_back({int(linear_.size()) - 1});
  return {{int(sites_.size()) - 1}, {}};
}

template <class S>
Body BasicScene<S>::rigid_body(const S& mass, const Vector<S, 3>& inertia, const Vector<S, 3>& place,
                               const Vector<S, 4>& attitude, const Vector<S, 3>& velocity,
                               const Vector<S, 3>& angular_velocity) {
  Body body = point_mass(mass, place, velocity);
  rotating_.push_back({inertia, attitude, angular_velocity});
  body.attitude = {int(rotating_.size()) - 1};
  return body;
}

template <class S>
Body BasicScene<S>::pivoted_body(const Vector<S, 3>& inertia, const Vector<S, 3>& pivot, const Vector<S, 4>& attitude,
                                 const Vector<S, 3>& angular_velocity) {
  rotating_.push_back({inertia, attitude, angular_velocity});
  return {ground(pivot), {int(rotating_.size()) - 1}};
}

template <class S>
Body BasicScene<S>::planar_body(const S& mass, const S& inertia, const Vector<S, 3>& place, const Vector<S, 3>& rate) {
  linear_.push_back({Vector<S, 3>(mass, mass, inertia), place, rate, Matrix<S, 3, 3>::Zero(), true});
  // Its own place is (x, y, angle); as a point it is (x, y, 0).
  sites_.push_back({int(linear_.size()) - 1, -1, -1});
  sites_.push_back({int(linear_.size()) - 1, -1, int(sites_.size()) - 1});
  return {{int(sites_.size()) - 1}, {}};
}

template <class S> Site BasicScene<S>::point_of(const Body& body, const Vector<S, 3>& arm) {
  if (stays_zero(arm)) return body.centre;
  const Point centre = sites_[std::size_t(body.centre.index)];
  const bool planar = centre.linear >= 0 && linear_[std::size_t(centre.linear)].planar;
  sites_.push_back({centre.linear, body.attitude.index, planar ? centre.base : body.centre.index, arm});
  return {int(sites_.size()) - 1};
}

template <class S> Site BasicScene<S>::ground(const Vector<S, 3>& place) {
  sites_.push_back({-1, -1, -1, place});
  return {int(sites_.size()) - 1};
}

template <class S>
Site BasicScene<S>::moving_ground(const Vector<S, 3>& place, const Vector<S, 3>& amplitude, const S& rate) {
  sites_.push_back({-1, -1, -1, place, amplitude, rate});
  return {int(sites_.size()) - 1};
}

template <class S> void BasicScene<S>::damp(const Body& body, const S& of_motion, const S& of_turning) {
  if (const int linear = sites_[std::size_t(body.centre.index)].linear; linear >= 0) {
    Linear& l = linear_[std::size_t(linear)];
    l.drag.diagonal() += l.planar ? Vector<S, 3>(of_motion, of_motion, of_turning) : Vector<S, 3>::Constant(of_motion);
  }
  if (body.attitude.index >= 0)
    rotating_[std::size_t(body.attitude.index)].damping += Vector<S, 3>::Constant(of_turning);
}

template <class S> void BasicScene<S>::gyroscopic_force(const Body& body, const Vector<S, 3>& w) {
  linear_[std::size_t(sites_[std::size_t(body.centre.index)].linear)].drag += SO3::hat(w);
}

template class BasicScene<double>;
template class BasicScene<VariedNumber>;
template class BasicScene<SecondNumber>;

}  // namespace lagroid::multibody
