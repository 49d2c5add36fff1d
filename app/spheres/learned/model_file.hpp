#pragma once
/// Learned Hamiltonians in files.

#include <lagroid/solvers/learning/model.hpp>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace lagroid::app {

/// What the file is called in the folder that `lagroid learn` leaves.
inline constexpr const char* model_file_name = "model.json";

/// A model that is none. The message is one line: which file, which key, what to do.
class ModelError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A model with its parameters.
struct LearnedHamiltonian {
  std::shared_ptr<const learning::Model> model;
  Eigen::VectorXd parameters;
};

/// "polynomial:2", of degree 2; "network:8", one layer of 8 units; "network:8,8", two: on (T*S^2)^k potentials, in R^2n
/// Hamiltonians of (q, p). Throws ModelError.
std::unique_ptr<learning::Model> named_model(const std::string& name, const learning::StateSpace& space,
                                             learning::Dissipation dissipation);

/// The text of model.json, every bit kept.
std::string model_text(const LearnedHamiltonian& learned);
/// Reads what `model_text` wrote. Throws ModelError.
LearnedHamiltonian read_model(const std::filesystem::path& file);

}  // namespace lagroid::app
