// Training: how it ends, what it depends on, what data are refused.
#include "chains.hpp"

#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/network_potential.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::learning_tests::training_tests {
namespace {

TEST(Training, EndsAsItSays) {
  const Trajectories data = training_data(1, 50);
  const auto network = network_model(1, {8});
  const Trained few = train(*network, data, {.starts = 1, .iterations = 3});
  EXPECT_EQ(few.outcome, TrainingStatus::iteration_limit);
  EXPECT_NE(few.message.find("allow more"), std::string::npos);
  EXPECT_EQ(few.history.size(), 4U);
  EXPECT_NEAR(few.history.back().mse, few.mse, 1e-12 * few.mse);
  const Trained further = train(*network, data, {.iterations = 5, .begin = few.parameters});
  EXPECT_LT(further.mse, few.mse);
  EXPECT_NEAR(further.history.front().mse, few.mse, 1e-12 * few.mse);
  EXPECT_EQ(train(*network, data, {.iterations = 0, .begin = few.parameters}).parameters, few.parameters);
  EXPECT_THROW(train(*network, data, {.begin = VectorXd::Zero(3)}), std::invalid_argument);
  const Trained enough = train(*network, data, {.starts = 1, .enough = 1e-6});
  EXPECT_EQ(enough.outcome, TrainingStatus::reached);
  EXPECT_LE(enough.mse, 1e-6);
  const Trained late = train(*network, data, {.seconds = 0});
  EXPECT_EQ(late.outcome, TrainingStatus::time_limit);
  int seen = 0;
  const Trained stopped = train(*network, data, {.threads = 1, .callback = [&](const Stage&) { return ++seen < 6; }});
  EXPECT_EQ(stopped.outcome, TrainingStatus::interrupted);
  EXPECT_EQ(seen, 6);
  EXPECT_TRUE(stopped.usable());
  EXPECT_LT(stopped.mse, stopped.history.front().mse);
  // Starts that are tried at the same time end where they would alone.
  const Training tried{.starts = 5, .threads = 1, .trial = 4, .iterations = 3};
  Training together = tried;
  together.threads = 3;
  const Trained one = train(*network, data, tried);
  const Trained three = train(*network, data, together);
  EXPECT_EQ(one.parameters, three.parameters);
  EXPECT_EQ(one.start, three.start);
  ASSERT_EQ(one.history.size(), three.history.size());
  for (std::size_t i = 0; i < one.history.size(); ++i) {
    EXPECT_EQ(one.history[i].start, three.history[i].start);
    EXPECT_EQ(one.history[i].mse, three.history[i].mse);
  }
  const Trained small = train(*network, data.part(0, 2), {});
  EXPECT_EQ(small.outcome, TrainingStatus::too_little_data);
  EXPECT_FALSE(small.usable());
  EXPECT_NE(small.message.find("41 parameters"), std::string::npos) << small.message;
  // Steps so long that nothing is finite.
  Trajectories wild = data;
  wild.interval = 1e200;
  EXPECT_EQ(train(*network, wild, {}).outcome, TrainingStatus::not_finite);
  EXPECT_THROW(train(*network, data, {.substeps = 0}), std::invalid_argument);
  EXPECT_THROW(train(*network, training_data(2, 3), {}), std::invalid_argument);
}

TEST(Training, GivesTheSameBits) {
  const Trajectories data = training_data(1, 50);
  const auto model = network_model(1, {6});
  const Trained a = train(*model, data, {.iterations = 10});
  const Trained b = train(*model, data, {.iterations = 10});
  const Trained other = train(*model, data, {.seed = 9, .iterations = 10});
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_NE(a.parameters, other.parameters);
  EXPECT_EQ(training_data(1, 5).ends, training_data(1, 5).ends);
}

TEST(Training, FollowsWeights) {
  // The second half of the data is another chain's; its weights are zero.
  auto rows = draw_trajectories(unit_chain(1), {.count = 40, .seed = 3});
  auto others = draw_trajectories(Chain(VectorXd::Ones(1), VectorXd::Constant(1, 2), 3), {.count = 40, .seed = 4});
  for (Observation row : others) {
    row.trajectory += 40;
    row.row += long(rows.size());
    row.weight = 0;
    rows.push_back(row);
  }
  const auto model = polynomial_model(1, 1);
  const Trained weighted = train(*model, assemble(rows), {});
  EXPECT_LT(weighted.mse, 1e-20);
  for (Observation& row : rows) row.weight = 1;
  EXPECT_GT(train(*model, assemble(rows), {}).mse, 1e-5);
}

TEST(Training, TellsWhatCannotBeDifferentiated) {
  const Trajectories data = training_data(1, 50);
  const auto model = polynomial_model(1, 1);
  // A potential so steep that no prediction is finite.
  VectorXd theta = VectorXd::Zero(4);
  theta << 0, 1e300, 1e300, 1e300;
  const Trained wild = train(*model, data, {.begin = theta});
  EXPECT_EQ(wild.outcome, TrainingStatus::not_finite) << to_string(wild.outcome);
  EXPECT_NE(wild.message.find("go on from"), std::string::npos) << wild.message;
  EXPECT_FALSE(wild.usable());
  EXPECT_THROW(train(*model, data, {.damping_floor = 11}), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, std::vector<int>(23, 10000)), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {5000}), std::invalid_argument);
}

