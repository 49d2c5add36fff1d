#pragma once
/// By how much errors of a start grow along a run, whatever derivatives are asked for, in units of what is seen of it.
/// With C_g the largest that numbers of a group g (positions, momenta) are on the run, x_j the smallest change of
/// number j of the start that changes some group by its own size, and D what is observed by the start,
///
///     growth = max_i |D_i x| / C_g(i)  over the same at the start,
///
/// where i are rows of groups that are the state's own: energies and what else is computed of it have no unit of
/// theirs. Nor has a group that stays at rest, as momenta at an equilibrium: what it has is round-off of other groups,
/// and so it is where errors grow beyond all digits in its unit and its numbers at the first two nodes are no more than
/// round-off of the start makes of them in a step. Such groups are left out.
///
///     const RunGrowth growth(subject, sizes_of_run(subject));
///     const double factor = growth.factor(derivatives * growth.along());
///
/// Returns factors from one up, of the run and not of columns. Of starts of many numbers x is taken along a few
/// directions of random signs, always the same. Requires a subject that outlives it. Nothing throws but what the
/// subject does, and std::logic_error.

#include "../gradient_subject.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace lagroid::app {

/// The unit that a number shares with others: that of its group, and for a computed one its own.
std::string unit_of(const GradientName& name);

/// The largest number of each unit.
using SizesOfUnits = std::map<std::string, double>;
/// Throws std::logic_error for other numbers than the subject names.
void see(const GradientSubject& subject, const Eigen::VectorXd& observed, SizesOfUnits& sizes);
/// On the nodes of the run, few of which tell enough.
SizesOfUnits sizes_of_run(const GradientSubject& subject);

class RunGrowth {
 public:
  RunGrowth(const GradientSubject& subject, SizesOfUnits sizes);

  const SizesOfUnits& sizes() const { return sizes_; }
  /// Directions x, of the numbers of the start.
  const Eigen::MatrixXd& along() const { return along_; }
  /// The same of the states of a motion that begins with these parameters varying, and of these below, which stay.
  Eigen::MatrixXd directions(Eigen::Index states, const std::vector<int>& parameters = {}) const;
  /// Of what is observed, differentiated along these.
  double factor(const Eigen::MatrixXd& observed_along) const;

 private:
  using Units = std::set<std::string>;
  double largest(const Eigen::MatrixXd& observed_along, const Units& left_out) const;
  double factor(const Eigen::MatrixXd& observed_along, const Units& left_out) const;
  Units units_at_rest() const;

  const GradientSubject* subject_;
  std::vector<std::string> units_;  ///< of what is observed
  std::vector<bool> is_of_state_;
  SizesOfUnits sizes_;
  Eigen::MatrixXd along_;
  Eigen::MatrixXd at_start_;  ///< what is observed there, along these
};

}  // namespace lagroid::app
