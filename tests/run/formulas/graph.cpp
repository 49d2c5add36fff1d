// Formulas as graphs: their values, their derivatives against dual numbers, and texts that are none.
#include <lagroid/run/expressions/formula_graph.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

using namespace lagroid;

namespace formulas_graph_tests {
namespace {

const std::vector<std::string> names{"x", "y", "x'"};

/// The value of a text at a point.
double value_at(const std::string& text, std::vector<double> at) {
  FormulaGraph graph;
  const FormulaProgram program(graph, {graph.read(text, names)});
  double out;
  std::vector<double> scratch;
  program.evaluate(at.data(), &out, scratch);
  return out;
}

/// The first and second derivatives of a text against those of its slopes' difference quotients, extrapolated.
void expect_derivatives(const std::string& text, const std::vector<double>& at) {
  FormulaGraph graph;
  const FormulaGraph::Node f = graph.read(text, names);
  std::vector<FormulaGraph::Node> wanted{f};
  for (std::size_t i = 0; i < 3; ++i) wanted.push_back(graph.derivative(f, i));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) wanted.push_back(graph.derivative(wanted[1 + i], j));
  const FormulaProgram program(graph, wanted);
  std::vector<double> scratch;
  const auto all = [&](std::vector<double> x) {
    std::vector<double> out(program.count());
    program.evaluate(x.data(), out.data(), scratch);
    return out;
  };
  const auto slope = [&](std::size_t of, std::size_t by) {
    const auto quotient = [&](double h) {
      std::vector<double> ahead = at, back = at;
      ahead[by] += h;
      back[by] -= h;
      return (all(ahead)[of] - all(back)[of]) / (2 * h);
    };
    return (4 * quotient(1e-3) - quotient(2e-3)) / 3;
  };
  const std::vector<double> found = all(at);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[1 + i], slope(0, i), 1e-8 * (1 + std::abs(found[1 + i]))) << text << " by " << names[i];
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(found[4 + 3 * i + j], slope(1 + i, j), 1e-8 * (1 + std::abs(found[4 + 3 * i + j])))
          << text << " by " << names[i] << ", " << names[j];
  }
}

TEST(Formulas, HaveTheirValues) {
  EXPECT_DOUBLE_EQ(value_at("x^2 + 3*y - -x'/2", {2, 0.5, 4}), 7.5);
  EXPECT_DOUBLE_EQ(value_at("2^3^2", {0, 0, 0}), 512);  // from the right, as in mathematics
  EXPECT_DOUBLE_EQ(value_at("-x^2", {3, 0, 0}), -9);
  EXPECT_DOUBLE_EQ(value_at("1 - 2 - 3", {0, 0, 0}), -4);
  EXPECT_DOUBLE_EQ(value_at("x*x'", {3, 0, 5}), 15);
  EXPECT_DOUBLE_EQ(value_at("1.5e-3*x + .5", {2, 0, 0}), 0.503);
  EXPECT_DOUBLE_EQ(value_at("atan2(y, x) + sqrt(x) + pi", {1, 1, 0}), std::atan2(1, 1) + 1 + std::numbers::pi);
}

TEST(Formulas, HaveTheirDerivatives) {
  const std::vector<double> at{0.4, 0.7, -0.3};
  for (const char* text :
       {"x*y*x' + x^3 - x'^2/2", "1/sqrt(x^2 + y^2)", "sin(x*y) + cos(x')*tan(x)", "asin(x) + acos(y) + atan(x*x')",
        "sinh(x) + cosh(y*x) + tanh(x')", "asinh(x) + acosh(1 + y) + atanh(x')", "exp(-x^2)*ln(y) + log(1 + x)",
        "x^y + y^-2 + (1 + x)^2.5", "abs(x')*x + atan2(y, x + x')", "x'^4 + x'^5 + (x + y)^0.5", "x/(y + x'^2)"})
    expect_derivatives(text, at);
}

TEST(Formulas, ShareWhatTheyHaveInCommon) {
  FormulaGraph graph;
  const auto twice = graph.read("sin(x + y)*sin(x + y)", names);
  EXPECT_EQ(graph.read("sin(x + y)^2", names), twice);
  EXPECT_TRUE(graph.is_zero(graph.derivative(graph.read("3*y + 2", names), 0)));
}

// Of derivatives a part may be no number where the formula is one, and then it is none where it is evaluated.
TEST(Formulas, DerivativesMayBeNoNumbers) {
  FormulaGraph graph;
  const auto power = graph.read("0^x", names);
  const FormulaProgram program(graph, {power, graph.derivative(power, 0)});
  const double at[] = {1, 0, 0};
  double out[2];
  std::vector<double> scratch;
  program.evaluate(at, out, scratch);
  EXPECT_EQ(out[0], 0);
  EXPECT_FALSE(std::isfinite(out[1]));
}

TEST(Formulas, ThatAreNoneAreRefusedInWords) {
  FormulaGraph graph;
  const auto refused = [&](const std::string& text) -> std::string {
    try {
      graph.read(text, names);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused("x + z"), "there is no \"z\"");
  EXPECT_EQ(refused("min(x, y)"), "there is no smooth function \"min\"");
  EXPECT_EQ(refused("x > 1 ? x : y"), "\"?\" makes it no smooth function");
  EXPECT_EQ(refused("x, y"), "it has several values");
  EXPECT_EQ(refused("x''"), "there is no \"x''\"");
  EXPECT_EQ(refused("2x"), "a number stands before \"x\" without *");
  EXPECT_EQ(refused("x + sqrt(-1)"), "a part of it is no finite number");
  for (const char* text : {"", "x +", "(x", "x y", "2 x", "x = 1", "sin", "x''", "1e", "x..y", "nan", "inf*x"})
    EXPECT_NE(refused(text), "") << text;
}

}  // namespace
}  // namespace formulas_graph_tests
