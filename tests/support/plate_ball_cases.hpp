#pragma once
/// Access to tests/data/plate-ball.json.

#include <lagroid/systems/control/plate_ball.hpp>

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>
#include <string>

namespace lagroid::cases {

using nlohmann::json;

inline json find(const std::string& id) {
  std::ifstream file(LAGROID_TEST_DATA "/plate-ball.json");
  const json all = json::parse(file);
  for (const auto& c : all.at("cases"))
    if (c.at("id") == id) return c;
  throw std::out_of_range("no case " + id);
}

/// Numbers are decimal strings of twenty digits, or plain numbers.
inline double number(const json& x) { return x.is_string() ? std::stod(x.get<std::string>()) : x.get<double>(); }

template <int N> Vector<double, N> vector(const json& x) {
  Vector<double, N> v;
  for (int i = 0; i < N; ++i) v(i) = number(x.at(i));
  return v;
}

inline Matrix<double, 3, 3> matrix(const json& x) {
  Matrix<double, 3, 3> m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = number(x.at(i).at(j));
  return m;
}

inline PlateBall system(const json& c, const std::string& form) {
  PlateBall s;
  s.radius = c.at("r");
  s.plate_rate = c.at("Omega");
  s.spin = c.at("c");
  s.h = c.at("h");
  s.rotation = form == "trace" ? RotationForm::trace : form == "exp" ? RotationForm::exponential : RotationForm::cayley;
  return s;
}

}  // namespace lagroid::cases
