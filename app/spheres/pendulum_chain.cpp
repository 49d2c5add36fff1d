#include "pendulum_chain.hpp"

#include "../reading/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace lagroid::app {

namespace {

using Chain = PendulumChain<Eigen::Dynamic>;

class ChainSystem final : public SphereSystem {
 public:
  explicit ChainSystem(Chain chain) : chain_(std::move(chain)) {}

  const Chain& chain() const { return chain_; }

  std::string_view name() const override { return keys::pendulum_chain; }
  std::vector<SphereForm> forms() const override { return pendulum_chain_forms; }
  Points in_form(const Points& z, SphereForm from, SphereForm to) const override {
    if (from == to) return z;
    return to == SphereForm::momenta ? chain_.to_momenta(z) : chain_.to_velocities(z);
  }
  std::unique_ptr<SphereIntegrator> begin(const Points& start, const SphereIntegratorOptions& options) const override {
    return make_chain_integrator(chain_, start, options);
  }

  std::vector<SphereQuantity> quantities() const override {
    return {{"energy", "energy", "J", Promise::bounded},
            {"vertical angular momentum", "Jz", "kg m^2/s", Promise::conserved}};
  }
  std::vector<Measured> measure(const Points& z, SphereForm form) const override {
    const Points at = in_form(z, form, SphereForm::velocities);
    const double kinetic = chain_.kinetic_energy(at);
    const double potential = chain_.potential_energy(at);
    return {{kinetic + potential, kinetic + std::abs(potential)},
            {chain_.vertical_momentum(at), chain_.momentum_size(at)}};
  }

  std::vector<double> rods() const override { return list(chain_.length); }
  std::vector<double> bobs() const override { return list(chain_.mass); }

 private:
  static std::vector<double> list(const Chain::Numbers& v) { return {v.data(), v.data() + v.size()}; }

  Chain chain_;
};

using Numbers = Chain::Numbers;

/// One number for each link, or one for all; empty in the latter case.
std::vector<double> read_each(const Section& parameters, const Parameter<Chain, Numbers>& p) {
  if (parameters.is_number(p.name)) {
    parameters.number(p.name, p.rule);
    return {};
  }
  auto each = parameters.list(p.name, fmt::format("{}, one for each link, or one number for all", p.name));
  for (const double x : each)
    if (!p.rule.holds(x)) parameters.fail(p.name, fmt::format("must be {}, got {}", p.rule.words, x));
  return each;
}

template <class P> inline constexpr bool is_for_each_link = std::is_same_v<P, const Parameter<Chain, Numbers>&>;

Chain one_link() { return {Numbers::Ones(1), Numbers::Ones(1)}; }

const KeyOf<Whole> links_key{"links", {1, 100'000},      "1", "how many, where neither masses nor lengths says it",
                             {},      "as many as these"};

}  // namespace

std::vector<Key> pendulum_chain_parameters() {
  std::vector<Key> all = parameter_keys(one_link());
  auto key = all.begin();
  for_each_parameter<Chain>([&](const auto& p) {
    if constexpr (is_for_each_link<decltype(p)>) key->value = {Either{{{Number{p.rule}}, {NumberList{p.rule}}}}};
    ++key;
  });
  all.push_back(links_key);
  return all;
}

std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene) {
  const Section parameters = scene.section("parameters", "masses and lengths of the chain");
  const long most = links_key.value.most;
  long links = read_key_or(parameters, links_key, 0);
  Chain given = one_link();
  for_each_parameter<Chain>([&](const auto& p) {
    if constexpr (is_for_each_link<decltype(p)>) {
      const std::vector<double> each = read_each(parameters, p);
      const auto count = long(each.size());
      if (links > 0 && count > 0 && count != links)
        parameters.fail(
            p.name,
            fmt::format("are {}, and the chain has {} links; give one for each, or one number for all", count, links));
      links = std::max(links, count);
      given.*p.member = Eigen::Map<const Numbers>(each.data(), count);
    } else {
      reading::read(parameters, p, given);
    }
  });
  if (links == 0) links = read_key(parameters, links_key);
  if (links > most) parameters.fail("masses", fmt::format("are of {} links; a chain has {} at most", links, most));
  for_each_parameter<Chain>([&](const auto& p) {
    if constexpr (is_for_each_link<decltype(p)>)
      if ((given.*p.member).size() == 0) given.*p.member = Numbers::Constant(links, parameters.number(p.name, p.rule));
  });
  return system_of({given.mass, given.length, given.gravity});
}

std::unique_ptr<SphereSystem> system_of(Chain chain) { return std::make_unique<ChainSystem>(std::move(chain)); }

const Chain* chain_of(const SphereSystem& system) {
  const auto* of_chain = dynamic_cast<const ChainSystem*>(&system);
  return of_chain == nullptr ? nullptr : &of_chain->chain();
}

}  // namespace lagroid::app
