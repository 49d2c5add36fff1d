#pragma once
/// That steps of a system are the flow, whatever their length.

#include "../subjects.hpp"

namespace lagroid::subjects {

/// The end after `horizon`, of as many steps as are named, agrees to 1e-12 with the first numbers of the state and
/// attitude that are known.
template <class Sys>
void expect_flow(Sys system, const State<typename Sys::GroupoidType>& start, const Eigen::VectorXd& end, double horizon,
                 const std::vector<int>& counts) {
  for (const int steps : counts) {
    system.h = horizon / steps;
    auto run = make(system, start);
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(run.advance().converged()) << "step " << k << " of " << steps;
    EXPECT_LT((numbers(system, run.point()).head(end.size()) - end).norm(), 1e-12) << steps;
  }
}

}  // namespace lagroid::subjects
