#pragma once
/// Chains and their recorded numbers.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::pendulum_chain_tests {

inline constexpr int any = Eigen::Dynamic;

using Chain = PendulumChain<any>;

using Points = Chain::Points;

using V = Vector<double, 3>;

using Json = nlohmann::json;

inline Json records() {
  Json out;
  std::ifstream(std::string(LAGROID_TEST_DATA) + "/pendulum-chains.json") >> out;
  return out;
}

inline Eigen::VectorXd numbers(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), Eigen::Index(v.size()));
}

inline Eigen::VectorXd list(const Json& array) { return numbers(array.get<std::vector<double>>()); }

struct Case {
  std::string name;
  Chain chain;
  double horizon, tolerance;
  Points velocities, momenta;          ///< at the start
  Points end_velocities, end_momenta;  ///< at the horizon
  double energy, vertical;

  explicit Case(const Json& record)
      : name(record.at("id")),
        chain(list(record.at("masses")), list(record.at("lengths")), record.at("g")),
        horizon(record.at("T")),
        tolerance(record.at("suggested_abs_tol")),
        velocities(points(record, "q0", "omega0")),
        momenta(points(record, "q0", "p0")),
        end_velocities(points(record, "qT", "omegaT")),
        end_momenta(points(record, "qT", "pT")),
        energy(record.at("E0")),
        vertical(record.at("Jz0")) {}

  static Points points(const Json& record, const char* q, const char* p) {
    Points z(6, record.at("k").get<int>());
    for (Eigen::Index i = 0; i < z.cols(); ++i) z.col(i) << list(record.at(q)[i]), list(record.at(p)[i]);
    return z;
  }
};

inline std::vector<Case> cases() {
  std::vector<Case> out;
  const Json all = records();
  for (const auto& record : all.at("cases")) out.emplace_back(record);
  return out;
}

inline Case named(const std::string& name) {
  for (auto& c : cases())
    if (c.name == name) return c;
  throw std::out_of_range(name);
}

/// Infinite where a number is none: comparisons pass over it.
inline double largest(const Points& difference) {
  return difference.allFinite() ? difference.cwiseAbs().maxCoeff() : std::numeric_limits<double>::infinity();
}

inline Points draw_state(int k) {
  Points z(6, k);
  for (auto column : z.colwise()) {
    for (double& x : column) x = laws::draw_uniform();
    column.head<3>().normalize();
    column.tail<3>() -= V(column.head<3>()) * column.head<3>().dot(column.tail<3>());
  }
  return z;
}

/// A light bob between the origin and a heavy one, on rods nearly in line.
inline Chain light_between() { return Chain(numbers({1e-8, 1}), numbers({1, 1}), 9.81); }

inline Points nearly_in_line() {
  Points z(6, 2);
  const auto direction = [](double theta, double phi) {
    return V(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  z.col(0) << direction(2.9, 0), V(0, 0.3, 0.1);
  z.col(1) << direction(2.9001, 0.3), V(0.1, 0.3, 0);
  light_between().space().project(z);
  return z;
}

}  // namespace lagroid::pendulum_chain_tests