/// A potential whose derivative with respect to its parameter is not finite after a while.
struct Brittle {
  int size() const { return 1; }
  template <class S, class T> S energy(const Positions<S, 1>& q, const T* theta) const {
    using std::sqrt;
    return q(2) * sqrt(S(theta[0]) * S(theta[0]));
  }
};

TEST(Training, OfARootOfZeroIsNotFinite) {
  const ParametricModel<Brittle, 1> model("brittle", Brittle{});
  const Trained trained = train(model, training_data(1, 20), {.starts = 1});
  EXPECT_EQ(trained.outcome, TrainingStatus::not_finite) << to_string(trained.outcome);
  EXPECT_FALSE(trained.usable());
}

TEST(Training, DoesNotMindTheOrderOfTheData) {
  // Sorted by height, a consecutive part knows one side of the sphere only.
  auto rows = draw_trajectories(unit_chain(1), {.count = 100, .noise = 0.01});
  std::vector<std::size_t> begins;
  for (std::size_t r = 0; r < rows.size(); r += 5) begins.push_back(r);
  std::sort(begins.begin(), begins.end(), [&](auto a, auto b) { return rows[a].z(2) < rows[b].z(2); });
  std::vector<Observation> sorted;
  for (const std::size_t begin : begins)
    for (std::size_t j = 0; j < 5; ++j) sorted.push_back(rows[begin + j]);
  const Trajectories data = assemble(sorted, 0.01);
  const Trajectories part = data.shuffled(1).part(0, 20);
  EXPECT_LT(part.starts.row(2).minCoeff(), -0.5);
  EXPECT_GT(part.starts.row(2).maxCoeff(), 0.5);
  EXPECT_EQ(data.shuffled(1).starts, data.shuffled(1).starts);
  EXPECT_NE(data.shuffled(1).starts, data.shuffled(2).starts);
  const auto model = network_model(1, {4});
  const Trained trained = train(*model, data, {.iterations = 30, .validation = 0.2});
  EXPECT_LT(test_error(*model, trained, 1), 1e-3);
}

TEST(Training, DividesByTheWeightsOfThePart) {
  auto rows = draw_trajectories(unit_chain(1), {.count = 100, .noise = 0.01});
  for (Observation& row : rows) row.weight = row.trajectory % 3 == 0 ? 1e308 : 0;
  const auto model = polynomial_model(1, 1);
  const Trained trained = train(*model, assemble(rows, 0.01), {.validation = 0.3});
  const double variance = 1e-4 / 3;
  EXPECT_NEAR(trained.mse / variance, 1, 0.3);
  EXPECT_NEAR(trained.validation / variance, 1, 0.3);
  // One trajectory of weight is 16 free numbers, whatever stands beside it.
  for (Observation& row : rows) row.weight = row.trajectory == 1 ? 1 : 0;
  const Trained few = train(*polynomial_model(1, 3), assemble(rows, 0.01), {});
  EXPECT_EQ(few.outcome, TrainingStatus::too_little_data);
  EXPECT_NE(few.message.find("are 16 free numbers"), std::string::npos) << few.message;
  const Trained none = train(*model, assemble(rows, 0.01), {.validation = 0.01});
  EXPECT_EQ(none.outcome, TrainingStatus::too_little_data);
  EXPECT_NE(none.message.find("held out are zero"), std::string::npos) << none.message;
}

