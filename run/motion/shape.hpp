#pragma once
/// What a run looks like in space: rigid shapes that move with the recorded columns.
///
///     Shape bob{"sphere", {0.05}};
///     bob.position = {"x", "y", 0.0};  // columns, or constants
///     bob.trail = true;

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lagroid {

/// A recorded column, by its label in the CSV, or a constant.
using Coordinate = std::variant<double, std::string>;

/// A turn about an axis through the body's position, by `rate` times the angle (rad).
struct Turn {
  std::array<double, 3> axis{0, 0, 1};
  Coordinate angle;
  double rate = 1;
};

/// A rigid shape that moves with the recorded columns; z points up, lengths in m.
struct Shape {
  /// sphere (radius), box (three sides), disk (radius, thickness; its axis is the third), rod (length, radius; along
  /// the third axis), cone (height, radius; its tip at the position, opening along the third axis), plate (nothing: as
  /// large as the rest of the picture).
  std::string kind;
  std::vector<double> size;
  std::vector<Coordinate> position{0.0, 0.0, 0.0};
  std::vector<std::string> attitude{};  ///< columns of a unit quaternion w, x, y, z; or none
  bool transposed = false;              ///< the attitude is the inverse
  std::vector<Turn> turns{};            ///< one after another, each in the body as turned by those before
  std::array<double, 3> offset{};       ///< of the shape's centre from the position, in the body
  std::vector<Coordinate> to{};         ///< a rod's other end: it reaches there from its position
  bool trail = false;                   ///< its centre draws a line
};

/// The columns of the attitude that every recorded run of a body has.
inline const std::vector<std::string> attitude_columns{"A_w", "A_x", "A_y", "A_z"};

/// A homogeneous box of these principal moments, its longest side 1.
Shape box_of(const std::array<double, 3>& inertia);

/// The homogeneous box of this mass and these principal moments about its centre.
Shape box_of_mass(double mass, const std::array<double, 3>& inertia);

/// The shape at the columns x, y and this height, turned about the vertical by `heading`.
Shape on_the_plane(Shape shape, double height);

/// A plate below the rest, turning at this rate.
Shape turning_plate(double rate);

/// A ball of this radius that stands on a plate at the columns x, y.
Shape ball_on_plate(double radius);

/// A massless rod that hangs from the origin by the angle in column `q`, and its bob.
std::vector<Shape> hanging(double length, std::string_view q);

}  // namespace lagroid
