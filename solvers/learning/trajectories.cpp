#include <lagroid/solvers/learning/trajectories.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace lagroid::learning {

namespace {

/// What a text file with seven digits leaves.
constexpr double written = 1e-6;
/// Times, of the interval: what a text file leaves of them.
constexpr double even = 1e-6;
constexpr double round_off = 8 * std::numeric_limits<double>::epsilon();
/// Numbers whose squares, and sums of them, are numbers too.
constexpr double largest_number = 1e100;
/// Of the noise: beyond so many times its size is a mistake.
constexpr double spread = 6;

std::string place(const Observation& row) {
  return fmt::format("row {} (trajectory {}, t = {:g})", row.row, row.trajectory, row.time);
}

/// The name of the i-th number of a state.
std::string component(const StateSpace& space, Eigen::Index i) {
  if (space.bodies > 0) return fmt::format("{}_{}", i % 6 < 3 ? 'q' : 'p', i / 6 + 1);
  const Eigen::Index n = space.size / 2;
  return fmt::format("{}_{}", i < n ? 'q' : 'p', i % n + 1);
}

void require_on_spheres(const Observation& row, double allowed) {
  for (Eigen::Index i = 0; i < row.z.size(); i += 6) {
    const Eigen::Vector3d q = row.z.segment<3>(i);
    const Eigen::Vector3d p = row.z.segment<3>(i + 3);
    const double off = std::abs(q.norm() - 1);
    if (!(off <= allowed))
      throw DataRefused(
          fmt::format("{}: q_{} is off the unit sphere by {:.1e}; give unit vectors, or the size of the "
                      "noise",
                      place(row), i / 6 + 1, off));
    const double along = std::abs(q.dot(p));
    if (!(along <= allowed * (1 + p.norm())))
      throw DataRefused(
          fmt::format("{}: p_{} has a part {:.1e} along q_{}; give tangent momenta, or the size of the "
                      "noise",
                      place(row), i / 6 + 1, along, i / 6 + 1));
  }
}

void require_on_space(const Observation& row, const StateSpace& space, double allowed) {
  Eigen::VectorXd nearest = row.z;
  space.project(nearest);
  if (!nearest.allFinite())
    throw DataRefused(
        fmt::format("{}: the constraint has no full rank there; give states where its derivative has", place(row)));
  const Eigen::Index n = space.size / 2;
  const Eigen::VectorXd off = (nearest - row.z).cwiseAbs();
  if (const double by = off.head(n).maxCoeff(); !(by <= allowed * (1 + row.z.head(n).norm())))
    throw DataRefused(
        fmt::format("{}: the state is off the constraints by {:.1e}; give states on them, or the size of the noise",
                    place(row), by));
  if (const double by = off.tail(n).maxCoeff(); !(by <= allowed * (1 + row.z.tail(n).norm())))
    throw DataRefused(
        fmt::format("{}: the momentum is off the tangent space of the constraints by {:.1e}; give tangent momenta, or "
                    "the size of the noise",
                    place(row), by));
}

void require_state(const Observation& row, const StateSpace& space, double noise) {
  for (Eigen::Index i = 0; i < row.z.size(); ++i)
    if (!std::isfinite(row.z(i)))
      throw DataRefused(
          fmt::format("{}: {} is {}; every number has to be finite", place(row), component(space, i), row.z(i)));
  if (!(row.z.cwiseAbs().maxCoeff() <= largest_number))
    throw DataRefused(
        fmt::format("{}: a number above {:g}; take units in which they are smaller", place(row), largest_number));
  if (!std::isfinite(row.time)) throw DataRefused(fmt::format("row {}: the time is not finite", row.row));
  if (!(row.weight >= 0) || !std::isfinite(row.weight))
    throw DataRefused(fmt::format("{}: weight {}; weights are zero or positive", place(row), row.weight));
  const double allowed = written + spread * noise;
  if (space.bodies > 0) {
    require_on_spheres(row, allowed);
  } else if (space.project) {
    require_on_space(row, space, allowed);
  }
}

}  // namespace

Trajectories Trajectories::part(Eigen::Index first, Eigen::Index number) const {
  return {bodies,
          points,
          interval,
          starts.middleCols(first, number),
          ends.middleCols(first, number),
          weights.middleCols(first, number),
          dimension};
}

Trajectories Trajectories::shuffled(unsigned seed) const {
  std::mt19937 generator(seed);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count()));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t left = order.size(); left > 1; --left) std::swap(order[left - 1], order[generator() % left]);
  return {bodies,   points, interval, starts(Eigen::all, order), ends(Eigen::all, order), weights(Eigen::all, order),
          dimension};
}

