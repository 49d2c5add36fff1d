#pragma once
/// The sizes for which the library has compiled the algorithms of boundary values.
///
/// These serve every system of such sizes, a user's own included: n, the numbers of arrow and of object constraints,
/// and the room that the coordinates of an arrow need (coordinate_room). What other sizes need is compiled where it is
/// used. The lines here stand without `extern` in files that the build makes of boundary_size.cpp.in.

#include <lagroid/solvers/boundary/boundary_values.hpp>

#define LAGROID_BOUNDARY_SIZES(prefix, ...)                                                                          \
  prefix std::unique_ptr<BoundarySolver<SizedSystem<__VA_ARGS__>>> make_sized_boundary_solver(                       \
      BoundaryMethod, BoundaryOptions, StationaryKind);                                                              \
  prefix BoundarySolution<SizedSystem<__VA_ARGS__>> continue_to(                                                     \
      const BoundarySolver<SizedSystem<__VA_ARGS__>>&, const BoundaryStage<SizedSystem<__VA_ARGS__>>&,               \
      const BoundarySolution<SizedSystem<__VA_ARGS__>>&, const Path<SizedSystem<__VA_ARGS__>>&);                     \
  prefix HomotopyResult<SizedSystem<__VA_ARGS__>> follow(                                                            \
      const BoundarySolver<SizedSystem<__VA_ARGS__>>&,                                                               \
      const std::function<BoundaryStage<SizedSystem<__VA_ARGS__>>(double)>&,                                         \
      BoundarySolution<SizedSystem<__VA_ARGS__>>, const HomotopyOptions&);                                           \
  prefix MultistartResult<SizedSystem<__VA_ARGS__>> multistart(                                                      \
      const BoundarySolver<SizedSystem<__VA_ARGS__>>&, const std::vector<BoundaryStage<SizedSystem<__VA_ARGS__>>>&,  \
      int, const std::function<Path<SizedSystem<__VA_ARGS__>>(int)>&, const std::function<void(int)>&, int);         \
  prefix MultistartResult<SizedSystem<__VA_ARGS__>> solve_stages(                                                    \
      const BoundarySolver<SizedSystem<__VA_ARGS__>>&, const std::vector<BoundaryStage<SizedSystem<__VA_ARGS__>>>&,  \
      const MultistartOptions&);                                                                                     \
  prefix MultistartResult<SizedSystem<__VA_ARGS__>> solve_boundary(const BoundarySolver<SizedSystem<__VA_ARGS__>>&,  \
                                                                   const BoundaryProblem<SizedSystem<__VA_ARGS__>>&, \
                                                                   std::size_t, const MultistartOptions&)

#define LAGROID_COMPILED_SIZES(...)                                                           \
  template <> inline constexpr bool boundary_sizes_compiled<SizedSystem<__VA_ARGS__>> = true; \
  LAGROID_BOUNDARY_SIZES(extern template, __VA_ARGS__)

namespace lagroid::detail {

LAGROID_COMPILED_SIZES(1, 0, 0, 16);  // a pendulum
LAGROID_COMPILED_SIZES(2, 0, 0, 16);  // a point in the plane
LAGROID_COMPILED_SIZES(3, 0, 0, 16);  // rigid bodies, tops
LAGROID_COMPILED_SIZES(3, 0, 1, 16);  // a spherical pendulum
LAGROID_COMPILED_SIZES(3, 1, 0, 16);  // rotations with two controls
LAGROID_COMPILED_SIZES(3, 2, 0, 16);  // plane poses with one control
LAGROID_COMPILED_SIZES(5, 3, 0, 16);  // the plate-ball
LAGROID_COMPILED_SIZES(6, 0, 0, 16);  // bodies in space
LAGROID_COMPILED_SIZES(6, 0, 0, 32);  // rotations with rotors

}  // namespace lagroid::detail
