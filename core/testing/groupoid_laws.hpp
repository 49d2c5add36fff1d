#pragma once
/// The groupoid axioms as a test suite that any groupoid runs by naming itself: units, inverses, associativity, sources
/// and targets of products, the retraction, the invariant fields, and whatever the groupoid supplies in place of a
/// default.
///
/// A wrong sign is found here, before a trajectory hides it.
///
///     EXPECT_TRUE(lagroid::laws::groupoid_laws<MyGroupoid>().holds());
///
/// Arrows are drawn as products of retractions of random algebroid vectors (zero, tiny, moderate, large) over random
/// objects. Requires RapidCheck and, where objects are not vectors of R^n, a `draw_object`. Returns a LawReport with
/// the worst defect of each law; an exception of the groupoid is recorded in it as a failure.
///
/// Source: [G] Def. 2.1, (1), (2), (3).

#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/core/testing/property.hpp>

#include <algorithm>

namespace lagroid::laws {

/// How large the samples are and how exact the laws must be.
struct GroupoidLawOptions {
  double large = 3.0;         ///< entries of the largest algebroid vectors; reduce where tau is only local
  double local = 1.0;         ///< bound on |v| below which tau_inverse(tau(v)) = v is required
  double tolerance = 1e-12;   ///< on relative defects of algebraic laws
  double derivative = 1e-11;  ///< on relative defects of laws between derivatives
};

namespace detail {

/// Of matrices of any size, so that each is no more than copied in the file that compares it.
inline double relative_defect(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) {
  if (x.size() == 0) return 0;
  if (!x.allFinite() || !y.allFinite()) return std::numeric_limits<double>::infinity();
  return (x - y).cwiseAbs().maxCoeff() / (1 + y.cwiseAbs().maxCoeff());
}

/// The same for differences that were taken between points with the coordinates z, and have the round-off of these.
inline double displacement_defect(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Eigen::MatrixXd& z) {
  return relative_defect(x, y) / (z.size() == 0 ? 1 : std::max(1.0, z.cwiseAbs().maxCoeff()));
}

}  // namespace detail

/// The laws of [G] Def. 2.1 (unit, inverse, associativity, source and target of products), of the retraction, and of
/// the invariant fields: [G] (1), (2), their invariance under translation, (3), and the closed-form translations.
template <Groupoid G, class DrawObject>
LawReport groupoid_laws(const G& groupoid, const DrawObject& draw_object, const GroupoidLawOptions& options = {}) {
  constexpr int n = G::dimension;
  using A = ArrowOf<G>;
  using V = Vector<double, n>;
  using detail::displacement_defect;
  using detail::relative_defect;

  const auto vector = [&] { return V(draw_vector<n>(options.large)); };
  const auto arrow_from = [&](const ObjectOf<G>& q) {
    const A g = groupoid.tau(q, vector());
    return groupoid.project(groupoid.multiply(g, groupoid.tau(groupoid.target(g), vector())));
  };
  const auto arrow = [&] { return arrow_from(draw_object()); };
  const auto arrows = [&](const A& x, const A& y) {
    return relative_defect(groupoid.coordinates_of_arrow(x), groupoid.coordinates_of_arrow(y));
  };
  const auto objects = [&](const ObjectOf<G>& x, const ObjectOf<G>& y) {
    return relative_defect(groupoid.coordinates_of_object(x), groupoid.coordinates_of_object(y));
  };

  LawReport report{G::name(), {}};
  const auto law = [&](const char* name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };

  law("units", options.tolerance, [&] {
    const A g = arrow();
    const auto q = groupoid.source(g);
    return worst({arrows(groupoid.compose(groupoid.unit(q), g), g),
                  arrows(groupoid.compose(g, groupoid.unit(groupoid.target(g))), g),
                  objects(groupoid.source(groupoid.unit(q)), q), objects(groupoid.target(groupoid.unit(q)), q)});
  });
  law("inverses", options.tolerance, [&] {
    const A g = arrow();
    const A i = groupoid.inverse(g);
    return worst({objects(groupoid.source(i), groupoid.target(g)), objects(groupoid.target(i), groupoid.source(g)),
                  arrows(groupoid.compose(g, i), groupoid.unit(groupoid.source(g))),
                  arrows(groupoid.compose(i, g), groupoid.unit(groupoid.target(g)))});
  });
  law("source and target of products", options.tolerance, [&] {
    const A g = arrow();
    const A h = arrow_from(groupoid.target(g));
    const A gh = groupoid.compose(g, h);
    return worst({objects(groupoid.source(gh), groupoid.source(g)), objects(groupoid.target(gh), groupoid.target(h))});
  });
  law("associativity", options.tolerance, [&] {
    const A g = arrow();
    const A h = arrow_from(groupoid.target(g));
    const A k = arrow_from(groupoid.target(h));
    return arrows(groupoid.compose(groupoid.compose(g, h), k), groupoid.compose(g, groupoid.compose(h, k)));
  });
  law("retraction", options.tolerance, [&] {
    const auto q = draw_object();
    V v = vector();
    const double size = v.norm();
    if (size > options.local) v *= options.local / size;
    const A g = groupoid.tau(q, v);
    return worst({arrows(groupoid.tau(q, V(V::Zero())), groupoid.unit(q)), objects(groupoid.source(g), q),
                  displacement_defect(groupoid.tau_inverse(g), v, groupoid.coordinates_of_arrow(g))});
  });
  law("left-invariant fields are alpha-vertical", options.derivative, [&] {
    const A g = arrow();
    const auto gd = groupoid.template cast<Dual<double>>(g);
    const auto moved = groupoid.multiply(gd, groupoid.tau(groupoid.target(gd), infinitesimal(vector())));
    double largest = 0;
    const auto q = groupoid.coordinates_of_object(groupoid.source(moved));
    for (int i = 0; i < q.size(); ++i) largest = worst({largest, std::abs(q(i).derivative)});
    return largest;
  });
  law("right-invariant fields are beta-vertical", options.derivative, [&] {
    const A g = arrow();
    const auto moved = groupoid.with_tangent(g, groupoid.right_invariant(g, vector()));
    double largest = 0;
    const auto q = groupoid.coordinates_of_object(groupoid.target(moved));
    for (int i = 0; i < q.size(); ++i) largest = worst({largest, std::abs(q(i).derivative)});
    return largest;
  });
  law("left-invariant fields are invariant (1)", options.derivative, [&] {
    const A g = arrow();
    const A h = arrow_from(groupoid.target(g));
    const V x = vector();
    using D = Dual<double>;
    // T l_g (X<-(h)): move h along the field, then translate.
    const auto hd = groupoid.with_tangent(h, groupoid.left_invariant(h, x));
    const auto gh = groupoid.coordinates_of_arrow(groupoid.multiply(groupoid.template cast<D>(g), hd));
    return relative_defect(derivative_of(gh), groupoid.left_invariant(groupoid.multiply(g, h), x));
  });
  law("right-invariant fields are invariant (2)", options.derivative, [&] {
    const A h = arrow();
    const A g = arrow_from(groupoid.target(h));
    const V x = vector();
    using D = Dual<double>;
    const auto hd = groupoid.with_tangent(h, groupoid.right_invariant(h, x));
    const auto hg = groupoid.coordinates_of_arrow(groupoid.multiply(hd, groupoid.template cast<D>(g)));
    return relative_defect(derivative_of(hg), groupoid.right_invariant(groupoid.multiply(h, g), x));
  });
  law("tangent of the inversion (3)", options.derivative, [&] {
    // T i (v) = -v + T(epsilon o beta)(v) for v in A_qG.
    const auto q = draw_object();
    const V x = vector();
    const auto v = groupoid.left_invariant(groupoid.unit(q), x);
    const auto curve = groupoid.with_tangent(groupoid.unit(q), v);
    const auto inverted = derivative_of(groupoid.coordinates_of_arrow(groupoid.inverse(curve)));
    const auto units = derivative_of(groupoid.coordinates_of_arrow(groupoid.unit(groupoid.target(curve))));
    return relative_defect(inverted, (units - v).eval());
  });
  law("closed-form translations", options.derivative, [&] {
    const A g = arrow();
    const auto defect = [&]<End First, End Second>() {
      using M = HyperDual<double, n, n>;
      using J = Jet<double, 2 * n>;
      const auto slow = groupoid.coordinates_of_arrow(groupoid.template seed_by_composition<M, First, Second, 0, 0>(g));
      const auto fast = groupoid.coordinates_of_arrow(groupoid.template seed<M, First, Second>(g));
      const auto first_order = groupoid.coordinates_of_arrow(groupoid.template seed<J, First, Second, 0, n>(g));
      double largest = 0;
      for (int i = 0; i < fast.size(); ++i)
        largest =
            worst({largest, std::abs(fast(i).value - slow(i).value), relative_defect(fast(i).left(), slow(i).left()),
                   relative_defect(fast(i).right(), slow(i).right()), relative_defect(fast(i).mixed(), slow(i).mixed()),
                   std::abs(first_order(i).value - slow(i).value),
                   relative_defect(first_order(i).gradient().template head<n>().eval(), slow(i).left()),
                   relative_defect(first_order(i).gradient().template tail<n>().eval(), slow(i).right())});
      return largest;
    };
    return worst({defect.template operator()<End::source, End::target>(),
                  defect.template operator()<End::target, End::source>(),
                  defect.template operator()<End::source, End::source>(),
                  defect.template operator()<End::target, End::target>()});
  });
  if constexpr (HasArrowFrame<G>) {
    law("arrow frame", options.derivative, [&] {
      // A random linear function of the arrow's coordinates, differentiated along the frame and along both ends.
      constexpr int d = arrow_dimension_of<G>();
      const A g = arrow();
      const auto framed = groupoid.coordinates_of_arrow(groupoid.template frame_jet<Jet<double, d>>(g));
      const auto ends = groupoid.coordinates_of_arrow(
          groupoid.template seed_by_composition<Jet<double, 2 * n>, End::source, End::target, 0, n>(g));
      Vector<double, d> along_frame = Vector<double, d>::Zero();
      Vector<double, 2 * n> along_ends = Vector<double, 2 * n>::Zero();
      for (int i = 0; i < framed.size(); ++i) {
        const double weight = vector()(0);
        along_frame += weight * framed(i).gradient();
        along_ends += weight * ends(i).gradient();
      }
      return worst({relative_defect(groupoid.template frame_to_end<End::source>(g, along_frame),
                                    along_ends.template head<n>().eval()),
                    relative_defect(groupoid.template frame_to_end<End::target>(g, along_frame),
                                    along_ends.template tail<n>().eval())});
    });
  }
  if constexpr (HasArrowFrame<G>) {
    law("arrow frame, second order", options.derivative, [&] {
      // The second derivatives of a random linear function of the arrow's coordinates, pushed from the frame to the
      // ends as in arrow_frame.hpp, against those by composition.
      constexpr int d = arrow_dimension_of<G>();
      using Hessian = Matrix<double, d, d>;
      using M = HyperDual<double, n, n>;
      const A g = arrow();
      const auto framed = groupoid.coordinates_of_arrow(groupoid.template frame_jet<SecondJet<double, d>>(g));
      Vector<double, Eigen::Dynamic> weights(framed.size());
      for (double& weight : weights) weight = vector()(0);
      Vector<double, d> gradient = Vector<double, d>::Zero();
      Hessian hessian = Hessian::Zero();
      for (int i = 0; i < framed.size(); ++i) {
        gradient += weights(i) * framed(i).gradient();
        hessian += weights(i) * framed(i).hessian();
      }
      const auto defect = [&]<End First, End Second>(const Hessian& form) {
        const auto ends =
            groupoid.coordinates_of_arrow(groupoid.template seed_by_composition<M, First, Second, 0, 0>(g));
        Matrix<double, n, n> expected = Matrix<double, n, n>::Zero();
        for (int i = 0; i < ends.size(); ++i) expected += weights(i) * ends(i).mixed();
        const Matrix<double, n, d> rows = groupoid.template frame_to_end<First>(g, form);
        const Matrix<double, n, n> pushed =
            groupoid.template frame_to_end<Second>(g, Matrix<double, d, n>(rows.transpose())).transpose();
        return relative_defect(pushed, expected);
      };
      return worst({defect.template operator()<End::source, End::source>(hessian),
                    defect.template operator()<End::target, End::target>(hessian),
                    defect.template operator()<End::source, End::target>(
                        Hessian(hessian + 0.5 * groupoid.frame_bracket(gradient)))});
    });
  }
  law("change of momentum", options.derivative, [&] {
    // Of a random linear function of the arrow's coordinates.
    const A g = arrow();
    const auto ends = groupoid.coordinates_of_arrow(
        groupoid.template seed_by_composition<Jet<double, 2 * n>, End::source, End::target, 0, n>(g));
    Vector<double, 2 * n> gradient = Vector<double, 2 * n>::Zero();
    for (int i = 0; i < ends.size(); ++i) gradient += vector()(0) * ends(i).gradient();
    const V at_source = gradient.template head<n>();
    const V at_target = gradient.template tail<n>();
    return relative_defect(groupoid.momentum_change(g, at_source, at_target), (at_source + at_target).eval());
  });
  law("extending an arrow", options.tolerance, [&] {
    const A g = arrow();
    V w = vector();
    if (w.norm() > options.local) w *= options.local / w.norm();
    double largest = 0;
    for (const double size : {1.0, 1e-3, 1e-6, 1e-9})
      largest = worst({largest, arrows(groupoid.extend(g, V(size * w)),
                                       groupoid.compose(g, groupoid.tau(groupoid.target(g), V(size * w))))});
    return largest;
  });
  law("correcting an arrow", options.tolerance, [&] {
    // Thousands of displacements, each a few hundred round-offs, add up to what they are together.
    const A g = arrow();
    constexpr int count = 4096;
    V w = vector();
    w *= options.local / (1 + w.norm());
    w *= 1e-13;
    A moved = g;
    V rest = V::Zero();
    for (int k = 0; k < count; ++k) rest = groupoid.correct(moved, V(rest + w));
    return arrows(moved, groupoid.compose(g, groupoid.tau(groupoid.target(g), V(count * w)))) / 10;
  });
  law("chart", options.tolerance, [&] {
    const auto q = draw_object();
    V v = vector();
    if (v.norm() > options.local) v *= options.local / v.norm();
    const A g = groupoid.tau(q, v);
    return worst({arrows(groupoid.arrow_in_chart(q, groupoid.chart(g)), g),
                  arrows(groupoid.arrow_in_chart(q, V(V::Zero())), groupoid.unit(q))});
  });
  return report;
}

/// The same for groupoids whose objects are vectors of R^n (or tuples of such), drawn at random.
template <Groupoid G> LawReport groupoid_laws(const G& groupoid = {}, const GroupoidLawOptions& options = {}) {
  constexpr int size = G::object_coordinate_count();
  return groupoid_laws(
      groupoid, [&] { return ObjectOf<G>(groupoid.template object_at<double>(draw_vector<size>(options.large))); },
      options);
}

}  // namespace lagroid::laws