TEST(Training, IsStoppedWithinAnEvaluation) {
  const Trajectories data = training_data(1, 2000);
  const auto model = network_model(1, {4});
  int asked = 0;
  const Trained early = train(*model, data, {.stop = [&] { return ++asked > 2; }});
  EXPECT_EQ(early.outcome, TrainingStatus::interrupted);
  EXPECT_FALSE(early.usable());
  EXPECT_TRUE(early.history.empty());
  asked = 0;
  const Trained later = train(*model, data, {.starts = 1, .stop = [&] { return ++asked > 300; }});
  EXPECT_EQ(later.outcome, TrainingStatus::interrupted);
  ASSERT_TRUE(later.usable());
  EXPECT_EQ(later.mse, later.history.back().mse);
  EXPECT_EQ(train(*model, data, {.seconds = 0.001}).outcome, TrainingStatus::time_limit);
  EXPECT_FALSE(measure(*model, later.parameters, data, 1e-12, [] { return true; }).complete);
}

TEST(Training, SaysWhatTheDataDoNotDetermine) {
  // At rest below the point of support.
  std::vector<Observation> rows;
  for (long n = 1; n <= 20; ++n)
    for (int j = 0; j < 3; ++j) rows.push_back({long(rows.size()) + 1, n, 0.1 * j, VectorXd{{0, 0, -1, 0, 0, 0}}, 1});
  const auto model = polynomial_model(1, 1);
  const Trained rest = train(*model, assemble(rows), {});
  EXPECT_EQ(rest.outcome, TrainingStatus::converged) << to_string(rest.outcome);
  EXPECT_FALSE(rest.mass_determined);
  const Trained moving = train(*model, training_data(1, 50), {});
  EXPECT_TRUE(moving.mass_determined);
  EXPECT_TRUE(train(*network_model(2, {6}), training_data(2, 100), {.starts = 1, .iterations = 10}).mass_determined);
  // Measured only, as few data as one likes.
  const Trained measured = train(*model, training_data(1, 1).part(0, 1), {.iterations = 0, .begin = moving.parameters});
  EXPECT_EQ(train(*network_model(1, {8}), training_data(1, 1), {.iterations = 0, .begin = VectorXd::Zero(41)}).outcome,
            TrainingStatus::iteration_limit);
  EXPECT_LT(measured.mse, 1e-15);
}

/// What `put` says of these rows.
std::string refusal_by(const std::function<void()>& put) {
  try {
    put();
  } catch (const DataRefused& refused) {
    return refused.what();
  }
  return "taken";
}

std::string refusal(const std::vector<Observation>& rows, double noise = 0) {
  return refusal_by([&] { assemble(rows, noise); });
}
std::string refusal(const std::vector<Observation>& rows, const StateSpace& space) {
  return refusal_by([&] { assemble(rows, space); });
}

