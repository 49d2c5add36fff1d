#include "check.hpp"

#include "../study/accuracy.hpp"

#include <lagroid/core/testing/sampling.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <utility>

namespace lagroid::app {

namespace {

Certificate certified(const Section& scene, const CheckCommandOptions& options) {
  const laws::Sampling sampling(options.samples, options.seed);
  const auto clock = std::chrono::steady_clock::now();
  Certificate certificate = laws_of(scene).certify(scene, options);
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return certificate;
}

/// Of a run that failed: steps on what is no groupoid need not exist, so a broken law is the reason to look at first.
std::string failure_of(const Certificate& certificate) {
  for (const laws::LawReport& suite : certificate.suites)
    for (const laws::Law& law : suite.laws)
      if (!law.holds() && !law.unjudged)
        return fmt::format("{}; its groupoid is none: {} is broken", certificate.failure, law.name);
  return certificate.failure;
}

int check(const CheckCommandOptions& options) {
  Section scene = read_scene(options.scene, options.overrides);
  if (scene.has("accuracy")) scene = choose_by_accuracy(scene).scene;
  const Certificate certificate = certified(scene, options);
  print(options.json ? json_certificate(certificate) + "\n" : text_certificate(certificate));
  if (!certificate.failure.empty()) complain(fmt::format("{}: {}", options.scene, failure_of(certificate)));
  return certificate.holds() ? 0 : exit_failed;
}

}  // namespace

int check_program(int argc, char** argv, ProgramParts parts, std::vector<const FamilyLaws*> laws) {
  use_families(std::move(parts.families));
  use_systems(std::move(parts.systems));
  use_laws(std::move(laws));
  CLI::App app{"test every law that applies to a scene's system, along its run", "lagroid check"};
  CheckCommandOptions options;
  add_scene_options(app, options);
  app.add_option("--samples", options.samples, "random samples a law")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", options.seed, "of the samples; the certificate is reproducible")
      ->check(CLI::Range(0L, 1'000'000'000'000L));
  return command_line(app, argc, argv, options, [&] { return check(options); });
}

}  // namespace lagroid::app
