/// The program lagroid-check: `lagroid check`.

#include "bodies/scene_run.hpp"
#include "certificate.hpp"
#include "command/command.hpp"
#include "families/family.hpp"
#include "families/registry.hpp"
#include "spheres/sphere_run.hpp"
#include "spheres/sphere_time.hpp"
#include "study/accuracy.hpp"

#include <lagroid/core/noether.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/systems/certificates.hpp>
#include <lagroid/systems/multibody/testing/scene_laws.hpp>
#include <lagroid/systems/testing/sphere_laws.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace lagroid;
using namespace lagroid::app;

struct CheckOptions : SceneOptions {
  int samples = 100;
  long seed = 20261120;
};

/// Points of a run, evenly spread and never more than a few thousand.
template <class Sys> class Thinned {
 public:
  void add(const TrajectoryPoint<Sys>& point) {
    if (point.index % stride_ != 0) return;
    points_.push_back(point);
    if (points_.size() < 4096) return;
    for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize(points_.size() / 2);
    stride_ *= 2;
  }
  const std::vector<TrajectoryPoint<Sys>>& points() const { return points_; }

 private:
  std::vector<TrajectoryPoint<Sys>> points_;
  long stride_ = 1;
};

/// A state of the run, its momentum moved by a tenth of the largest.
template <DiscreteSystem Sys>
State<typename Sys::GroupoidType> draw_state(const Sys& system, const std::vector<TrajectoryPoint<Sys>>& points,
                                             double largest) {
  auto state = points[*rc::gen::inRange<std::size_t>(0, points.size())].state;
  const double size = 0.1 * largest;
  for (double& x : state.momentum) x += size * laws::draw_uniform();
  state.momentum = tangent_momentum(system, state);
  return state;
}

template <DiscreteSystem Sys> Certificate certify(const Task<Sys>& task, const CheckOptions& options) {
  const auto clock = std::chrono::steady_clock::now();
  Thinned<Sys> run;
  const RunResult result = task.run([&](const TrajectoryPoint<Sys>& point) { run.add(point); });
  auto points = run.points();
  std::vector<Step<Sys>> steps;
  double largest = 0;
  for (const auto& point : points) {
    if (point.index > 0) steps.push_back(point.step);
    largest = std::max(largest, point.state.momentum.norm());
  }
  // From the last one there need not be another step: the end of a boundary value.
  if (points.size() > 1) points.pop_back();

  Certificate certificate;
  certificate.system = result.system;
  certificate.groupoid = Sys::GroupoidType::name();
  certificate.states = points.size();
  certificate.samples = options.samples;
  certificate.seed = options.seed;
  if (!result.converged()) {
    certificate.failure = result.message;
    certificate.failure_status = result.status;
    return certificate;
  }
  certificate.suites = laws::certificate<Sys>(task.system, [&] { return draw_state(task.system, points, largest); });
  if constexpr (requires { task.system.symmetries(); }) {
    for (const auto& symmetry : task.system.symmetries()) {
      const auto found = examine<Sys>(task.system, symmetry, steps);
      certificate.symmetries.push_back(
          {symmetry.name, std::string(to_string(found.kind)), found.defect, found.kind != SymmetryKind::none});
    }
  }
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return certificate;
}

/// The laws of the step of a scene of bodies, where it starts.
Certificate certify_bodies(const Section& scene, const CheckOptions& options) {
  const auto clock = std::chrono::steady_clock::now();
  const BodiesToCheck bodies = read_bodies(scene, {}).to_check;
  Certificate certificate;
  certificate.system = bodies.name;
  certificate.groupoid = "the product of its bodies' groupoids";
  certificate.states = 1;
  certificate.samples = 1;
  certificate.seed = options.seed;
  certificate.suites.push_back(laws::scene_laws(
      {bodies.name, bodies.make, bodies.step, 20 * bodies.step, bodies.symplectic, bodies.reversible}));
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return certificate;
}

/// The laws of the method of a scene on (T*S^2)^k, beside where it starts.
Certificate certify_spheres(const Section& scene, const CheckOptions& options) {
  const SphereEntry& entry = *sphere_system_of(scene);
  const auto clock = std::chrono::steady_clock::now();
  const SpheresToCheck asked = read_spheres(entry, scene, {}).to_check;
  const SphereSystem& system = *asked.system;
  laws::SphereSubject subject{
      std::string(entry.name),
      asked.options,
      asked.start,
      [&](const auto& start, const auto& by) { return system.begin(start, by); },
      [&](const auto& z, SphereForm from, SphereForm to) { return system.in_form(z, from, to); },
      system.forms()};
  subject.keeps_spheres = keeps_spheres(asked.options);
  const auto quantities = system.quantities();
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (quantities[i].promise == Promise::conserved)
      subject.conserved = [&, i](const auto& z) {
        const Measured measured = system.measure(z, asked.options.form)[i];
        return std::pair(measured.value, measured.size);
      };
  Certificate certificate;
  certificate.system = entry.name;
  certificate.groupoid = entry.groupoid;
  certificate.states = 1;
  certificate.samples = options.samples;
  certificate.seed = options.seed;
  certificate.suites.push_back(laws::sphere_laws(subject));
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return certificate;
}

/// The laws along the run of a system's scene.
Certificate certify_system(const Section& scene, const CheckOptions& options) {
  return with_system_of(
      scene, [&](const auto& entry) { return certify(entry.read(scene, {.progress = !options.json}), options); });
}

Certificate certificate_of(const Section& scene, const CheckOptions& options) {
  using Certify = Certificate (*)(const Section&, const CheckOptions&);
  const std::map<const SceneFamily*, Certify> of{
      {&systems_family(), certify_system}, {&spheres_family(), certify_spheres}, {&bodies_family(), certify_bodies}};
  return of.at(&motions_of(scene))(scene, options);
}

int check(const CheckOptions& options) {
  // RapidCheck reads its options from here; laws that fail are told on std::cerr, here by the certificate.
  ::setenv("RC_PARAMS", fmt::format("seed={} max_success={}", options.seed, options.samples).c_str(), 1);
  std::cerr.setstate(std::ios::failbit);
  Section scene = read_scene(options.scene, options.overrides);
  if (scene.has("accuracy")) scene = choose_by_accuracy(scene).scene;
  const Certificate certificate = certificate_of(scene, options);
  print(options.json ? json_certificate(certificate) + "\n" : text_certificate(certificate));
  if (!certificate.failure.empty()) complain(fmt::format("{}: {}", options.scene, certificate.failure));
  return certificate.holds() ? 0 : exit_failed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"ask a scene's system, along its run, every law that applies", "lagroid check"};
  CheckOptions options;
  add_scene_options(app, options);
  app.add_option("--samples", options.samples, "random samples a law")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", options.seed, "of the samples; the certificate is reproducible")
      ->check(CLI::Range(0L, 1'000'000'000'000L));
  return command_line(app, argc, argv, options, [&] { return check(options); });
}