TEST(Data, IsRefusedWithTheRowNamed) {
  const auto good = draw_trajectories(unit_chain(2), {.count = 3, .points = 4, .duration = 0.3});
  EXPECT_EQ(refusal(good), "taken");
  using Change = std::function<void(std::vector<Observation>&)>;
  const std::vector<std::pair<Change, std::string>> cases{
      {[](auto& r) { r[5].z(7) = std::nan(""); }, "row 6 (trajectory 2, t = 0.1): q_2 is nan"},
      {[](auto& r) { r[5].z(3) = INFINITY; }, "row 6 (trajectory 2, t = 0.1): p_1 is inf"},
      {[](auto& r) { r[6].z.template segment<3>(6) *= 1.001; }, "row 7 (trajectory 2, t = 0.2): q_2 is off the unit"},
      {[](auto& r) { r[6].z.template segment<3>(9) += 0.001 * r[6].z.template segment<3>(6); }, "row 7"},
      {[](auto& r) { r.erase(r.begin() + 6); }, "this trajectory has 3 points, the first one 4"},
      {[](auto& r) { r.pop_back(); }, "row 11 (trajectory 3"},
      {[](auto& r) { r.resize(1); }, "row 1 (trajectory 1, t = 0): a trajectory of one point"},
      {[](auto& r) { r.clear(); }, "no rows"},
      {[](auto& r) { r[5].time += 0.01; }, "row 6 (trajectory 2, t = 0.11): equal intervals would have t = 0.1"},
      {[](auto& r) { r[5].time = r[4].time; }, "row 6 (trajectory 2, t = 0): the time is not after"},
      {[](auto& r) { r[7].time += 2e-6 * 0.1; }, "row 8 (trajectory 2, t = 0.3): equal intervals"},
      {[](auto& r) { r[5].z(3) = 1e101; }, "row 6 (trajectory 2, t = 0.1): a number above 1e+100"},
      {[](auto& r) { r[9].time = NAN; }, "row 10: the time is not finite"},
      {[](auto& r) { r[3].weight = -1; }, "row 4 (trajectory 1, t = 0.3): weight -1"},
      {[](auto& r) { r[3].z.conservativeResize(6); }, "row 4: 6 numbers, the first row has 12"},
      {[](auto& r) { r[0].z.conservativeResize(7); }, "row 1: 7 numbers are no state"},
      {[](auto& r) { std::swap(r[4], r[11]); }, "keep its rows together"},
      {[](auto& r) {
         for (auto& row : r) row.weight = 0;
       },
       "all weights are zero"},
      {[](auto& r) {
         for (auto& row : r) row.time = 0;
       },
       "row 4"}};
  for (const auto& [change, words] : cases) {
    auto rows = good;
    change(rows);
    EXPECT_NE(refusal(rows).find(words), std::string::npos) << refusal(rows) << "\n" << words;
  }
}

TEST(Data, WithNoiseIsTakenWhereItIsDeclared) {
  const auto noisy = draw_trajectories(unit_chain(2), {.count = 50, .noise = 0.01});
  EXPECT_NE(refusal(noisy).find("or the size of the noise"), std::string::npos);
  EXPECT_EQ(refusal(noisy, 0.01), "taken");
  EXPECT_NE(refusal(noisy, 1e-4), "taken");
  const Trajectories data = assemble(noisy, 0.01);
  for (Eigen::Index n = 0; n < data.count(); ++n) {
    VectorXd z = data.starts.col(n);
    put_on_spheres(z);
    EXPECT_LT((z - data.starts.col(n)).norm(), 1e-15);
  }
}

TEST(Pieces, BeginWhereTheOneBeforeEnds) {
  std::vector<Observation> rows;
  for (int j = 0; j < 8; ++j) rows.push_back({j, 5, 0.1 * j, VectorXd{{double(j), 0}}});
  const Trajectories data = assemble(pieces_of(rows, 3), phase_space(1));
  ASSERT_EQ(data.count(), 3);
  EXPECT_EQ(data.starts.row(0), Eigen::RowVector3d(0, 2, 4));
  EXPECT_EQ(data.ends.row(2), Eigen::RowVector3d(2, 4, 6));
  EXPECT_EQ(data.bodies, 0);
  EXPECT_THROW(pieces_of(rows, 9), DataRefused);
  EXPECT_THROW(pieces_of(rows, 1), DataRefused);
}

TEST(Pieces, DoNotBeginAtAPointOfWeightZero) {
  std::vector<Observation> rows;
  for (int j = 0; j < 7; ++j) rows.push_back({j + 1, 5, 0.1 * j, VectorXd{{double(j), 0}}});
  rows[3].weight = 0;
  EXPECT_EQ(assemble(pieces_of(rows, 3), phase_space(1)).weights.col(1)(0), 0);
  EXPECT_THROW(assemble(pieces_of(rows, 4), phase_space(1)), DataRefused);
  EXPECT_EQ(refusal(pieces_of(rows, 4), phase_space(1)).find("row 4 "), 0U);
  EXPECT_EQ(refusal(rows, phase_space(1)), "taken");
  rows[0].weight = 0;
  EXPECT_NE(refusal(rows, phase_space(1))
                .find("row 1 (trajectory 5, t = 0): a trajectory, or a piece of one, begins at "
                      "a point of weight zero"),
            std::string::npos);
}

}  // namespace
}  // namespace lagroid::learning_tests::training_tests
