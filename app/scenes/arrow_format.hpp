#pragma once
/// How scenes give arrows, groupoid by groupoid: the configuration of an initial value, the ends of a boundary value.
///
/// A user writes a position or an attitude, not the coordinates of an arrow; a groupoid of one's own may have a
/// specialisation too.
///
///     const ArrowFormat<SO3> arrows{};
///     const Matrix<double, 3, 3> attitude = arrows.read(initial, "attitude");  // [initial] attitude = [1, 0, 0, 0]
///
/// Errors: SceneError where the numbers are no arrow.

#include "../keys/key.hpp"

#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace lagroid::app {

/// A rotation as unit quaternion (w, x, y, z).
inline std::array<double, 4> quaternion_of(const Matrix<double, 3, 3>& rotation) {
  const auto q = SO3::quaternion(rotation);
  return {q(0), q(1), q(2), q(3)};
}

/// How a scene writes the arrows of a groupoid G that end at a node:
///
///     static constexpr std::string_view key                    of [initial] and of the ends in [boundary]
///     static KeyOf<...> declared(key)                          what may stand there
///     Arrow read(section, key) const                           the arrow that the key gives, or that is there without
///     Arrow between(start, end) const                          from the node where one ends to that of the other
///     coordinates<S>(arrow, object) const                      numbers of the node for reports, attitudes apart
///     labels(key)                                              their names
///     attitude(arrow) const                                    a rotation in space, where there is one
///
/// This one, of any groupoid, takes the coordinates of arrows (LieGroupoid::coordinates_of_arrow).
template <class G> struct ArrowFormat {
  static constexpr std::string_view key = "configuration";
  G groupoid;

  static KeyOf<NumberArray> declared(std::string_view name) {
    return {
        std::string(name), {std::size_t(G::arrow_coordinate_count())}, "", "coordinates of the arrow that ends there"};
  }
  ArrowOf<G> read(const Section& section, std::string_view name) const {
    const auto given = read_key(section, declared(name));
    using V = Vector<double, G::arrow_coordinate_count()>;
    const V x = Eigen::Map<const V>(given.data());
    const ArrowOf<G> arrow = groupoid.template arrow_at<double>(x);
    const ArrowOf<G> projected = groupoid.project(arrow);
    constexpr double on_it = 1e-8;
    if (!((V(groupoid.coordinates_of_arrow(projected)) - x).norm() <= on_it * (1 + x.norm())))
      section.fail(name, fmt::format("are the coordinates of no arrow of {}", G::name()));
    return projected;
  }
  ArrowOf<G> between(const ArrowOf<G>& start, const ArrowOf<G>& end) const {
    return groupoid.project(groupoid.multiply(groupoid.inverse(start), end));
  }
  static std::vector<std::string> labels(std::string_view) {
    std::vector<std::string> out;
    for (int i = 1; i <= G::arrow_coordinate_count(); ++i) out.push_back(fmt::format("g{}", i));
    return out;
  }
  template <class S = double> std::vector<S> coordinates(const ArrowOf<G, S>& arrow, const ObjectOf<G, S>&) const {
    const auto x = groupoid.coordinates_of_arrow(arrow);
    return {x.data(), x.data() + x.size()};
  }
  static std::optional<std::array<double, 4>> attitude(const ArrowOf<G>&) { return std::nullopt; }
};

/// Points of R^n: a node is its position.
template <int N> struct ArrowFormat<Pair<N>> {
  static constexpr std::string_view key = "position";
  Pair<N> groupoid;

  static KeyOf<NumberArray> declared(std::string_view name) {
    return {std::string(name), {std::size_t(N)}, "", "a position"};
  }
  static PairArrow<double, N> read(const Section& section, std::string_view name) {
    const auto q = read_key(section, declared(name));
    const Vector<double, N> at = Eigen::Map<const Vector<double, N>>(q.data());
    return {at, at};
  }
  static PairArrow<double, N> between(const PairArrow<double, N>& start, const PairArrow<double, N>& end) {
    return {start.target, end.target};
  }
  static std::vector<std::string> labels(std::string_view name) {
    const std::string head = name == key ? "q" : std::string(name) + "_";
    std::vector<std::string> out;
    for (int i = 1; i <= N; ++i) out.push_back(fmt::format("{}{}", head, i));
    return out;
  }
  template <class S = double> static std::vector<S> coordinates(const PairArrow<S, N>&, const Vector<S, N>& q) {
    return {q.data(), q.data() + N};
  }
  static std::optional<std::array<double, 4>> attitude(const PairArrow<double, N>&) { return std::nullopt; }
};

