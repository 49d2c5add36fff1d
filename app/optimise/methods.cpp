#include "methods.hpp"

#include <lagroid/solvers/optimisation/methods/accelerated.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace lagroid::app {

namespace {

using namespace optimisation;
using MadeMethod = std::unique_ptr<DescentMethod>;

const std::string projection = "projection";
const std::string penalty = "penalty";
const std::string geodesics = "geodesics";
const KeyOf<OneOf> constraint_key{"constraint",
                                  {{"multipliers", projection, geodesics, penalty}},
                                  "",
                                  "how the point is kept on the manifold",
                                  "multipliers"};
const KeyOf<Number> penalty_key{"penalty", {positive}, "", "the weight, with constraint = \"penalty\"", 1e4};
KeyOf<Flag> rescale_key(bool usual) { return {"rescale", {}, "", "shorten a step that leads off the manifold", usual}; }
const KeyOf<Flag> restart_key{"restart", {}, "", "forget the momentum after a step that went uphill", false};
const KeyOf<Flag> ahead_key{"look_ahead", {}, "", "the gradient where the momentum alone would lead", false};
const KeyOf<Number> cap_key{
    "cap", {positive}, "1/L", "upper bound of the gradient's share s, L the Lipschitz constant", 1.0};
const KeyOf<Flag> capped_key{"capped", {}, "", "false: as in the paper's uncapped runs, which lose convergence", true};

const KeyOf<Number> robust_c{"c", {positive}, "", "below 4; with look_ahead below 4/3, default 1", RobustOptions{}.c};
const KeyOf<Number> power{"power", {positive}, "", "effective p", RobustOptions{}.power};
const KeyOf<Number> lipschitz{"lipschitz", {nonnegative}, "", "L", {}, "found"};

const KeyOf<Number> rate{"p", {positive}, "", "rate O(t^-p)", Bregman{}.p};
const KeyOf<Number> adaptive_rate{"po", {positive}, "", "p-ring, of the adaptive time", Bregman{}.po};
const KeyOf<Number> factor{"C", {positive}, "", "the factor of f", Bregman{}.c};
const KeyOf<Number> step{"h", {positive}, "", "the step", 1e-3};
const KeyOf<Number> start_time{"start_time", {positive}, "", "t of the first step", 0.1};
const KeyOf<Number> convexity{"lambda", {positive}, "", "zeta / alpha of (5.1), at least 1", {}, "zeta"};
const KeyOf<Number> diameter_key{"diameter", {positive},      "", "of a domain that holds start and minimum, for zeta",
                                 {},         "the manifold's"};
const KeyOf<Whole> version{"version", {1, 2}, "", "2: the gradient where the momentum alone would lead", 1};

const KeyOf<Number> descent_step{"step", {nonnegative}, "", "the step", {}, "a line search"};
const KeyOf<Number> descent_c{"c", {nonnegative}, "", "the step in units of 1 / L", {}, "a line search"};
const KeyOf<Number> first_radius{"first_radius", {nonnegative}, "", "of the region", {}, "an eighth of the largest"};
const KeyOf<Number> largest_radius{
    "largest_radius", {nonnegative}, "", "of the region", {}, "the square root of the dimension"};

constexpr std::array retractions{ManifoldRetraction::qr, ManifoldRetraction::polar, ManifoldRetraction::exponential,
                                 ManifoldRetraction::orthographic, ManifoldRetraction::cayley};
KeyOf<OneOf> retraction_key() {
  KeyOf<OneOf> key{"retraction", {}, "", "from tangents to the manifold", {}, "qr, or exponential where there is none"};
  for (const ManifoldRetraction each : retractions) key.value.words.emplace_back(to_string(each));
  return key;
}

std::optional<ManifoldRetraction> retraction(const Section& section) {
  const KeyOf<OneOf> key = retraction_key();
  if (!section.has(key.name)) return std::nullopt;
  const auto& names = key.value.words;
  return retractions[std::size_t(std::find(names.begin(), names.end(), read_key(section, key)) - names.begin())];
}

AcceleratedOptions accelerated(const Section& section, std::string name, bool rescale) {
  AcceleratedOptions out{.name = std::move(name)};
  // A penalty takes the place of the constraint before a method sees it.
  const std::string constraint = read_key(section, constraint_key);
  if (constraint == projection) out.constraint = Constraint::projection;
  if (constraint == geodesics) out.constraint = Constraint::geodesics;
  out.rescale = read_key(section, rescale_key(rescale));
  out.restart = read_key(section, restart_key);
  out.look_ahead = read_key(section, ahead_key);
  return out;
}

std::optional<double> lambda(const Section& section) {
  return section.has(convexity.name) ? std::optional(read_key(section, convexity)) : std::nullopt;
}

double cap(const Section& section) {
  const bool capped = read_key(section, capped_key);
  const double most = read_key(section, cap_key);
  if (!capped && section.has(cap_key.name)) section.fail(cap_key.name, "goes with capped = true");
  return capped ? most : std::numeric_limits<double>::infinity();
}

MadeMethod read_robust(const Section& section) {
  const AcceleratedOptions options = accelerated(section, "robust", true);
  const RobustOptions robust{.c = read_key_or(section, robust_c, options.look_ahead ? 1 : *robust_c.fallback),
                             .power = read_key(section, power),
                             .lipschitz = read_key_or(section, lipschitz, 0)};
  return std::make_unique<RobustDescent>(robust, options);
}

MadeMethod read_hamiltonian(const Section& section, Bregman::Kind kind, const char* name) {
  Bregman bregman{.kind = kind};
  bregman.p = read_key(section, rate);
  if (kind == Bregman::Kind::adaptive) bregman.po = read_key(section, adaptive_rate);
  bregman.c = read_key(section, factor);
  bregman.lambda = lambda(section);
  const HamiltonianOptions options{.bregman = bregman,
                                   .h = read_key(section, step),
                                   .start_time = read_key(section, start_time),
                                   .cap = cap(section),
                                   .diameter = read_key_or(section, diameter_key, 0)};
  return std::make_unique<HamiltonianDescent>(options, accelerated(section, name, false));
}
MadeMethod read_adaptive(const Section& section) {
  return read_hamiltonian(section, Bregman::Kind::adaptive, "adaptive");
}
MadeMethod read_direct(const Section& section) { return read_hamiltonian(section, Bregman::Kind::direct, "direct"); }

MadeMethod read_euler_lagrange(const Section& section) {
  EulerLagrangeOptions options;
  options.p = read_key(section, rate);
  options.c = read_key(section, factor);
  options.h = read_key(section, step);
  options.lambda = lambda(section);
  options.diameter = read_key_or(section, diameter_key, 0);
  options.version = int(read_key(section, version));
  options.cap = cap(section);
  options.retraction = retraction(section);
  return std::make_unique<EulerLagrange>(options);
}

MadeMethod read_descent(const Section& section) {
  GradientDescentOptions options;
  options.step = read_key_or(section, descent_step, 0);
  options.c = read_key_or(section, descent_c, 0);
  options.retraction = retraction(section);
  return std::make_unique<GradientDescent>(options);
}

MadeMethod read_conjugate(const Section& section) { return std::make_unique<ConjugateGradient>(retraction(section)); }

MadeMethod read_trust_region(const Section& section) {
  TrustRegionOptions options;
  options.retraction = retraction(section);
  options.first_radius = read_key_or(section, first_radius, 0);
  options.largest_radius = read_key_or(section, largest_radius, 0);
  return std::make_unique<TrustRegion>(options);
}

std::vector<Key> hamiltonian_keys(bool adaptive) {
  std::vector<Key> out{rate};
  if (adaptive) out.push_back(adaptive_rate);
  out.insert(out.end(), {factor, step, start_time, convexity, diameter_key, cap_key, capped_key, constraint_key,
                         penalty_key, rescale_key(false), restart_key, ahead_key});
  return out;
}

const OptimiserEntry& named(const Section& method) {
  const std::string name = read_key(method, optimiser_key());
  return *std::find_if(optimisers().begin(), optimisers().end(), [&](const auto& e) { return e.name == name; });
}

}  // namespace

