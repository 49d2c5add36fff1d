// Tables of derivatives of a system that reads one of its numbers as a plain one: that is left out, and told.
#include "gradient/subject_of_run.hpp"

#include <gradient/gradient_table.hpp>
#include <gradient/uncertainty.hpp>

#include <lagroid/core/parameter.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace lagroid::app::gradient_tables_tests {
namespace {

/// A bob on a spring, with a weight that is a plain number.
struct Bob : MechanicalSystem<Bob, 1> {
  double stiffness = 3;
  Vector<double, 2> weights{0.5, 0.2};
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const {
    return q(0) * q(0) * (varied<S>(stiffness) * 0.5) + q(0) * (weights(0) + weights(1));
  }
  static auto parameters() {
    return std::tuple(parameter("stiffness", &Bob::stiffness, "N/m", "of the spring", positive),
                      parameter("weights", &Bob::weights, "N", "of the bob and of its hook"));
  }
};

GradientSubject subject_of_bob() {
  Bob bob;
  bob.h = 0.1;
  return subject_of_run<1>("bob", bob, {Vector<double, 1>(0.3), Vector<double, 1>(0.1)}, 20,
                           {{"position", "q"}, {"momentum", "p"}});
}

/// What is said of words that are refused.
std::string refusal_of(const GradientSubject& subject, const std::vector<std::string>& by) {
  try {
    differentiate(subject, {"final"}, by, /*check=*/false);
  } catch (const GradientRefused& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(GradientTables, LeaveOutWhatCarriesNoDerivativeAndSayWhy) {
  GradientSubject subject = subject_of_bob();
  EXPECT_THROW(differentiate(subject, {"final"}, {"initial", "parameters"}, false), WithoutDerivative);
  find_refused(subject);
  const GradientTable table = differentiate(subject, {"final"}, {"initial", "parameters"}, true);
  EXPECT_TRUE(table.failure.empty()) << table.failure;
  EXPECT_EQ(table.columns, (std::vector<std::string>{"initial.q", "initial.p", "parameters.stiffness"}));
  EXPECT_GT(table.digits_agreed, 8);
  ASSERT_EQ(table.notes.size(), 1u);
  EXPECT_EQ(
      table.notes[0].find("parameters.weights.0, parameters.weights.1 are left out; parameters.weights.0: parameter "
                          "weights.0 carries no derivative"),
      0u)
      << table.notes[0];
  EXPECT_NE(text_of(table).find("note: " + table.notes[0] + "\n"), std::string::npos);
  EXPECT_NE(json_of(table).find("are left out"), std::string::npos);
  // Nothing was asked of them.
  EXPECT_TRUE(differentiate(subject, {"final"}, {"initial"}, false).notes.empty());
  EXPECT_EQ(independent_errors(subject, {"parameters=0.1"}).notes.size(), 1u);
}

TEST(GradientTables, SayEachReasonOfWhatIsLeftOut) {
  GradientSubject subject = subject_of_bob();
  find_refused(subject);
  subject.refused.emplace_back("parameters.colour", "it is known");
  subject.refused.emplace_back("parameters.shade", "shade is known (as 1)");
  subject.refused.emplace_back("parameters.n", "n is known (as 2)");  // a letter that is in other words, too
  GradientColumns columns;
  for (int i = 0; i < int(subject.refused.size()); ++i) columns.left_out.push_back(i);
  const std::vector<std::string> notes = notes_on_left_out(subject, columns);
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_NE(notes[0].find("weights.1 are left out; parameters.weights.0: parameter weights.0"), std::string::npos);
  EXPECT_EQ(notes[1], "parameters.colour is left out: it is known");
  EXPECT_EQ(notes[2], "parameters.shade, parameters.n are left out; parameters.shade: shade is known (as 1)");
}

TEST(GradientTables, RefuseWhatIsNamedAndCarriesNoDerivative) {
  GradientSubject subject = subject_of_bob();
  find_refused(subject);
  for (const char* word : {"parameters.weights", "parameters.weights.0"})
    EXPECT_EQ(refusal_of(subject, {"initial", word}).find("parameters.weights.0: parameter weights.0 carries no"), 0u)
        << word;
  EXPECT_NE(refusal_of(subject, {"parameters.colour"}).find("nothing of that name"), std::string::npos);
  // A table of nothing is none.
  subject.refused.emplace_back("parameters.stiffness", "it is known");
  EXPECT_NE(refusal_of(subject, {"parameters"}).find("are left out"), std::string::npos);
}

}  // namespace
}  // namespace lagroid::app::gradient_tables_tests
