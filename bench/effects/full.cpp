// A program that knows all effects: full STEPS EFFECT, where "none" leaves them all out of the scene.
#include <lagroid/systems/multibody/effects.hpp>

#include "base_scene.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace {

using namespace effects;

const std::map<std::string, std::function<void(Base&)>>& kinds() {
  static const std::map<std::string, std::function<void(Base&)>> all{
      {"none", [](Base&) {}},
      {"gravity",
       [](Base& b) {
         for (const auto& [body, mass] : {std::pair{b.left, 1.0}, {b.right, 2.0}, {b.near, 0.5}, {b.far, 0.5}})
           b.scene.add(ConstantForce{{body.centre}, {0, 0, -9.81 * mass}});
       }},
      {"central gravity",
       [](Base& b) {
         for (const Body& body : {b.left, b.right, b.near, b.far})
           b.scene.add(CentralGravity{{body.centre}, {0, 0, -10}, 1});
       }},
      {"mutual gravity",
       [](Base& b) {
         auto gravity = std::make_unique<MutualGravity>(1, 0.1);
         for (const Body& body : {b.left, b.right, b.near, b.far}) gravity->add(body.centre, 1);
         b.scene.add_effects(std::move(gravity));
       }},
      {"charges",
       [](Base& b) {
         b.scene.add(InverseSquare{{b.left.centre, b.near.centre}, 0.1});
       }},
      {"spring",
       [](Base& b) {
         b.scene.add(Spring{{b.scene.point_of(b.left, {0.1, 0.2, 0}), b.near.centre}, 1, 0.5});
       }},
      {"torsion spring",
       [](Base& b) {
         b.scene.add(TorsionSpring{{}, {b.left.attitude, b.right.attitude}, {1, 0, 0}, {1, 0, 0}, 1});
       }},
      {"periodic force",
       [](Base& b) {
         b.scene.add(PeriodicForce{{b.far.centre}, {0, 0, 0.1}, 3});
       }},
      {"torque",
       [](Base& b) {
         b.scene.add(BodyTorque{{}, {b.left.attitude}, {0, 0, 0.1}});
       }},
      {"damping", [](Base& b) { b.scene.damp(b.left, 0.1, 0.1); }},
      {"a joint that rubs",
       [](Base& b) {
         b.scene.add(Damper<RelativeTurn>{{{}, {b.left.attitude, b.right.attitude}}, 0.1});
       }},
      {"damper between points",
       [](Base& b) {
         b.scene.add(Damper<Length>{{{b.right.centre, b.near.centre}}, 0.1});
       }},
      {"nonholonomic spin",
       [](Base& b) {
         b.scene.add(PrescribedSpin{{}, {b.left.attitude}, {0, 0, 1}, 0});
       }},
      {"vakonomic spin",
       [](Base& b) {
         b.scene.add(Vakonomic<PrescribedSpin>{{{}, {b.left.attitude}, {0, 0, 1}, 0}, {0.1}});
       }},
      {"rod to a ground that moves",
       [](Base& b) {
         b.scene.add(Rod{{b.scene.moving_ground({0.5, 3, 0}, {0.1, 0, 0}, 2), b.far.centre}, 1});
       }},
      {"another rod",
       [](Base& b) {
         b.scene.add(Rod{{b.right.centre, b.near.centre}, std::sqrt(1.25)});
       }},
  };
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string(argv[1]) == "list") {
    for (const auto& [name, add] : kinds()) std::printf("%s\n", name.c_str());
    return 0;
  }
  if (argc != 3 || !kinds().contains(argv[2])) return 2;
  Base base;
  kinds().at(argv[2])(base);
  return integrate(std::move(base.scene), std::atol(argv[1]));
}
