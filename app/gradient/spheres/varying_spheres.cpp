#include "varying_spheres.hpp"
#include "../../spheres/learned/learned_scene.hpp"
#include "../../spheres/pendulum_chain.hpp"
#include "learned_derivatives.hpp"

#include <lagroid/core/capabilities/parameter_numbers.hpp>
#include <lagroid/systems/pendulums/chain_derivatives.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lagroid::app {

namespace {

using Chain = PendulumChain<Eigen::Dynamic>;

class VaryingChain final : public VaryingSpheres {
 public:
  /// `of_all`: lists that one number of the scene stands for.
  VaryingChain(Chain chain, std::vector<std::string> of_all) : chain_(std::move(chain)), of_all_(std::move(of_all)) {}

  std::vector<std::pair<std::string, double>> numbers() const override {
    std::vector<std::pair<std::string, double>> out;
    for_each_parameter_number(chain_, [&](const std::string& name, const double& number, const auto&) {
      const std::string named = name_of(name);
      if (out.empty() || out.back().first != named) out.emplace_back(named, number);
    });
    return out;
  }
  std::unique_ptr<SphereSystem> changed(const std::vector<Nudge>& nudges) const override {
    return system_of(with(nudges));
  }
  std::unique_ptr<SphereDerivatives> derivatives(const std::vector<Nudge>& nudges,
                                                 const SphereIntegratorOptions& options, SphereForm shown,
                                                 const std::vector<std::string>& parameters) const override {
    return make_chain_derivatives(with(nudges), options, shown, parameters);
  }

 private:
  /// As the scene has it: masses for masses.0 where one number stands for all.
  std::string name_of(const std::string& number) const {
    const std::string list = number.substr(0, number.find('.'));
    return std::find(of_all_.begin(), of_all_.end(), list) == of_all_.end() ? number : list;
  }
  Chain with(const std::vector<Nudge>& nudges) const {
    Chain other = chain_;
    for_each_parameter_number(other, [&](const std::string& name, double& number, const auto& declared) {
      for (const Nudge& nudge : nudges)
        if (nudge.parameter == name_of(name)) number += nudge.by;
      if (!declared.rule.holds(number))
        throw std::domain_error(fmt::format("{} is {:g}; it must be {}", name, number, declared.rule.words));
    });
    return {other.mass, other.length, other.gravity};
  }

  Chain chain_;
  std::vector<std::string> of_all_;
};

/// Numbers are model.0, model.1, ..., those of its file.
class VaryingModel final : public VaryingSpheres {
 public:
  explicit VaryingModel(LearnedHamiltonian learned) : learned_(std::move(learned)) {}

  std::vector<std::pair<std::string, double>> numbers() const override {
    std::vector<std::pair<std::string, double>> out;
    for (const double number : learned_.parameters) out.emplace_back(name_of(Eigen::Index(out.size())), number);
    return out;
  }
  std::unique_ptr<SphereSystem> changed(const std::vector<Nudge>& nudges) const override {
    return system_of(with(nudges), {});
  }
  std::unique_ptr<SphereDerivatives> derivatives(const std::vector<Nudge>& nudges,
                                                 const SphereIntegratorOptions& options, SphereForm,
                                                 const std::vector<std::string>& parameters) const override {
    std::vector<Eigen::Index> places;
    for (const std::string& name : parameters) places.push_back(place_of(name));
    return learned_derivatives(with(nudges), options, std::move(places));
  }

 private:
  static std::string name_of(Eigen::Index place) { return fmt::format("{}.{}", learned_model_key.name, place); }
  Eigen::Index place_of(const std::string& name) const {
    for (Eigen::Index i = 0; i < learned_.parameters.size(); ++i)
      if (name_of(i) == name) return i;
    throw std::invalid_argument(fmt::format("a learned Hamiltonian has no parameter {}", name));
  }
  LearnedHamiltonian with(const std::vector<Nudge>& nudges) const {
    LearnedHamiltonian other = learned_;
    for (const Nudge& nudge : nudges)
      if (!nudge.parameter.empty()) other.parameters(place_of(nudge.parameter)) += nudge.by;
    return other;
  }

  LearnedHamiltonian learned_;
};

}  // namespace

std::shared_ptr<const VaryingSpheres> varying_spheres(const SphereSystem& system, const Section& scene) {
  if (const LearnedHamiltonian* learned = learned_of(system)) return std::make_shared<VaryingModel>(*learned);
  const Section parameters = scene.section("parameters", "of the system");
  std::vector<std::string> of_all;
  for_each_parameter<Chain>([&](const auto& p) {
    if (parameters.is_number(p.name)) of_all.emplace_back(p.name);
  });
  return std::make_shared<VaryingChain>(*chain_of(system), std::move(of_all));
}

}  // namespace lagroid::app
