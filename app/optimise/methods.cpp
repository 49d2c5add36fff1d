#include "methods.hpp"

#include <lagroid/solvers/optimisation/methods/accelerated.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace lagroid::app {

namespace {

using namespace optimisation;
using MadeMethod = std::unique_ptr<DescentMethod>;

AcceleratedOptions accelerated(const Section& section, std::string name, bool rescale) {
  AcceleratedOptions out{.name = std::move(name)};
  // A penalty takes the place of the constraint before a method sees it.
  const bool projects =
      section.choice_or("constraint", "multipliers", {"multipliers", "projection", "penalty"}) == "projection";
  if (projects) out.constraint = Constraint::projection;
  out.rescale = section.flag_or("rescale", rescale);
  out.restart = section.flag_or("restart", false);
  out.look_ahead = section.flag_or("look_ahead", false);
  return out;
}

double cap(const Section& section) {
  const bool capped = section.flag_or("capped", true);
  const double cap = section.number_or("cap", 1, positive);
  if (!capped && section.has("cap")) section.fail("cap", "goes with capped = true");
  return capped ? cap : std::numeric_limits<double>::infinity();
}

ManifoldRetraction retraction(const Section& section) {
  const std::vector<ManifoldRetraction> all{ManifoldRetraction::qr, ManifoldRetraction::polar,
                                            ManifoldRetraction::exponential, ManifoldRetraction::orthographic,
                                            ManifoldRetraction::cayley};
  std::vector<std::string> names;
  for (const ManifoldRetraction each : all) names.emplace_back(to_string(each));
  const std::string name = section.choice_or("retraction", names.front(), names);
  return all[std::size_t(std::find(names.begin(), names.end(), name) - names.begin())];
}

MadeMethod read_robust(const Section& section) {
  const AcceleratedOptions options = accelerated(section, "robust", true);
  const RobustOptions robust{.c = section.number_or("c", options.look_ahead ? 1 : 2, positive),
                             .power = section.number_or("power", 18, positive),
                             .lipschitz = section.number_or("lipschitz", 0, nonnegative)};
  return std::make_unique<RobustDescent>(robust, options);
}

MadeMethod read_hamiltonian(const Section& section, Bregman::Kind kind, const char* name) {
  Bregman bregman{.kind = kind};
  bregman.p = section.number_or("p", bregman.p, positive);
  if (kind == Bregman::Kind::adaptive) bregman.po = section.number_or("po", bregman.po, positive);
  bregman.c = section.number_or("C", bregman.c, positive);
  bregman.lambda = section.number_or("lambda", bregman.lambda, positive);
  const HamiltonianOptions options{.bregman = bregman,
                                   .h = section.number_or("h", 1e-3, positive),
                                   .start_time = section.number_or("start_time", 0.1, positive),
                                   .cap = cap(section)};
  return std::make_unique<HamiltonianDescent>(options, accelerated(section, name, false));
}
MadeMethod read_adaptive(const Section& section) {
  return read_hamiltonian(section, Bregman::Kind::adaptive, "adaptive");
}
MadeMethod read_direct(const Section& section) { return read_hamiltonian(section, Bregman::Kind::direct, "direct"); }

MadeMethod read_euler_lagrange(const Section& section) {
  EulerLagrangeOptions options;
  options.p = section.number_or("p", options.p, positive);
  options.c = section.number_or("C", options.c, positive);
  options.h = section.number_or("h", options.h, positive);
  options.lambda = section.number_or("lambda", options.lambda, positive);
  options.version = int(section.integer_or("version", 1, 1, 2));
  options.cap = cap(section);
  options.retraction = retraction(section);
  return std::make_unique<EulerLagrange>(options);
}

MadeMethod read_descent(const Section& section) {
  GradientDescentOptions options;
  options.step = section.number_or("step", 0, nonnegative);
  options.c = section.number_or("c", 0, nonnegative);
  options.retraction = retraction(section);
  return std::make_unique<GradientDescent>(options);
}

MadeMethod read_conjugate(const Section& section) { return std::make_unique<ConjugateGradient>(retraction(section)); }

MadeMethod read_trust_region(const Section& section) {
  TrustRegionOptions options;
  options.retraction = retraction(section);
  options.first_radius = section.number_or("first_radius", 0, nonnegative);
  options.largest_radius = section.number_or("largest_radius", 0, nonnegative);
  return std::make_unique<TrustRegion>(options);
}

const ListedParameter constraint_key{"constraint", "", "multipliers", "multipliers, projection or penalty"};
const ListedParameter penalty_key{"penalty", "", "1e4", "the weight, with constraint = \"penalty\""};
const ListedParameter rescale_key{"rescale", "", "false", "shorten a step that leads off the manifold"};
const ListedParameter restart_key{"restart", "", "false", "forget the momentum after a step that went uphill"};
const ListedParameter ahead_key{"look_ahead", "", "false", "the gradient where the momentum alone would lead"};
const ListedParameter retraction_key{"retraction", "", "qr", "qr, polar, exponential, orthographic or cayley"};
const ListedParameter cap_key{"cap", "1/L", "1", "upper bound of the gradient's share s, L the Lipschitz constant"};
const ListedParameter capped_key{"capped", "", "true",
                                 "false: as in the paper's uncapped runs, which lose convergence"};

std::vector<ListedParameter> hamiltonian_keys(bool adaptive) {
  std::vector<ListedParameter> out{{"p", "", "6", "rate O(t^-p)"}};
  if (adaptive) out.push_back({"po", "", "2", "p-ring, of the adaptive time"});
  out.insert(out.end(), {{"C", "", "1", "the factor of f in the Hamiltonian"},
                         {"h", "", "1e-3", "the step"},
                         {"start_time", "", "0.1", "t of the first step"},
                         {"lambda", "", "1", "zeta / alpha of (5.1), at least 1"},
                         cap_key,
                         capped_key,
                         constraint_key,
                         penalty_key,
                         rescale_key,
                         restart_key,
                         ahead_key});
  return out;
}

const OptimiserEntry& named(const Section& method) {
  std::vector<std::string> names;
  for (const auto& entry : optimisers()) names.emplace_back(entry.name);
  const std::string name = method.choice_or("name", names.front(), names);
  return *std::find_if(optimisers().begin(), optimisers().end(), [&](const auto& e) { return e.name == name; });
}

}  // namespace

