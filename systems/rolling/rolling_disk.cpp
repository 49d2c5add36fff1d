#include <lagroid/systems/rolling/rolling_disk.hpp>

namespace lagroid {

double RollingDisk::energy(const State<GroupoidType>& s) const {
  const auto& mu = s.momentum;
  return 0.5 *
         (mu(0) * mu(0) / turning_inertia + mu.segment<2>(1).squaredNorm() / mass + mu(3) * mu(3) / rolling_inertia);
}

State<RollingDisk::GroupoidType> RollingDisk::reference(const State<GroupoidType>& start,
                                                        ArrowOf<GroupoidType>& configuration, double t) const {
  const Vector<double, 2> rate = velocities(start);
  const ArrowOf<GroupoidType> motion{SE2::exp(Vector<double, 3>(t * rate(0), t * radius * rate(1), 0)),
                                     SO2::exp(Vector<double, 1>(t * rate(1)))};
  configuration = groupoid.project(groupoid.compose(configuration, motion));
  return start;
}

std::vector<Symmetry<RollingDisk>> RollingDisk::sections() const {
  using Fibre = AlgebroidVector<GroupoidType>;
  return {{"turning", [](const ObjectOf<GroupoidType>&) { return Fibre(1, 0, 0, 0); }},
          {"rolling", [r = radius](const ObjectOf<GroupoidType>&) { return Fibre(0, r, 0, 1); }}};
}

std::vector<Quantity<RollingDisk>> RollingDisk::quantities() const {
  std::vector<Quantity<RollingDisk>> all{
      {"energy",
       {"E"},
       Promise::conserved,
       false,
       [system = *this](const TrajectoryPoint<RollingDisk>& p, double* out) { *out = system.energy(p.state); }}};
  for (const auto& section : sections()) all.push_back(momentum_balance(*this, section));
  return all;
}

}  // namespace lagroid
