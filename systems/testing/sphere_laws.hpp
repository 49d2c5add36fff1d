#pragma once
/// Laws of integrators on (TS^2)^k and (T*S^2)^k, for your own: points stay on the bundle, the order is the one
/// declared, forms agree, steps run backwards, and what the method promises is kept. A law that does not hold is no
/// exception: the report shows it.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid::laws {

/// A motion that can be begun anywhere by any of its methods.
struct SphereSubject {
  using Points = SphereIntegrator::Points;

  std::string name;
  SphereIntegratorOptions options;  ///< the method in question
  Points start;                     ///< of its form
  std::function<std::unique_ptr<SphereIntegrator>(const Points& start, const SphereIntegratorOptions& options)> begin;
  std::function<Points(const Points& z, SphereForm from, SphereForm to)> in_form;
  std::vector<SphereForm> forms;
  /// What a symplectic method keeps of a state of options.form, and the size of its terms; null: nothing is known.
  std::function<std::pair<double, double>(const Points& z)> conserved = nullptr;
  bool keeps_spheres = true;
};

namespace detail {

using SpherePoints = SphereIntegrator::Points;

/// The start with its directions turned by u_i and its second halves, in the usual form, moved by v_i times their size.
inline SpherePoints displaced(const SphereSubject& subject, const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& v) {
  const CotangentSpheres<Eigen::Dynamic> space{int(subject.start.cols())};
  auto turn = space.zero_algebra();
  turn.topRows<3>() = u;
  const SphereForm usual = subject.forms.front();
  SpherePoints z = subject.in_form(subject.start, subject.options.form, usual);
  space.act(turn, z);
  const double size = z.bottomRows<3>().cwiseAbs().maxCoeff();
  z.bottomRows<3>() += (size > 0 ? size : 1) * v;
  space.project(z);
  return subject.in_form(z, usual, subject.options.form);
}

/// A closed curve of states around the start.
inline SpherePoints on_loop(const SphereSubject& subject, double phase) {
  Eigen::Matrix3Xd u(3, subject.start.cols()), v = u;
  for (Eigen::Index i = 0; i < u.cols(); ++i) {
    const double apart = 0.7 * double(i);
    u.col(i) << 0.2 * std::cos(phase + apart), 0.2 * std::sin(phase), 0.1 * std::sin(2 * phase + apart);
    v.col(i) << 0.2 * std::sin(phase + apart), 0.1 * std::cos(2 * phase), 0.2 * std::cos(phase);
  }
  return displaced(subject, u, v);
}

inline SpherePoints drawn_beside(const SphereSubject& subject) {
  const auto draw = [&] {
    Eigen::Matrix3Xd u(3, subject.start.cols());
    for (Eigen::Index i = 0; i < u.size(); ++i) u.data()[i] = 0.3 * draw_uniform();
    return u;
  };
  const auto turn = draw();
  return displaced(subject, turn, draw());
}

/// Directions as they are, second halves over their size in `like`.
inline double sphere_distance(const SpherePoints& a, const SpherePoints& b, const SpherePoints& like) {
  const double size = like.bottomRows<3>().norm();
  return std::hypot((a - b).topRows<3>().norm(), (a - b).bottomRows<3>().norm() / (size > 0 ? size : 1));
}

inline SpherePoints integrated(SphereIntegrator& integrator, long steps) {
  for (long k = 0; k < steps; ++k)
    if (const auto report = integrator.advance(); !report.converged())
      throw NotSampled("a step from here ends " + std::string(to_string(report.status)));
  return integrator.point();
}

/// The integral of p dq around closed curves of states with periodic parameter, by spectral derivatives, and its
/// variation.
inline std::pair<double, double> loop_integral(const std::vector<SpherePoints>& loop) {
  const int n = int(loop.size());
  double sum = 0;
  double variation = 0;
  for (int k = 0; k < n; ++k) {
    Eigen::Matrix3Xd rate = Eigen::Matrix3Xd::Zero(3, loop.front().cols());
    for (int j = 0; j < n; ++j) {
      if (j == k) continue;
      const double weight = 0.5 * ((k - j) % 2 == 0 ? 1 : -1) / std::tan(M_PI * (k - j) / n);
      rate += weight * loop[std::size_t(j)].topRows<3>();
    }
    const auto terms = loop[std::size_t(k)].bottomRows<3>().cwiseProduct(rate);
    sum += terms.sum() * 2 * M_PI / n;
    variation += terms.cwiseAbs().sum() * 2 * M_PI / n;
  }
  return {sum, variation};
}

/// The order that the method shows from beside the start, which may be at rest, over a time in which a few steps leave
/// an error to speak of.
inline double observed_order(const SphereSubject& subject) {
  SphereIntegratorOptions exact = subject.options;
  exact.method = lie_group_methods::munthe_kaas_54.name;
  exact.tolerance = 1e-14;
  constexpr int few = 8;
  const SpherePoints start = on_loop(subject, 1);
  const double h = subject.options.step;
  for (double horizon = 0.125 * h; horizon < 1e6 * h; horizon *= 1.5) {
    exact.step = horizon;
    const auto end = integrated(*subject.begin(start, exact), 1);
    const auto error = [&](int steps) {
      SphereIntegratorOptions own = subject.options;
      own.tolerance = 0;
      own.step = horizon / steps;
      return sphere_distance(integrated(*subject.begin(start, own), steps), end, end);
    };
    if (error(few) > 1e-4) return measured_order(error, 2 * few);
  }
  throw std::runtime_error("nothing moves");
}

/// Of a method that goes by a tolerance alone, how many of the five decades between tolerances of 1e-6 and 1e-11 its
/// error does not fall by, but for one; over a time in which the first leaves an error to speak of.
inline double tolerance_defect(const SphereSubject& subject) {
  const SpherePoints start = on_loop(subject, 1);
  const double h = subject.options.step;
  for (double horizon = h; horizon < 1e6 * h; horizon *= 1.5) {
    const auto end = [&](std::string_view method, double tolerance) {
      SphereIntegratorOptions options = subject.options;
      options.method = method;
      options.tolerance = tolerance;
      options.step = horizon;
      return integrated(*subject.begin(start, options), 1);
    };
    const SpherePoints exact = end(lie_group_methods::munthe_kaas_54.name, 1e-14);
    const auto error = [&](double tolerance) {
      return sphere_distance(end(subject.options.method, tolerance), exact, exact);
    };
    const double coarse = error(1e-6);
    if (!(coarse > 1e-7)) continue;
    const double missing = std::log10(error(1e-11) / coarse) + 4;
    return missing < 0 ? 0 : missing;
  }
  throw std::runtime_error("nothing moves");
}

}  // namespace detail

