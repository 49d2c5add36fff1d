#pragma once
/// `check`: the certificate of a system of one's own. All laws that apply to it are tested at random states.
///
/// Wrong derivatives, a symmetry that is none, a momentum map with a wrong sign: a run may hide them, a law does not.
///
///     const Certificate found = check(Dido{}, [] {
///       return State<Dido::GroupoidType>{{0, 0}, laws::draw_vector<3>(2)};
///     });
///     std::cout << text_certificate(found);
///
/// Requires states from which a step can be taken, and a link to lagroid::laws beside lagroid::run. Not to be called by
/// several threads at once. Errors: std::invalid_argument for less than one sample.

#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/run/ledger/certificate.hpp>
#include <lagroid/solvers/testing/certificate.hpp>

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>

namespace lagroid {

/// Options of `check`.
struct CheckOptions {
  std::string name = "system";  ///< in reports
  int samples = 100;            ///< of each law, at least 1
  long seed = 20261120;         ///< of the samples: the same ones again
};

/// Tests every law that applies to the system (laws::certificate), as `lagroid check` does for scenes. `draw()` returns
/// a State from which a step can be taken; it draws with RapidCheck (laws::draw_uniform, laws::draw_vector). Not to be
/// called by several threads at once. Throws std::invalid_argument for less than one sample.
template <DiscreteSystem Sys>
Certificate check(const Sys& system, const std::function<State<typename Sys::GroupoidType>()>& draw,
                  const CheckOptions& options = {}) {
  if (options.samples < 1) throw std::invalid_argument("samples: at least one is asked of each law");
  const auto clock = std::chrono::steady_clock::now();
  Certificate certificate;
  certificate.system = options.name;
  certificate.groupoid = Sys::GroupoidType::name();
  certificate.samples = options.samples;
  certificate.seed = options.seed;
  {
    const laws::Sampling sampling(options.samples, options.seed);
    certificate.suites = laws::certificate<Sys>(system, draw);
  }
  certificate.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return certificate;
}

}  // namespace lagroid
