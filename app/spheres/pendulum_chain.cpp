#include "pendulum_chain.hpp"

#include <lagroid/systems/pendulum_chain.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::app {

namespace {

using Chain = PendulumChain<Eigen::Dynamic>;

class ChainSystem final : public SphereSystem {
 public:
  explicit ChainSystem(Chain chain) : chain_(std::move(chain)) {}

  std::string_view name() const override { return "pendulum_chain"; }
  std::vector<SphereForm> forms() const override { return {SphereForm::velocities, SphereForm::momenta}; }
  Points in_form(const Points& z, SphereForm from, SphereForm to) const override {
    if (from == to) return z;
    return to == SphereForm::momenta ? chain_.to_momenta(z) : chain_.to_velocities(z);
  }
  std::unique_ptr<SphereMarch> begin(const Points& start, const SphereMarchOptions& options) const override {
    return make_chain_march(chain_, start, options);
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

constexpr NumberRule usable{"positive, from 1e-300 to 1e300", [](double x) { return x >= 1e-300 && x <= 1e300; }};

/// One number for each link, or one for all; empty in the latter case.
std::vector<double> read_each(const Section& parameters, const char* key) {
  if (parameters.is_number(key)) {
    parameters.number(key, usable);
    return {};
  }
  auto each = parameters.list(key, fmt::format("{}, one for each link, or one number for all", key));
  for (const double x : each)
    if (!usable.holds(x)) parameters.fail(key, fmt::format("must be {}, got {}", usable.words, x));
  return each;
}

}  // namespace

std::unique_ptr<SphereSystem> read_pendulum_chain(const Section& scene) {
  const Section parameters = scene.section("parameters", "masses and lengths of the chain");
  constexpr long most = 100'000;
  long links = parameters.integer_or("links", 0, 1, most);
  const auto read = [&](const char* key) {
    auto each = read_each(parameters, key);
    if (links > 0 && !each.empty() && long(each.size()) != links)
      parameters.fail(key, fmt::format("are {}, and the chain has {} links; give one for each, or one number for all",
                                       each.size(), links));
    links = std::max(links, long(each.size()));
    return each;
  };
  auto masses = read("masses");
  auto lengths = read("lengths");
  if (links == 0) links = parameters.integer("links", 1, most);
  if (links > most) parameters.fail("masses", fmt::format("are of {} links; a chain has {} at most", links, most));
  const auto numbers = [&](const std::vector<double>& each, const char* key) -> Chain::Numbers {
    if (each.empty()) return Chain::Numbers::Constant(links, parameters.number(key, usable));
    return Eigen::Map<const Chain::Numbers>(each.data(), Eigen::Index(each.size()));
  };
  return std::make_unique<ChainSystem>(
      Chain(numbers(masses, "masses"), numbers(lengths, "lengths"), parameters.number_or("gravity", 9.81)));
}

}  // namespace lagroid::app