/// Attitudes; without one, the identity.
template <> struct ArrowFormat<SO3> {
  static constexpr std::string_view key = "attitude";
  SO3 groupoid;

  static KeyOf<AnyAttitude> declared(std::string_view name) {
    return {std::string(name), {}, "", "a unit quaternion w, x, y, z, or a rotation vector (rad)", {{1, 0, 0, 0}}};
  }
  static Matrix<double, 3, 3> read(const Section& section, std::string_view name) {
    if (!section.has(name)) return Matrix<double, 3, 3>::Identity();
    const auto q = read_key(section, declared(name));
    return SO3::from_quaternion({q[0], q[1], q[2], q[3]});
  }
  static Matrix<double, 3, 3> between(const Matrix<double, 3, 3>& start, const Matrix<double, 3, 3>& end) {
    return SO3::project(Matrix<double, 3, 3>(start.transpose() * end));
  }
  static std::vector<std::string> labels(std::string_view) { return {}; }
  template <class S = double> static std::vector<S> coordinates(const Matrix<S, 3, 3>&, const Vector<S, 0>&) {
    return {};
  }
  static std::optional<std::array<double, 4>> attitude(const Matrix<double, 3, 3>& a) { return quaternion_of(a); }
};

/// Angles in the plane; without one, zero.
template <> struct ArrowFormat<SO2> {
  static constexpr std::string_view key = "angle";
  SO2 groupoid;

  static KeyOf<Number> declared(std::string_view name) { return {std::string(name), {}, "rad", "an angle", 0.0}; }
  static Matrix<double, 2, 2> read(const Section& section, std::string_view name) {
    return SO2::exp(Vector<double, 1>(read_key(section, declared(name))));
  }
  static Matrix<double, 2, 2> between(const Matrix<double, 2, 2>& start, const Matrix<double, 2, 2>& end) {
    return SO2::project(Matrix<double, 2, 2>(start.transpose() * end));
  }
  static std::vector<std::string> labels(std::string_view name) { return {std::string(name)}; }
  template <class S = double> static std::vector<S> coordinates(const Matrix<S, 2, 2>& a, const Vector<S, 0>&) {
    return {SO2::log(a)(0)};
  }
  static std::optional<std::array<double, 4>> attitude(const Matrix<double, 2, 2>&) { return std::nullopt; }
};

/// Poses in the plane: x, y and the heading (rad).
template <> struct ArrowFormat<SE2> {
  static constexpr std::string_view key = "position";
  SE2 groupoid;

  static KeyOf<NumberArray> declared(std::string_view name) { return {std::string(name), {3}, "", "x, y, heading"}; }
  static Matrix<double, 3, 3> read(const Section& section, std::string_view name) {
    const auto pose = read_key(section, declared(name));
    return SE2::homogeneous<double>(SO2::exp(Vector<double, 1>(pose[2])), {pose[0], pose[1]});
  }
  static Matrix<double, 3, 3> between(const Matrix<double, 3, 3>& start, const Matrix<double, 3, 3>& end) {
    return SE2::project(SE2::multiply(SE2::inverse(start), end));
  }
  static std::vector<std::string> labels(std::string_view name) {
    if (name == key) return {"x", "y", "heading"};
    return {fmt::format("{}_x", name), fmt::format("{}_y", name), fmt::format("{}_heading", name)};
  }
  template <class S = double> static std::vector<S> coordinates(const Matrix<S, 3, 3>& pose, const Vector<S, 0>&) {
    using std::atan2;
    return {pose(0, 2), pose(1, 2), atan2(pose(1, 0), pose(0, 0))};
  }
  static std::optional<std::array<double, 4>> attitude(const Matrix<double, 3, 3>&) { return std::nullopt; }
};