std::optional<double> read_penalty(const Section& method) {
  const auto& keys = named(method).keys;
  if (std::none_of(keys.begin(), keys.end(), [](const ListedParameter& key) { return key.name == penalty_key.name; }))
    return std::nullopt;
  const double weight = method.number_or("penalty", 1e4, positive);
  const bool penalises =
      method.choice_or("constraint", "multipliers", {"multipliers", "projection", "penalty"}) == "penalty";
  if (!penalises && method.has("penalty")) method.fail("penalty", "goes with constraint = \"penalty\"");
  return penalises ? std::optional(weight) : std::nullopt;
}

std::span<const OptimiserEntry> optimisers() {
  static const std::vector<OptimiserEntry> all{
      {"robust",
       "our setting of the adaptive Hamiltonian: constant s = c / L, mu = (j / (j + 1))^(power + 1)",
       {{"c", "", "2", "below 4; with look_ahead below 4/3, default 1"},
        {"power", "", "18", "effective p"},
        {"lipschitz", "", "", "L; found where it is not given"},
        constraint_key,
        penalty_key,
        {"rescale", "", "true", "shorten a step that leads off the manifold"},
        restart_key,
        ahead_key},
       read_robust},
      {"adaptive", "Algorithm 1 with the adaptive Bregman Hamiltonian (5.3)", hamiltonian_keys(true), read_adaptive},
      {"direct", "Algorithm 1 with the direct Bregman Hamiltonian (5.2)", hamiltonian_keys(false), read_direct},
      {"euler-lagrange",
       "Algorithm 2: semi-implicit Euler for the Bregman Euler-Lagrange equations",
       {{"version", "", "1", "2: the gradient where the momentum alone would lead"},
        {"p", "", "6", "rate O(t^-p)"},
        {"C", "", "1", "the factor of f in the Lagrangian"},
        {"h", "", "1e-3", "the step"},
        {"lambda", "", "1", "zeta / alpha of (5.1), at least 1"},
        cap_key,
        capped_key,
        retraction_key},
       read_euler_lagrange},
      {"gradient-descent",
       "Algorithm 3; by a line search unless it is given a step",
       {{"step", "", "", "the step"}, {"c", "", "", "the step in units of 1 / L"}, retraction_key},
       read_descent},
      {"conjugate-gradients",
       "Riemannian conjugate gradients of Hestenes and Stiefel",
       {retraction_key},
       read_conjugate},
      {"trust-region",
       "truncated conjugate gradients within a radius; needs Hessians times vectors, by differences of gradients where "
       "none are given",
       {{"first_radius", "", "", "an eighth of the largest"},
        {"largest_radius", "", "", "the square root of the dimension"},
        retraction_key},
       read_trust_region}};
  return all;
}

MadeMethod read_optimiser(const Section& method) {
  try {
    return named(method).read(method);
  } catch (const std::invalid_argument& error) {
    method.fail("", error.what());
  }
}

}  // namespace lagroid::app