std::optional<double> read_penalty(const Section& method) {
  const auto& keys = named(method).keys;
  if (std::none_of(keys.begin(), keys.end(), [](const Key& key) { return key.name == penalty_key.name; }))
    return std::nullopt;
  const double weight = read_key(method, penalty_key);
  const bool penalises = read_key(method, constraint_key) == penalty;
  if (!penalises && method.has(penalty_key.name)) method.fail(penalty_key.name, "goes with constraint = \"penalty\"");
  return penalises ? std::optional(weight) : std::nullopt;
}

KeyOf<OneOf> optimiser_key() {
  KeyOf<OneOf> key{"name", {}, "", "of the method", std::string(optimisers().front().name)};
  for (const auto& entry : optimisers()) key.value.words.emplace_back(entry.name);
  return key;
}

Table optimisers_table() {
  Table table;
  for (const auto& entry : optimisers()) {
    KeyOf<OneOf> name = optimiser_key();
    name.value.words = {std::string(entry.name)};
    if (*name.fallback != entry.name) name.fallback.reset();
    Table& kind = table.kinds.emplace_back(Table{{name}, {}, std::string(entry.summary)});
    kind.keys.insert(kind.keys.end(), entry.keys.begin(), entry.keys.end());
  }
  return table;
}

std::span<const OptimiserEntry> optimisers() {
  static const std::vector<OptimiserEntry> all{
      {"robust",
       "our setting of the adaptive Hamiltonian: constant s = c / L, mu = (j / (j + 1))^(power + 1)",
       {robust_c, power, lipschitz, constraint_key, penalty_key, rescale_key(true), restart_key, ahead_key},
       read_robust},
      {"adaptive", "Algorithm 1 with the adaptive Bregman Hamiltonian (5.3)", hamiltonian_keys(true), read_adaptive},
      {"direct", "Algorithm 1 with the direct Bregman Hamiltonian (5.2)", hamiltonian_keys(false), read_direct},
      {"euler-lagrange",
       "Algorithm 2: semi-implicit Euler for the Bregman Euler-Lagrange equations",
       {version, rate, factor, step, convexity, diameter_key, cap_key, capped_key, retraction_key()},
       read_euler_lagrange},
      {"gradient-descent",
       "Algorithm 3; by a line search unless it is given a step",
       {descent_step, descent_c, retraction_key()},
       read_descent},
      {"conjugate-gradients",
       "Riemannian conjugate gradients of Hestenes and Stiefel",
       {retraction_key()},
       read_conjugate},
      {"trust-region",
       "truncated conjugate gradients within a radius; needs Hessians times vectors, by differences of gradients where "
       "none are given",
       {first_radius, largest_radius, retraction_key()},
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
