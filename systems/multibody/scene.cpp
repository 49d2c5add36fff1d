#include <lagroid/systems/multibody/scene.hpp>

namespace lagroid::multibody {

Body Scene::point_mass(double mass, const Vec& place, const Vec& velocity) {
  linear_.push_back({Vec::Constant(mass), place, velocity});
  sites_.push_back({int(linear_.size()) - 1});
  return {{int(sites_.size()) - 1}, {}};
}

Body Scene::rigid_body(double mass, const Vec& inertia, const Vec& place, const Quaternion& attitude,
                       const Vec& velocity, const Vec& angular_velocity) {
  Body body = point_mass(mass, place, velocity);
  rotating_.push_back({inertia, attitude, angular_velocity});
  body.attitude = {int(rotating_.size()) - 1};
  return body;
}

Body Scene::pivoted_body(const Vec& inertia, const Vec& pivot, const Quaternion& attitude,
                         const Vec& angular_velocity) {
  rotating_.push_back({inertia, attitude, angular_velocity});
  return {ground(pivot), {int(rotating_.size()) - 1}};
}

Body Scene::planar_body(double mass, double inertia, const Vec& place, const Vec& rate) {
  linear_.push_back({Vec(mass, mass, inertia), place, rate, Mat::Zero(), true});
  // Its own place is (x, y, angle); as a point it is (x, y, 0).
  sites_.push_back({int(linear_.size()) - 1, -1, -1});
  sites_.push_back({int(linear_.size()) - 1, -1, int(sites_.size()) - 1});
  return {{int(sites_.size()) - 1}, {}};
}

Site Scene::point_of(const Body& body, const Vec& arm) {
  if (arm.isZero(0)) return body.centre;
  const Point centre = sites_[std::size_t(body.centre.index)];
  const bool planar = centre.linear >= 0 && linear_[std::size_t(centre.linear)].planar;
  sites_.push_back({centre.linear, body.attitude.index, planar ? centre.base : body.centre.index, arm});
  return {int(sites_.size()) - 1};
}

Site Scene::ground(const Vec& place) {
  sites_.push_back({-1, -1, -1, place});
  return {int(sites_.size()) - 1};
}

Site Scene::moving_ground(const Vec& place, const Vec& amplitude, double rate) {
  sites_.push_back({-1, -1, -1, place, amplitude, rate});
  return {int(sites_.size()) - 1};
}

void Scene::damp(const Body& body, double of_motion, double of_turning) {
  if (const int linear = sites_[std::size_t(body.centre.index)].linear; linear >= 0) {
    Linear& l = linear_[std::size_t(linear)];
    l.drag.diagonal() += l.planar ? Vec(of_motion, of_motion, of_turning) : Vec::Constant(of_motion);
  }
  if (body.attitude.index >= 0) rotating_[std::size_t(body.attitude.index)].damping += Vec::Constant(of_turning);
}

void Scene::gyroscopic_force(const Body& body, const Vec& w) {
  linear_[std::size_t(sites_[std::size_t(body.centre.index)].linear)].drag += SO3::hat(w);
}

}  // namespace lagroid::multibody