/// R^n as a group; without a position, the origin.
template <int N> struct ArrowFormat<VectorGroup<N>> {
  static constexpr std::string_view key = "position";
  VectorGroup<N> groupoid;

  static KeyOf<NumberArray> declared(std::string_view name) {
    return {std::string(name), {std::size_t(N)}, "", "a position", std::vector<double>(std::size_t(N), 0.0)};
  }
  static Vector<double, N> read(const Section& section, std::string_view name) {
    return Eigen::Map<const Vector<double, N>>(read_key(section, declared(name)).data());
  }
  static Vector<double, N> between(const Vector<double, N>& start, const Vector<double, N>& end) { return end - start; }
  static std::vector<std::string> labels(std::string_view name) { return ArrowFormat<Pair<N>>::labels(name); }
  template <class S = double> static std::vector<S> coordinates(const Vector<S, N>& x, const Vector<S, 0>&) {
    return {x.data(), x.data() + N};
  }
  static std::optional<std::array<double, 4>> attitude(const Vector<double, N>&) { return std::nullopt; }
};

template <class V> std::vector<Key> as_keys(const KeyOf<V>& key) { return {key}; }
inline std::vector<Key> as_keys(std::vector<Key> keys) { return keys; }

/// Factor by factor. A key that several factors have is numbered: angle1, angle2. The attitude is the first factor's
/// that has one.
template <class... Gs> struct ArrowFormat<Product<Gs...>> {
  static constexpr std::string_view key = "";
  Product<Gs...> groupoid;
  using Arrow = ArrowOf<Product<Gs...>>;

  static std::vector<std::string> keys() {
    constexpr std::array<std::string_view, sizeof...(Gs)> plain{ArrowFormat<Gs>::key...};
    std::vector<std::string> out;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      std::size_t same = 0;
      std::size_t before = 0;
      for (std::size_t j = 0; j < plain.size(); ++j) {
        same += plain[j] == plain[i] ? 1 : 0;
        before += plain[j] == plain[i] && j < i ? 1 : 0;
      }
      out.push_back(same > 1 ? fmt::format("{}{}", plain[i], before + 1) : std::string(plain[i]));
    }
    return out;
  }
  static std::vector<Key> declared(std::string_view) {
    std::vector<Key> all;
    std::size_t i = 0;
    const auto add = [&](const std::vector<Key>& each) { all.insert(all.end(), each.begin(), each.end()); };
    const std::vector<std::string> names = keys();
    (add(as_keys(ArrowFormat<Gs>::declared(names[i++]))), ...);
    return all;
  }
  Arrow read(const Section& section, std::string_view) const {
    return indexed([&]<std::size_t I>(const auto& of, const std::string& name) { return of.read(section, name); });
  }
  Arrow between(const Arrow& start, const Arrow& end) const {
    return indexed([&]<std::size_t I>(const auto& of, const std::string&) {
      return of.between(std::get<I>(start), std::get<I>(end));
    });
  }
  std::vector<std::string> labels(std::string_view) const {
    return joined<std::string>([&]<std::size_t I>(const auto& of, const std::string& name) { return of.labels(name); });
  }
  template <class S = double>
  std::vector<S> coordinates(const ArrowOf<Product<Gs...>, S>& arrow, const ObjectOf<Product<Gs...>, S>& q) const {
    return joined<S>([&]<std::size_t I>(const auto& of, const std::string&) {
      return of.template coordinates<S>(std::get<I>(arrow), std::get<I>(q));
    });
  }
  std::optional<std::array<double, 4>> attitude(const Arrow& arrow) const {
    std::optional<std::array<double, 4>> found;
    indexed([&]<std::size_t I>(const auto& of, const std::string&) {
      if (!found) found = of.attitude(std::get<I>(arrow));
      return 0;
    });
    return found;
  }

 private:
  template <class F> auto indexed(const F& f) const {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      const std::vector<std::string> names = keys();
      return std::tuple{f.template operator()<I>(ArrowFormat<Gs>{std::get<I>(groupoid.factor)}, names[I])...};
    }
    (std::index_sequence_for<Gs...>());
  }
  template <class T, class F> std::vector<T> joined(const F& f) const {
    std::vector<T> all;
    std::apply([&](const auto&... each) { (all.insert(all.end(), each.begin(), each.end()), ...); }, indexed(f));
    return all;
  }
};

/// The keys of an arrow.
template <class G> std::vector<Key> arrow_keys() { return as_keys(ArrowFormat<G>::declared(ArrowFormat<G>::key)); }

}  // namespace lagroid::app
