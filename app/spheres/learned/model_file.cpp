#include "model_file.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace lagroid::app {

namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kind = "learned_hamiltonian";
constexpr int most_bodies = 1000;
constexpr int most_coordinates = 1000;
constexpr int most_units = 10000;

/// The whole numbers after the colon.
std::vector<int> sizes(std::string_view text) {
  std::vector<int> out;
  while (true) {
    int n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || n < 1 || n > most_units) return {};
    out.push_back(n);
    text.remove_prefix(std::size_t(end - text.data()));
    if (text.empty()) return out;
    if (!text.starts_with(',')) return {};
    text.remove_prefix(1);
  }
}

}  // namespace

std::unique_ptr<learning::Model> named_model(const std::string& name, const learning::StateSpace& space,
                                             learning::Dissipation dissipation) {
  const int bodies = space.bodies;
  const int coordinates = int(space.size / 2);
  const auto colon = name.find(':');
  const std::string form = name.substr(0, colon);
  const auto numbers = colon == name.npos ? std::vector<int>() : sizes(std::string_view(name).substr(colon + 1));
  try {
    if (form == "polynomial" && numbers.size() == 1)
      return bodies > 0 ? learning::polynomial_model(bodies, numbers.front(), dissipation)
                        : learning::polynomial_hamiltonian(coordinates, numbers.front(), dissipation);
    if (form == "network" && !numbers.empty())
      return bodies > 0 ? learning::network_model(bodies, numbers, dissipation)
                        : learning::network_hamiltonian(coordinates, numbers, dissipation);
  } catch (const std::invalid_argument& error) {
    throw ModelError(fmt::format("model {}: {}", name, error.what()));
  }
  throw ModelError(fmt::format(
      "model \"{}\" is none; give polynomial:DEGREE or network:UNITS, as in network:8 or network:8,8", name));
}

std::string model_text(const LearnedHamiltonian& learned) {
  nlohmann::ordered_json out;
  out["kind"] = kind;
  const learning::StateSpace space = learned.model->space();
  if (space.bodies > 0) {
    out["bodies"] = space.bodies;
  } else {
    out["coordinates"] = space.size / 2;
  }
  out["model"] = learned.model->name();
  if (learned.model->damped()) out["dissipation"] = true;
  out["parameters"] = std::vector<double>(learned.parameters.begin(), learned.parameters.end());
  return out.dump(2) + "\n";
}

LearnedHamiltonian read_model(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& problem) {
    throw ModelError(fmt::format("{}: {}; give a model.json that lagroid learn wrote", file.string(), problem));
  };
  const auto text = contents(file);
  if (!text) fail("there is no such file, or it cannot be read");
  const auto read = read_json(*text);
  if (!read || !read->is_object()) fail("no JSON object");
  const OrderedJson& json = *read;
  if (json.value("kind", OrderedJson()) != kind) fail(fmt::format("kind is not \"{}\"", kind));
  constexpr std::array known{"kind", "bodies", "coordinates", "model", "dissipation", "parameters"};
  for (const auto& [key, value] : json.items())
    if (std::find(known.begin(), known.end(), key) == known.end()) fail(fmt::format("nobody knows its key {}", key));
  const bool on_spheres = !json.contains("coordinates");
  if (!on_spheres && json.contains("bodies")) fail("it has both bodies and coordinates");
  const auto count = json.value(on_spheres ? "bodies" : "coordinates", OrderedJson());
  if (!count.is_number_integer() || count < 1 || count > (on_spheres ? most_bodies : most_coordinates))
    fail(on_spheres ? "bodies is no number of bodies" : "coordinates is no number of coordinates");
  const auto damped = json.value("dissipation", OrderedJson(false));
  if (!damped.is_boolean()) fail("dissipation is neither true nor false");
  const auto name = json.value("model", OrderedJson());
  if (!name.is_string()) fail("model is no name");
  LearnedHamiltonian out;
  try {
    out.model = named_model(
        name.get<std::string>(),
        on_spheres ? learning::cotangent_spheres(count.get<int>()) : learning::phase_space(count.get<int>()),
        damped.get<bool>() ? learning::Dissipation::rayleigh : learning::Dissipation::none);
  } catch (const ModelError& error) {
    throw ModelError(fmt::format("{}: {}", file.string(), error.what()));
  }
  const auto parameters = json.value("parameters", OrderedJson());
  if (!parameters.is_array() || Eigen::Index(parameters.size()) != out.model->size())
    fail(fmt::format("parameters are not the {} numbers of {} on {}", out.model->size(), out.model->name(),
                     to_string(out.model->space())));
  out.parameters.resize(out.model->size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].is_number()) fail(fmt::format("parameters[{}] is no number", i));
    out.parameters(Eigen::Index(i)) = parameters[i].get<double>();
  }
  if (!out.parameters.allFinite()) fail("its parameters are not finite");
  const Eigen::MatrixXd mass = out.model->mass(out.parameters);
  if (mass.size() > 0 && !(mass.allFinite() && mass.diagonal().minCoeff() > 0))
    fail("the mass matrix of its parameters is not finite and positive");
  return out;
}

}  // namespace lagroid::app