Trajectories assemble(std::span<const Observation> rows, double noise) {
  if (rows.empty()) return assemble(rows, StateSpace{}, noise);
  const Observation& first = rows.front();
  if (first.z.size() < 6 || first.z.size() % 6 != 0)
    throw DataRefused(
        fmt::format("row {}: {} numbers are no state; each body has q and p, six numbers", first.row, first.z.size()));
  return assemble(rows, cotangent_spheres(int(first.z.size() / 6)), noise);
}

Trajectories assemble(std::span<const Observation> rows, const StateSpace& space, double noise) {
  if (!(noise >= 0) || !std::isfinite(noise)) throw DataRefused("the size of the noise is zero or positive");
  if (rows.empty()) throw DataRefused("no rows; give one or more trajectories");
  const Eigen::Index width = space.size;
  if (rows.front().z.size() != width)
    throw DataRefused(fmt::format("row {}: {} numbers, a state of the space has {}; give it as many", rows.front().row,
                                  rows.front().z.size(), width));
  std::vector<std::size_t> begins;
  std::set<long> seen;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Observation& row = rows[r];
    if (row.z.size() != width)
      throw DataRefused(
          fmt::format("row {}: {} numbers, the first row has {}; make them equal", row.row, row.z.size(), width));
    require_state(row, space, noise);
    if (r > 0 && row.trajectory == rows[r - 1].trajectory) continue;
    if (!seen.insert(row.trajectory).second)
      throw DataRefused(
          fmt::format("{}: the trajectory began before, and another came between; keep its rows together", place(row)));
    begins.push_back(r);
  }
  begins.push_back(rows.size());

  const std::size_t points = begins[1];
  if (points < 2)
    throw DataRefused(
        fmt::format("{}: a trajectory of one point says nothing of the motion; give two or more", place(rows.front())));
  Trajectories out;
  out.bodies = space.bodies;
  out.dimension = space.dimension;
  out.points = int(points);
  out.interval = (rows[points - 1].time - rows[0].time) / double(points - 1);
  if (!(out.interval > 0))
    throw DataRefused(
        fmt::format("{}: the last time of the trajectory is not after its first", place(rows[points - 1])));
  const auto count = Eigen::Index(begins.size() - 1);
  const auto later = Eigen::Index(points - 1);
  out.starts.resize(width, count);
  out.ends.resize(width * later, count);
  out.weights.resize(later, count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const std::size_t begin = begins[std::size_t(n)];
    const std::size_t length = begins[std::size_t(n) + 1] - begin;
    if (length != points)
      throw DataRefused(fmt::format("{}: this trajectory has {} points, the first one {}; cut them to equal lengths",
                                    place(rows[begin + std::min(length, points) - 1]), length, points));
    for (std::size_t j = 0; j < points; ++j) {
      const Observation& row = rows[begin + j];
      const double expected = rows[begin].time + double(j) * out.interval;
      if (j > 0 && !(row.time > rows[begin + j - 1].time))
        throw DataRefused(
            fmt::format("{}: the time is not after that of the row before; put rows in the order of time", place(row)));
      if (!(std::abs(row.time - expected) <= even * out.interval + round_off * std::abs(row.time)))
        throw DataRefused(
            fmt::format("{}: equal intervals would have t = {:g} here; sample all trajectories at equal "
                        "intervals of {:g}",
                        place(row), expected, out.interval));
      if (j == 0) {
        out.starts.col(n) = row.z;
        if (space.project) space.project(out.starts.col(n));
      } else {
        out.ends.col(n).segment(Eigen::Index(j - 1) * width, width) = row.z;
        out.weights(Eigen::Index(j - 1), n) = row.weight;
      }
    }
    if (rows[begin].weight == 0 && out.weights.col(n).maxCoeff() > 0)
      throw DataRefused(
          fmt::format("{}: a trajectory, or a piece of one, begins at a point of weight zero, and first points are "
                      "taken for exact; cut it elsewhere, or give the point a weight",
                      place(rows[begin])));
  }
  const double largest = out.weights.maxCoeff();
  if (!(largest > 0)) throw DataRefused("all weights are zero; give some points a positive one");
  out.weights /= largest;  // their sum might overflow
  out.weights /= out.weights.mean();
  return out;
}

std::vector<Observation> pieces_of(std::span<const Observation> rows, int points) {
  if (points < 2) throw DataRefused("pieces of trajectories have two points or more");
  const auto length = std::size_t(points);
  std::vector<Observation> out;
  long piece = 0;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    while (end < rows.size() && rows[end].trajectory == rows[begin].trajectory) ++end;
    if (end - begin < length)
      throw DataRefused(fmt::format("{}: the trajectory has {} points, fewer than a piece of {}; cut shorter ones",
                                    place(rows[begin]), end - begin, points));
    for (std::size_t first = begin; first + length <= end; first += length - 1, ++piece)
      for (const Observation& row : rows.subspan(first, length)) {
        out.push_back(row);
        out.back().trajectory = piece;
      }
  }
  return out;
}

}  // namespace lagroid::learning