/// "points stay on the spheres", of methods that keep to them; "at least the order declared", or, of extrapolation,
/// "errors fall with the tolerance"; "all forms are one
/// motion"; of symplectic methods "steps go back the way they came", "symplectic": the integral of p dq along a closed
/// curve of states is carried along, and "what symmetries give is kept". States are drawn beside the start.
inline LawReport sphere_laws(const SphereSubject& subject) {
  using Points = SphereSubject::Points;
  constexpr long steps = 20;
  LawReport report{subject.name + " by " + subject.options.method, {}};
  const MethodTraits traits = subject.begin(subject.start, subject.options)->traits();
  const auto begun = [&](const Points& z) { return subject.begin(z, subject.options); };
  const auto ask_law = [&](const char* name, double tolerance, const std::function<double()>& defect) {
    Law law;
    law.name = name;
    law.tolerance = tolerance;
    law.samples = 1;
    try {
      law.worst = worst({defect()});
    } catch (const std::exception& error) {
      law.first_failure = error.what();
    }
    report.laws.push_back(law);
  };

  if (subject.keeps_spheres)
    report.laws.push_back(check_law("points stay on the spheres", 1e-13, [&] {
      return off_spheres(detail::integrated(*begun(detail::drawn_beside(subject)), steps));
    }));
  if (subject.options.method == extrapolation_method.name) {
    ask_law("errors fall with the tolerance", 0, [&] { return detail::tolerance_defect(subject); });
  } else {
    ask_law("at least the order declared", 0.1, [&] {
      return worst({0.0, traits.order - detail::observed_order(subject)});
    });
  }
  if (subject.forms.size() > 1)
    report.laws.push_back(check_law("all forms are one motion", 1e-9, [&] {
      const Points z = detail::drawn_beside(subject);
      const auto end = [&](SphereForm form) {
        SphereIntegratorOptions options = subject.options;
        options.method = lie_group_methods::munthe_kaas_54.name;
        options.tolerance = 1e-13;
        options.form = form;
        const auto integrator = subject.begin(subject.in_form(z, subject.options.form, form), options);
        return subject.in_form(detail::integrated(*integrator, 4), form, SphereForm::momenta);
      };
      const Points one = end(subject.forms.front());
      return detail::sphere_distance(end(subject.forms.back()), one, one);
    }));
  if (!traits.symplectic) return report;

  report.laws.push_back(check_law("steps go back the way they came", 1e-9, [&] {
    const Points z = detail::drawn_beside(subject);
    Points turned = detail::integrated(*begun(z), steps);
    turned.bottomRows<3>() *= -1;
    Points back = detail::integrated(*begun(turned), steps);
    back.bottomRows<3>() *= -1;
    return detail::sphere_distance(back, z, z);
  }));
  ask_law("symplectic", 1e-8, [&] {
    constexpr int points = 64;
    std::vector<std::unique_ptr<SphereIntegrator>> integrators;
    for (int k = 0; k < points; ++k) integrators.push_back(begun(detail::on_loop(subject, 2 * M_PI * k / points)));
    const auto integral = [&] {
      std::vector<Points> loop;
      for (const auto& integrator : integrators)
        loop.push_back(subject.in_form(integrator->point(), subject.options.form, SphereForm::momenta));
      return detail::loop_integral(loop);
    };
    const double before = integral().first;
    for (const auto& integrator : integrators) detail::integrated(*integrator, steps);
    const auto [after, variation] = integral();
    return std::abs(after - before) / variation;
  });
  if (subject.conserved)
    report.laws.push_back(check_law("what symmetries give is kept", 1e-12, [&] {
      const auto integrator = begun(detail::drawn_beside(subject));
      const auto [before, size] = subject.conserved(integrator->point());
      const auto [after, size_after] = subject.conserved(detail::integrated(*integrator, steps));
      return std::abs(after - before) / std::max({size, size_after, 1e-300});
    }));
  return report;
}

}  // namespace lagroid::laws
