#include "learned_scene.hpp"

#include "../../reading/kinds.hpp"

#include <lagroid/solvers/learning/measures.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace lagroid::app {

namespace {

class LearnedSystem final : public SphereSystem {
 public:
  LearnedSystem(LearnedHamiltonian learned, std::filesystem::path file)
      : learned_(std::move(learned)), file_(std::move(file)) {}

  const LearnedHamiltonian& learned() const { return learned_; }

  std::string_view name() const override { return keys::learned_hamiltonian; }
  std::vector<SphereForm> forms() const override { return learned_forms; }
  Points in_form(const Points& z, SphereForm, SphereForm) const override { return z; }
  std::unique_ptr<SphereIntegrator> begin(const Points& start, const SphereIntegratorOptions& options) const override {
    return integrator_on_spheres(learning::IntegratedField(learned_.model->equations(learned_.parameters)), start,
                                 options);
  }

  std::vector<SphereQuantity> quantities() const override {
    return {{"learned energy", "energy", "1", Promise::bounded},
            {"vertical angular momentum", "Jz", "1", Promise::conserved}};
  }
  std::vector<Measured> measure(const Points& z, SphereForm) const override {
    const double energy = learned_.model->energy(learned_.parameters, z.reshaped());
    double size = 0;
    for (Eigen::Index i = 0; i < z.cols(); ++i) size += z.col(i).head<3>().norm() * z.col(i).tail<3>().norm();
    return {{energy, std::max(1.0, std::abs(energy))}, {learning::vertical_momentum(z.reshaped()), size}};
  }

  std::vector<double> from_files() const override { return {learned_.parameters.begin(), learned_.parameters.end()}; }
  std::vector<std::string> pinned() const override {
    return {fmt::format("parameters.model='{}'", std::filesystem::absolute(file_).string())};
  }

  // Neither is known: points are shown on unit spheres, one below the other.
  std::vector<double> rods() const override { return ones(); }
  std::vector<double> bobs() const override { return ones(); }

 private:
  std::vector<double> ones() const { return std::vector<double>(std::size_t(learned_.model->bodies()), 1.0); }

  LearnedHamiltonian learned_;
  std::filesystem::path file_;
};

}  // namespace

std::unique_ptr<SphereSystem> read_learned_hamiltonian(const Section& scene) {
  const Section parameters = scene.section("parameters", "which model");
  try {
    const std::string name = read_key(parameters, learned_model_key);
    std::filesystem::path file = std::filesystem::path(scene.file()).parent_path() / name;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) file = name;
    LearnedHamiltonian learned = read_model(file);
    if (learned.model->bodies() == 0)
      throw ModelError(
          fmt::format("{}: a model on {}, no spheres; run the learned.toml that lagroid learn left beside it",
                      file.string(), to_string(learned.model->space())));
    return system_of(std::move(learned), file);
  } catch (const ModelError& error) {
    parameters.fail("model", error.what());
  }
}

std::unique_ptr<SphereSystem> system_of(LearnedHamiltonian learned, std::filesystem::path file) {
  return std::make_unique<LearnedSystem>(std::move(learned), std::move(file));
}

const LearnedHamiltonian* learned_of(const SphereSystem& system) {
  const auto* of = dynamic_cast<const LearnedSystem*>(&system);
  return of == nullptr ? nullptr : &of->learned();
}

}  // namespace lagroid::app
